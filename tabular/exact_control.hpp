#pragma once

#include <maximin/tabular/control.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin::internal {

/// The model in floating point.
FiniteMdp<double> rounded(const FiniteMdp<Rational>& mdp);

/// Policy iteration in rational numbers: the policy that floating point finds is evaluated exactly, its optimality is
/// checked exactly, and exact improvement repairs it where the check fails. The error is zero. Throws BudgetExhausted
/// for more states than `max_exact_unknowns`.
CertifiedSolution<Rational> iterate_policies_exactly(const ControlProblem<Rational>& problem,
                                                     const SolverOptions& options);

/// V of a fixed policy, exactly.
Values<Rational> solve_policy_values_exactly(const FiniteMdp<Rational>& mdp, const Policy& action);

}  // namespace maximin::internal
