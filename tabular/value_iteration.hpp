#pragma once

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>

namespace maximin {

/// Q* and V* by value iteration, V_{k+1} = T*V_k from V_0 = 0, stopped by MacQueen's span bounds: the returned values
/// are certified to within `error`. Q* is the fixed point of the paper's T* (section 3.6). Throws BudgetExhausted
/// rather than return values that have not converged.
template <class Scalar>
CertifiedSolution<Scalar> value_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options = {});

}  // namespace maximin
