#include <maximin/tabular/optimal_attack.hpp>

#include <algorithm>
#include <span>
#include <vector>

#include <maximin/tabular/control.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {
namespace {

/// The first state of B(s) that makes pi take the given action.
template <class Scalar>
State disguise(const Perturbation<Scalar>& perturbation, const Policy& policy, State s, Action action) {
  const auto ball = perturbation.ball(s);
  return *std::find_if(ball.begin(), ball.end(),
                       [&](State t) { return policy[static_cast<std::size_t>(t)] == action; });
}

}  // namespace

template <class Scalar>
RobustEvaluation<Scalar> evaluate_against_optimal_attack(const FiniteMdp<Scalar>& mdp,
                                                         const Perturbation<Scalar>& perturbation, const Policy& policy,
                                                         const SolverOptions& options) {
  const auto provokable = internal::provokable(
      perturbation, [&](State t) { return std::span(policy).subspan(static_cast<std::size_t>(t), 1); });
  const ControlProblem<Scalar> attacker(mdp, ControlProblem<Scalar>::Player::minimise, provokable);
  auto solution = internal::iterate_policies(attacker, options);
  RobustEvaluation<Scalar> result;
  result.q = std::move(solution.q);
  result.v = std::move(solution.v);
  result.composed = std::move(solution.policy);
  result.error = solution.error;
  result.sweeps = solution.sweeps;
  result.attack.resize(result.composed.size());
  for (State s = 0; s < mdp.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    result.attack[i] = disguise(perturbation, policy, s, result.composed[i]);
  }
  return result;
}

template RobustEvaluation<double> evaluate_against_optimal_attack(const FiniteMdp<double>&, const Perturbation<double>&,
                                                                  const Policy&, const SolverOptions&);
template RobustEvaluation<Rational> evaluate_against_optimal_attack(const FiniteMdp<Rational>&,
                                                                    const Perturbation<Rational>&, const Policy&,
                                                                    const SolverOptions&);

}  // namespace maximin
