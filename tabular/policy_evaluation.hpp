#pragma once

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// V of a fixed policy by a direct solve of (I - gamma P_pi) V = R_pi, dense or sparse LU whichever suits the model.
/// `action[s]` is what is done in the true state s (for an attacked agent, pi o omega). No certificate: see
/// `evaluate_policy`. Throws BudgetExhausted when the factorisation fails.
template <class Scalar>
Values<Scalar> solve_policy_values(const FiniteMdp<Scalar>& mdp, const Policy& action);

/// Q^{pi o omega} and V of a fixed pair (paper, Definition 1), by the direct solve, with its certificate.
template <class Scalar>
CertifiedSolution<Scalar> evaluate_policy(const FiniteMdp<Scalar>& mdp, const Policy& action,
                                          const SolverOptions& options = {});

/// The same by iterating T^{pi o omega}, which needs no factorisation and suits models of millions of states.
/// Throws BudgetExhausted when the certificate is not reached.
template <class Scalar>
CertifiedSolution<Scalar> evaluate_policy_iteratively(const FiniteMdp<Scalar>& mdp, const Policy& action,
                                                      const SolverOptions& options = {});

}  // namespace maximin
