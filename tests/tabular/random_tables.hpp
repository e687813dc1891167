#pragma once

#include <utility>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

/// Random tables, policies and attacks of the size of a model, for properties that hold for all of them.
namespace maximin {

inline constexpr TieBreak both_ties[] = {TieBreak::lowest_index, TieBreak::highest_index};

/// A table of small integers, full of ties, or of real numbers.
inline QTable<double> random_table(const FiniteMdp<double>& mdp, Stream& rng) {
  QTable<double> q(mdp.states(), mdp.actions());
  const bool whole = rng.chance(0.5);
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) q(s, a) = whole ? rng.integer(-2, 2) : rng.uniform(-10, 10);
  }
  return q;
}

/// A policy, by observation or by true state.
inline Policy random_policy(const FiniteMdp<double>& mdp, Stream& rng) {
  Policy policy;
  for (State s = 0; s < mdp.states(); ++s) policy.push_back(rng.below(mdp.actions()));
  return policy;
}

/// A stationary attack that keeps to the balls.
inline AttackPolicy random_attack(const Perturbation<double>& balls, Stream& rng) {
  AttackPolicy attack;
  for (State s = 0; s < balls.states(); ++s) {
    const auto ball = balls.ball(s);
    attack.push_back(ball[static_cast<std::size_t>(rng.below(static_cast<int>(ball.size())))]);
  }
  return attack;
}

/// The same model with another discount, and a share of every row spread evenly over all states.
inline FiniteMdp<double> altered(const FiniteMdp<double>& mdp, double discount, double spread) {
  FiniteMdpBuilder<double> b(mdp.states(), mdp.actions(), discount);
  std::vector<double> row(static_cast<std::size_t>(mdp.states()));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      row.assign(row.size(), spread / mdp.states());
      for (const auto& next : mdp.successors(s, a)) {
        row[static_cast<std::size_t>(next.target)] += (1 - spread) * next.probability;
      }
      b.reward(s, a, mdp.reward(s, a));
      for (State t = 0; t < mdp.states(); ++t) b.transition(s, a, t, row[static_cast<std::size_t>(t)]);
    }
  }
  return std::move(b).build();
}

}  // namespace maximin
