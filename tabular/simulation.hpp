#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include <maximin/tabular/tabular_agents.hpp>
#include <maximin/tabular/tabular_attacks.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/rollout.hpp>

namespace maximin {

/// The number of steps after which what remains of any discounted return is at most `tolerance` in reward:
/// gamma^n max|R|/(1-gamma) <= tolerance. At least 1. Throws InputError unless tolerance > 0.
template <class Scalar>
long truncation_horizon(const FiniteMdp<Scalar>& mdp, double tolerance) {
  if (!(tolerance > 0)) throw InputError("horizon: tolerance must be positive, e.g. 1e-6");
  const auto gamma = static_cast<double>(mdp.discount());
  const double rest = static_cast<double>(mdp.rewards().cwiseAbs().maxCoeff()) / (1 - gamma);
  if (!(rest > tolerance) || !(gamma > 0)) return 1;
  return std::max(1L, static_cast<long>(std::ceil(std::log(tolerance / rest) / std::log(gamma))));
}

/// How much to simulate.
struct SimulationOptions {
  long episodes = 1000;
  long horizon = 0;        ///< steps per episode; 0: until what remains is at most 1e-9 of max|R|/(1-gamma)
  std::uint64_t seed = 1;  ///< episode k draws from Stream(seed, k)
};

/// Steps per episode that the options mean for this model.
template <class Scalar>
long simulation_horizon(const FiniteMdp<Scalar>& mdp, const SimulationOptions& options) {
  if (options.episodes < 1) throw InputError("episodes: " + std::to_string(options.episodes) + ", expected at least 1");
  if (options.horizon < 0) throw InputError("horizon: " + std::to_string(options.horizon) + ", expected 0 or more");
  if (options.horizon > 0) return options.horizon;
  const auto scale = static_cast<double>(mdp.rewards().cwiseAbs().maxCoeff() / (Scalar(1) - mdp.discount()));
  return scale > 0 ? truncation_horizon(mdp, 1e-9 * scale) : 1;
}

/// Mean discounted return of any agent under any attack, with its 95 percent interval. Throws std::logic_error when the
/// attack leaves the ball, InputError on options out of range.
template <class Scalar, Agent AgentT, class AttackT>
Evaluation simulate(TabularEnvironment<Scalar>& env, AgentT& agent, AttackT& attack,
                    const Perturbation<Scalar>& perturbation, const SimulationOptions& options = {}) {
  WithinBall<AttackT, Scalar> bounded(attack, perturbation);
  const long horizon = simulation_horizon(env.mdp(), options);
  return evaluate(env, agent, bounded, static_cast<double>(env.mdp().discount()), horizon, options.episodes,
                  options.seed);
}

/// One episode of the same, number `trial` of the seed, step by step: `observe(record, agent)` is called after each.
template <class Scalar, Agent AgentT, class AttackT, class Observer>
Episode simulate_episode(TabularEnvironment<Scalar>& env, AgentT& agent, AttackT& attack,
                         const Perturbation<Scalar>& perturbation, const SimulationOptions& options,
                         std::uint64_t trial, Observer&& observe) {
  WithinBall<AttackT, Scalar> bounded(attack, perturbation);
  Stream rng(options.seed, trial);
  return rollout(env, agent, bounded, static_cast<double>(env.mdp().discount()), simulation_horizon(env.mdp(), options),
                 rng, observe);
}

}  // namespace maximin
