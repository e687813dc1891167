#pragma once

#include <memory>
#include <vector>

#include <maximin/deep/places.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/tabular_environment.hpp>

namespace maximin::deep {

/// A random Lipschitz model of 20 states in the unit square with 4 actions, and what the exact layer knows of it.
struct LipschitzPlaces {
  LipschitzPlaces(std::uint64_t seed, double eps) : LipschitzPlaces(draw(seed, eps)) {}
  explicit LipschitzPlaces(Model<double> drawn)
      : model(std::move(drawn)),
        balls(make_perturbation(model)),
        places(model.geometry.points),
        environment(model.mdp),
        pessimistic(pessimistic_q_iteration<double>(model.mdp, balls)) {
    std::vector<double> scratch;
    maximin_policy(pessimistic.q, balls, policy, scratch);
  }
  LipschitzPlaces(const LipschitzPlaces&) = delete;
  LipschitzPlaces& operator=(const LipschitzPlaces&) = delete;

  static Model<double> draw(std::uint64_t seed, double eps) {
    LipschitzMdpOptions options;
    options.states = 20;
    options.actions = 4;
    options.eps = eps;
    options.l_p = 2;
    options.successors = 5;
    options.sharpness = 0.8;
    Stream rng(seed);
    return random_lipschitz_mdp(options, rng);
  }

  /// max|R|/(1-gamma): the unit of all tolerances.
  double scale() const { return model.mdp.rewards().cwiseAbs().maxCoeff() / (1 - model.mdp.discount()); }
  /// V_{pi o omega_pi}, the policy's exact worst case, by state.
  Values<double> worst_case(const Policy& pi) const { return evaluate_against_optimal_attack(model.mdp, balls, pi).v; }

  Model<double> model;
  Perturbation<double> balls;
  Places places;
  TabularEnvironment<double> environment;
  PessimisticQIteration<double> pessimistic;
  Policy policy;  ///< that of pessimistic Q-iteration
};

}  // namespace maximin::deep
