#pragma once

#include <functional>
#include <map>
#include <span>
#include <utility>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// A policy that acts on a belief: a non-empty ascending set of states to an action.
using BeliefPolicy = std::function<Action(std::span<const State> belief)>;

/// argmax_a min_{m in belief} q(m,a): the belief-maximin policy of a table (paper, section 3.3). Copies the table.
/// A copy of the policy serves one thread at a time.
template <class Scalar>
BeliefPolicy maximin_belief_policy(QTable<Scalar> q, TieBreak tie = TieBreak::lowest_index);

/// What a belief policy is worth against the strongest attacker.
template <class Scalar>
struct BeliefGameValue {
  Values<Scalar> v;      ///< worst-case value from each true initial state, before the first observation, |S|
  Scalar error{0};       ///< certified, in the maximum norm
  long positions = 0;    ///< reachable pairs (true state, belief)
  long beliefs = 0;      ///< distinct beliefs among them
  Scalar reach{0};       ///< rho: the largest distance from a true state to a member of the belief held in it
  double mean_size = 0;  ///< states in a belief, averaged over positions
  long sweeps = 0;
  /// W(s, M) at each reachable (true state, belief), if asked for: what the attacker minimises.
  std::map<std::pair<State, Belief>, Scalar> w = {};
};

struct BeliefGameOptions {
  long max_positions = 200'000;  ///< reachable pairs before BudgetExhausted is thrown
  double tolerance = 1e-12;      ///< certified error to reach, as a fraction of max|R|/(1-gamma)
  long max_sweeps = 1'000'000;
  bool keep_positions = false;  ///< also return W(s, M)
};

/// The exact worst-case value of a belief policy, against any history-dependent attack: both the truth and the belief
/// are known to the attacker, so the pair (true state, belief) is a Markov state of its problem. The reachable pairs
/// are enumerated from every initial state and every first observation, and solved by value iteration with MacQueen's
/// bounds:
///
///     W(s, M) = R(s,a) + gamma sum_{s'} P(s'|s,a) min_{t in B(s')} W(s', succ(M,a) intersected with B(t)),  a =
///     policy(M) v(s)    = min_{t in B(s)} W(s, B(t)).
///
/// Throws BudgetExhausted when there are too many pairs or sweeps.
template <class Scalar>
BeliefGameValue<Scalar> solve_belief_game(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                          const BeliefPolicy& policy, const BeliefGameOptions& options = {});

/// The same for an agent without memory, whose belief is always the ball of what it sees. Equal to the value against
/// the optimal attacker of the stationary policy t -> policy(B(t)).
template <class Scalar>
Policy stationary_policy_of(const Perturbation<Scalar>& perturbation, const BeliefPolicy& policy);

}  // namespace maximin
