#include <maximin/tabular/policy_iteration.hpp>

#include <maximin/tabular/control.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

template <class Scalar>
CertifiedSolution<Scalar> policy_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options) {
  return internal::iterate_policies(ControlProblem<Scalar>::optimal_control(mdp), options);
}

template <class Scalar>
CertifiedSolution<Scalar> modified_policy_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options,
                                                    long partial_sweeps) {
  if (partial_sweeps < 0) throw InputError("partial sweeps: negative, expected 0 or more");
  return internal::iterate_values(ControlProblem<Scalar>::optimal_control(mdp), options, partial_sweeps);
}

template CertifiedSolution<double> policy_iteration(const FiniteMdp<double>&, const SolverOptions&);
template CertifiedSolution<Rational> policy_iteration(const FiniteMdp<Rational>&, const SolverOptions&);
template CertifiedSolution<double> modified_policy_iteration(const FiniteMdp<double>&, const SolverOptions&, long);

}  // namespace maximin
