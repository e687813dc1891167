#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// What a fixed policy is worth against the strongest attacker it can meet.
template <class Scalar>
struct RobustEvaluation {
  QTable<Scalar> q;     ///< fixed point of T^{pi}_rob, |S| x |A|
  Values<Scalar> v;     ///< V_{pi o omega_pi}(s), |S|
  AttackPolicy attack;  ///< what to show in each true state: optimal to within `error`
  Policy composed;      ///< the action it provokes in each true state
  Scalar error{0};      ///< certified, in the maximum norm
  long sweeps = 0;
};

/// The optimal attack on a fixed policy pi and the value it leaves: the fixed point of T^{pi}_rob (paper, section 2.2:
/// the attacker's problem is an MDP whose actions are the states it can show). Solved by policy iteration over the
/// actions { pi(t) : t in B(s) } that the attacker can provoke. Against a stationary pi no history-dependent attack
/// does better.
template <class Scalar>
RobustEvaluation<Scalar> evaluate_against_optimal_attack(const FiniteMdp<Scalar>& mdp,
                                                         const Perturbation<Scalar>& perturbation, const Policy& policy,
                                                         const SolverOptions& options = {});

namespace internal {

/// The actions that an attacker can provoke in each true state, ascending, each once, from an agent that takes any of
/// choices(t) where it sees t.
template <class Scalar, class Choices>
std::vector<std::vector<Action>> provokable(const Perturbation<Scalar>& perturbation, Choices choices) {
  std::vector<std::vector<Action>> provoked(static_cast<std::size_t>(perturbation.states()));
  for (State s = 0; s < perturbation.states(); ++s) {
    auto& list = provoked[static_cast<std::size_t>(s)];
    for (const State t : perturbation.ball(s)) {
      for (const Action a : choices(t)) list.push_back(a);
    }
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return provoked;
}

}  // namespace internal

}  // namespace maximin
