#pragma once

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>

namespace maximin {

/// Q* and V* by Howard's policy iteration: each policy is evaluated by a direct linear solve and improved where another
/// action is better by more than rounding. The result carries MacQueen's certificate like that of value iteration, so
/// the two may be compared. Best up to a few thousand states; every solve costs O(|S|^3) on dense models. Throws
/// BudgetExhausted when the certificate is not reached.
template <class Scalar>
CertifiedSolution<Scalar> policy_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options = {});

/// Q* and V* by modified policy iteration (Puterman and Shin, 1978): value iteration with `partial_sweeps` cheap sweeps
/// of the greedy policy after each sweep over all actions, stopped by the same certificate. Throws BudgetExhausted when
/// the certificate is not reached.
template <class Scalar>
CertifiedSolution<Scalar> modified_policy_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options = {},
                                                    long partial_sweeps = 20);

}  // namespace maximin
