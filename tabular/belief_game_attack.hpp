#pragma once

#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/tabular_agents.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The strongest attack on an agent that holds the exact belief: in every step it shows the t in B(s) that leads to the
/// belief of least worst-case value, argmin_{t in B(s)} W(s, belief after t). It misleads the belief on purpose where
/// that pays later, which no myopic attack does. The perturbation must outlive it.
///
///     const auto game = solve_belief_game(mdp, perturbation, maximin_belief_policy(q), {.keep_positions = true});
///     BeliefGameAttack attack(game, perturbation);
template <class Scalar>
class BeliefGameAttack {
 public:
  /// `game` solved with `keep_positions`, for the very policy that the agent follows. Throws std::invalid_argument when
  /// the positions were not kept.
  BeliefGameAttack(BeliefGameValue<Scalar> game, const Perturbation<Scalar>& perturbation)
      : w_(std::move(game.w)), perturbation_(&perturbation) {
    if (w_.empty()) throw std::invalid_argument("belief game attack: the game was solved without keep_positions");
  }

  /// Throws std::out_of_range when the agent holds a belief that the game never met: it plays by another policy.
  template <class AgentT>
  requires requires(const AgentT& agent, State t) { agent.would_believe(t); }
  State perturb(State truth, const AgentT& agent, Stream&) const {
    const auto ball = perturbation_->ball(truth);
    const auto shown = internal::arg_best<std::size_t>(
        ball.size(),
        [&](std::size_t i) {
          return w_.at({truth, agent.would_believe(ball[i])});
        },
        [](auto& x, auto& y) { return x < y; }, TieBreak::lowest_index);
    return ball[shown];
  }

 private:
  std::map<std::pair<State, Belief>, Scalar> w_;
  const Perturbation<Scalar>* perturbation_;
};

}  // namespace maximin
