#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The best that deterministic stationary policies can do against the optimal attacker.
template <class Scalar>
struct StackelbergValues {
  /// max_pi V_{pi o omega_pi}(s0) over deterministic stationary pi: a lower bound on the V*(s0) of the approximate
  /// Stackelberg equilibrium, whose policies may randomise. Attained by a different policy for each s0, in general.
  Values<Scalar> v;
  std::vector<Policy> best_for_state;  ///< by s0: a policy that attains v[s0], the first in the order of enumeration

  /// The policy with the largest sum of values over all start states, and those values. If any policy is best for every
  /// start state at once, this one is.
  Policy compromise;
  Values<Scalar> compromise_values;
  /// max_s (v[s] - compromise_values[s]). Above `slack` it proves that no one policy is best for every start state.
  Scalar shortfall{0};
  Scalar slack{0};  ///< the largest shortfall that the errors of evaluation can explain
  /// One policy attains v everywhere as far as the numbers can tell: a Stackelberg equilibrium among deterministic
  /// stationary policies.
  bool one_policy_is_best_everywhere() const { return shortfall <= slack; }

  std::optional<Policy> best_for_start;  ///< maximises sum_s Pr(s) V(s), if a start distribution was given
  Scalar value_for_start{0};             ///< that maximum

  Scalar error{0};    ///< |v - exact| <= error, and likewise every value here
  long policies = 0;  ///< |A|^|S|
  long distinct = 0;  ///< of them, those that the attacker can tell apart: as many as were evaluated
};

/// What to enumerate.
template <class Scalar>
struct StackelbergOptions {
  long max_policies = 100'000;  ///< |A|^|S| above this: BudgetExhausted
  std::vector<Scalar> start;    ///< Pr(s_0), one per state, or empty
  SolverOptions solver;         ///< for the value of each policy
};

/// Sees every policy that was evaluated and its values against the optimal attacker, in the order of enumeration: the
/// first state's action changes fastest.
template <class Scalar>
using PolicyObserver = std::function<void(const Policy& policy, const Values<Scalar>& v)>;

/// V*(s0) of the approximate Stackelberg equilibrium (paper, appendix "Approximate Stackelberg Equilibrium"), over all
/// deterministic stationary policies of the observation, by enumeration. Two policies that let the attacker provoke the
/// same actions in every state are worth the same and only the first of them is evaluated. A policy that randomises, or
/// remembers, may do better than v.
///
/// Throws BudgetExhausted naming |A|^|S| when there are too many policies, InputError when sizes do not match or
/// `start` is no distribution.
template <class Scalar>
StackelbergValues<Scalar> stackelberg_values(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                             const StackelbergOptions<Scalar>& options = {},
                                             const PolicyObserver<Scalar>& observe = {});

}  // namespace maximin
