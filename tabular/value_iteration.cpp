#include <maximin/tabular/value_iteration.hpp>

#include <maximin/tabular/control.hpp>

namespace maximin {

template <class Scalar>
CertifiedSolution<Scalar> value_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options) {
  return internal::iterate_values(ControlProblem<Scalar>::optimal_control(mdp), options, 0);
}

template CertifiedSolution<double> value_iteration(const FiniteMdp<double>&, const SolverOptions&);

}  // namespace maximin
