#pragma once

#include <map>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

/// Total rewards of finitely many steps, not discounted: what episodes that are cut after 100 steps are measured by. By
/// backward induction, exact up to the rounding of the sums.
namespace maximin {

/// Values by the number of steps left, 0 to `steps`; v[0] is zero.
template <class Scalar>
struct ValuesInSteps {
  std::vector<Values<Scalar>> v;  ///< by steps left, |S| each
  Scalar error{0};                ///< of any of them, in the maximum norm

  const Values<Scalar>& with_all_steps() const { return v.back(); }
};

/// The most that an agent who sees the truth and the clock can get. Throws InputError when steps < 0.
template <class Scalar>
ValuesInSteps<Scalar> optimal_in_steps(const FiniteMdp<Scalar>& mdp, long steps);

/// What a fixed policy gets from the strongest attacker, who knows the clock,
///
///     V_{k+1}(s) = min_{t in B(s)} R(s,pi(t)) + sum P(s'|s,pi(t)) V_k(s').
///
/// Throws InputError when steps < 0.
template <class Scalar>
ValuesInSteps<Scalar> attacked_in_steps(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                        const Policy& policy, long steps);

/// The belief game (belief_game.hpp) of finitely many steps.
template <class Scalar>
struct BeliefGameInSteps {
  Values<Scalar> v;    ///< from each true initial state, before the first observation, with all steps left, |S|
  Scalar error{0};     ///< in the maximum norm
  long positions = 0;  ///< reachable pairs (true state, belief)
  long beliefs = 0;    ///< distinct beliefs among them
  /// If asked for: the number of each pair, and W by steps left and that number, before the agent's move.
  std::map<std::pair<State, Belief>, int> numbers = {};
  std::vector<Values<Scalar>> w = {};
};

/// The exact worst-case total reward of a belief policy in so many steps, against any history-dependent attack that
/// knows the truth, the belief and the clock,
///
///     W_{k+1}(s, M) = R(s,a) + sum_{s'} P(s'|s,a) min_{t in B(s')} W_k(s', succ(M,a) intersected with B(t)),  a =
///     policy(M).
///
/// Of the options, tolerance and max_sweeps mean nothing here. Throws BudgetExhausted when there are too many pairs,
/// InputError when steps < 0.
template <class Scalar>
BeliefGameInSteps<Scalar> solve_belief_game_in_steps(const FiniteMdp<Scalar>& mdp,
                                                     const Perturbation<Scalar>& perturbation,
                                                     const BeliefPolicy& policy, long steps,
                                                     const BeliefGameOptions& options = {});

}  // namespace maximin
