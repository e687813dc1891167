#include <maximin/tabular/policy_evaluation.hpp>

#include <string>
#include <vector>

#include <fmt/format.h>
#include <Eigen/LU>
#include <Eigen/SparseLU>

#include <maximin/tabular/control.hpp>
#include <maximin/tabular/exact_control.hpp>

namespace maximin {
namespace {

/// Below this size a dense factorisation wins whatever the sparsity.
constexpr State small = 64;
/// Above this size a dense matrix does not fit.
constexpr State large = 8000;

template <class Scalar>
std::size_t nonzeros(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  std::size_t count = 0;
  for (State s = 0; s < mdp.states(); ++s) count += mdp.successors(s, action[static_cast<std::size_t>(s)]).size();
  return count;
}

template <class Scalar>
Values<Scalar> rewards_of(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  Values<Scalar> r(mdp.states());
  for (State s = 0; s < mdp.states(); ++s) r[s] = mdp.reward(s, action[static_cast<std::size_t>(s)]);
  return r;
}

template <class Scalar>
Values<Scalar> solve_dense(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  using Matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;
  Matrix system = Matrix::Identity(mdp.states(), mdp.states());
  for (State s = 0; s < mdp.states(); ++s) {
    for (const auto& next : mdp.successors(s, action[static_cast<std::size_t>(s)])) {
      system(s, next.target) -= mdp.discount() * next.probability;
    }
  }
  return system.partialPivLu().solve(rewards_of(mdp, action));
}

template <class Scalar>
Values<Scalar> solve_sparse(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  std::vector<Eigen::Triplet<Scalar>> entries;
  entries.reserve(nonzeros(mdp, action) + static_cast<std::size_t>(mdp.states()));
  for (State s = 0; s < mdp.states(); ++s) {
    entries.emplace_back(s, s, Scalar(1));
    for (const auto& next : mdp.successors(s, action[static_cast<std::size_t>(s)])) {
      entries.emplace_back(s, next.target, -mdp.discount() * next.probability);
    }
  }
  Eigen::SparseMatrix<Scalar> system(mdp.states(), mdp.states());
  system.setFromTriplets(entries.begin(), entries.end());
  Eigen::SparseLU<Eigen::SparseMatrix<Scalar>> lu(system);
  if (lu.info() != Eigen::Success)
    throw BudgetExhausted("policy evaluation: the sparse factorisation failed; evaluate iteratively");
  return lu.solve(rewards_of(mdp, action));
}

/// Every state has one choice: the operator is T^{pi o omega}.
template <class Scalar>
ControlProblem<Scalar> only(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  std::vector<std::vector<Action>> choices;
  choices.reserve(action.size());
  for (const Action a : action) choices.push_back({a});
  return ControlProblem<Scalar>(mdp, ControlProblem<Scalar>::Player::maximise, choices);
}

}  // namespace

template <class Scalar>
Values<Scalar> solve_policy_values(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  if constexpr (is_exact_v<Scalar>) {
    return internal::solve_policy_values_exactly(mdp, action);
  } else {
    const auto n = static_cast<std::size_t>(mdp.states());
    const bool full = nonzeros(mdp, action) > n * n / 8;
    return mdp.states() <= small || (full && mdp.states() <= large) ? solve_dense(mdp, action)
                                                                    : solve_sparse(mdp, action);
  }
}

template <class Scalar>
CertifiedSolution<Scalar> evaluate_policy(const FiniteMdp<Scalar>& mdp, const Policy& action,
                                          const SolverOptions& options) {
  return internal::iterate_policies(only(mdp, action), options);
}

template <class Scalar>
CertifiedSolution<Scalar> evaluate_policy_iteratively(const FiniteMdp<Scalar>& mdp, const Policy& action,
                                                      const SolverOptions& options) {
  return internal::iterate_values(only(mdp, action), options, 0);
}

template Values<double> solve_policy_values(const FiniteMdp<double>&, const Policy&);
template Values<Rational> solve_policy_values(const FiniteMdp<Rational>&, const Policy&);
template CertifiedSolution<double> evaluate_policy(const FiniteMdp<double>&, const Policy&, const SolverOptions&);
template CertifiedSolution<Rational> evaluate_policy(const FiniteMdp<Rational>&, const Policy&, const SolverOptions&);
template CertifiedSolution<double> evaluate_policy_iteratively(const FiniteMdp<double>&, const Policy&,
                                                               const SolverOptions&);

}  // namespace maximin
