#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <maximin/theory/concepts.hpp>

namespace maximin {

/// One step of an episode, as an observer sees it.
template <class StateT, class ObservationT, class ActionT>
struct StepRecord {
  long time = 0;
  StateT truth;        ///< s_t
  ObservationT shown;  ///< what the attacker made of it
  ActionT action;      ///< a_t
  double reward = 0;   ///< R_t
  StateT next;         ///< s_{t+1}
  bool terminal = false;
};

/// What an episode came to.
struct Episode {
  double discounted_return = 0;  ///< sum_t gamma^t R_t
  double total_reward = 0;       ///< sum_t R_t
  long steps = 0;
  bool terminal = false;  ///< ended by the environment, not by the horizon
};

/// Plays one episode of at most `horizon` steps: the attack perturbs what the agent sees, never where it is (paper,
/// section 2.2). `observe(record, agent)` is called after every step. Agents and attacks that remember something offer
/// `forget()`, which is called first: the attack looks at the agent before the agent's first act.
template <Environment Env, Agent AgentT, class AttackT, class Observer>
requires Attack<AttackT, typename Env::StateType, AgentT> Episode rollout(Env& env, AgentT& agent, AttackT& attack,
                                                                          double discount, long horizon, Stream& rng,
                                                                          Observer&& observe) {
  using StateT = typename Env::StateType;
  Episode episode;
  double weight = 1;
  StateT state = env.reset(rng);
  if constexpr (requires { agent.forget(); }) agent.forget();
  if constexpr (requires { attack.forget(); }) attack.forget();
  for (long t = 0; t < horizon; ++t) {
    const typename AgentT::ObservationType shown = attack.perturb(state, agent, rng);
    const typename AgentT::ActionType action = t == 0 ? agent.begin(shown, rng) : agent.act(shown, rng);
    const Outcome<StateT> outcome = env.step(state, action, rng);
    episode.discounted_return += weight * outcome.reward;
    episode.total_reward += outcome.reward;
    ++episode.steps;
    weight *= discount;
    observe(
        StepRecord<StateT, typename AgentT::ObservationType, typename AgentT::ActionType>{
            t, state, shown, action, outcome.reward, outcome.next, outcome.terminal},
        agent);
    state = outcome.next;
    if (outcome.terminal) {
      episode.terminal = true;
      break;
    }
  }
  return episode;
}

template <Environment Env, Agent AgentT, class AttackT>
Episode rollout(Env& env, AgentT& agent, AttackT& attack, double discount, long horizon, Stream& rng) {
  return rollout(env, agent, attack, discount, horizon, rng, [](const auto&, const auto&) {});
}

/// A mean over episodes with its 95 percent interval.
struct Evaluation {
  long episodes = 0;
  double mean = 0;
  double half_width = 0;  ///< 1.96 standard errors; infinite for fewer than two episodes
};

/// Mean discounted return over `episodes` independent episodes; episode k draws from Stream(seed, k), so the result
/// does not depend on what was evaluated before.
template <Environment Env, Agent AgentT, class AttackT>
Evaluation evaluate(Env& env, AgentT& agent, AttackT& attack, double discount, long horizon, long episodes,
                    std::uint64_t seed) {
  double mean = 0, squares = 0;
  for (long k = 0; k < episodes; ++k) {
    Stream rng(seed, static_cast<std::uint64_t>(k));
    const double x = rollout(env, agent, attack, discount, horizon, rng).discounted_return;
    const double before = x - mean;
    mean += before / static_cast<double>(k + 1);
    squares += before * (x - mean);
  }
  const double n = static_cast<double>(episodes);
  const double spread = episodes > 1 ? 1.96 * std::sqrt(squares / (n - 1) / n) : INFINITY;
  return {episodes, mean, spread};
}

}  // namespace maximin
