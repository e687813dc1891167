// Every solver against values in long double that none of them had a part in: certified errors must be true.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/control.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/topological_value_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/policies.hpp>

#include "random_tables.hpp"
#include "reference.hpp"

namespace maximin {
namespace {

using reference::Real;

/// How far the reference itself may be off.
Real reference_error(const FiniteMdp<double>& mdp) {
  return 1e-17L * reference::scale(mdp) / (1 - Real(mdp.discount()));
}

/// Whether the true values are where the certificate says.
bool honest(const FiniteMdp<double>& mdp, const QTable<double>& q, const Values<double>& v, double error,
            const QTable<Real>& true_q, const Values<Real>& true_v) {
  const Real allowed = Real(error) + reference_error(mdp);
  return (q.cast<Real>() - true_q).cwiseAbs().maxCoeff() <= allowed &&
         (v.cast<Real>() - true_v).cwiseAbs().maxCoeff() <= allowed;
}

/// Nothing needs a larger error than this by default.
bool small(const FiniteMdp<double>& mdp, double error) {
  return error <= 1e-10 * static_cast<double>(reference::scale(mdp));
}

RC_GTEST_PROP(Solvers, AgreeOnQStarWithinTheirCertificates, (const FiniteMdp<double>& mdp)) {
  const QTable<Real> q = reference::optimal(mdp);
  const Values<Real> v = q.rowwise().maxCoeff();
  for (const TieBreak tie : both_ties) {
    const SolverOptions options{.tie = tie};
    const CertifiedSolution<double> solutions[] = {
        value_iteration(mdp, options), policy_iteration(mdp, options), modified_policy_iteration(mdp, options),
        modified_policy_iteration(mdp, options, 3), topological_value_iteration(mdp, options)};
    for (const auto& found : solutions) {
      RC_ASSERT(honest(mdp, found.q, found.v, found.error, q, v));
      RC_ASSERT(small(mdp, found.error));
      // The policy that comes with them is as good as they are.
      const Values<Real> lost = v - reference::values_of(mdp, found.policy);
      RC_ASSERT(lost.maxCoeff() <= 4 * Real(found.error) / (1 - Real(mdp.discount())) + reference_error(mdp));
    }
  }
}

RC_GTEST_PROP(Solvers, CertifyLooseAnswersTruthfully, (const FiniteMdp<double>& mdp)) {
  const int decimals = *rc::gen::inRange(1, 8);
  const SolverOptions options{.tolerance = std::pow(10.0, -decimals)};
  const QTable<Real> q = reference::optimal(mdp);
  const Values<Real> v = q.rowwise().maxCoeff();
  for (const auto& found : {value_iteration(mdp, options), modified_policy_iteration(mdp, options, 2)}) {
    RC_ASSERT(honest(mdp, found.q, found.v, found.error, q, v));
    RC_ASSERT(found.error <= (1 + 1e-9) * options.tolerance * static_cast<double>(reference::scale(mdp)));
  }
}

RC_GTEST_PROP(Solvers, DirectAndIterativeEvaluationAgree, (const FiniteMdp<double>& mdp, std::uint64_t seed)) {
  Stream rng(seed);
  const Policy composed = random_policy(mdp, rng);
  const Values<Real> v = reference::values_of(mdp, composed);
  const QTable<Real> q = reference::of_pair(mdp, composed);
  const auto direct = evaluate_policy(mdp, composed), iterative = evaluate_policy_iteratively(mdp, composed);
  RC_ASSERT(honest(mdp, direct.q, direct.v, direct.error, q, v));
  RC_ASSERT(honest(mdp, iterative.q, iterative.v, iterative.error, q, v));
  RC_ASSERT((direct.q - iterative.q).cwiseAbs().maxCoeff() <= direct.error + iterative.error);
  RC_ASSERT(small(mdp, direct.error) && small(mdp, iterative.error));
  RC_ASSERT(direct.policy == composed && iterative.policy == composed);
  const Values<double> solved = solve_policy_values(mdp, composed);
  RC_ASSERT(static_cast<double>((solved.cast<Real>() - v).cwiseAbs().maxCoeff()) <=
            1e-10 * static_cast<double>(reference::scale(mdp)));
}

RC_GTEST_PROP(Solvers, OptimalAttackIsTheFixedPointOfTheRobustOperator,
              (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const Policy policy = random_policy(model.mdp, rng);
  const QTable<Real> q = reference::attacked(model.mdp, balls, policy);
  for (const TieBreak tie : both_ties) {
    const auto found = evaluate_against_optimal_attack(model.mdp, balls, policy, {.tie = tie});
    // V is what the attack that comes with it leaves, and no more than that.
    const Values<Real> left = reference::values_of(model.mdp, found.composed);
    RC_ASSERT(honest(model.mdp, found.q, found.v, found.error, q, left));
    Policy composed;
    compose(policy, found.attack, composed);
    RC_ASSERT(composed == found.composed);
    for (State s = 0; s < model.mdp.states(); ++s) {
      RC_ASSERT(balls.contains(s, found.attack[static_cast<std::size_t>(s)]));
    }
  }
}

/// The bounds of every sweep, from the first, contain the fixed point.
bool macqueen_contains(const ControlProblem<double>& problem, const Values<Real>& truth) {
  const MacQueenBound<double> bound(problem.mdp());
  Values<double> v = Values<double>::Zero(problem.mdp().states()), tv;
  Policy policy;
  double last_error = INFINITY;
  for (int sweep = 0; sweep < 2000; ++sweep) {
    problem.sweep(v, tv, policy, TieBreak::lowest_index);
    const auto interval = bound(v, tv);
    const Values<Real> middle = tv.cast<Real>().array() + Real(interval.shift);
    const Real allowed = Real(interval.error) + reference_error(problem.mdp());
    if ((middle - truth).cwiseAbs().maxCoeff() > allowed) return false;
    if (interval.error >= last_error)
      return interval.error <= 1e-10 * static_cast<double>(reference::scale(problem.mdp()));
    last_error = interval.error;
    v.swap(tv);
  }
  return false;
}

RC_GTEST_PROP(MacQueenBound, ContainsTheValueAtEverySweep, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  using Problem = ControlProblem<double>;
  const auto& mdp = model.mdp;
  const auto balls = make_perturbation(model);
  const Policy policy = random_policy(mdp, rng);
  std::vector<std::vector<Action>> provokable, fixed;
  for (State s = 0; s < mdp.states(); ++s) {
    auto& list = provokable.emplace_back();
    for (const State t : balls.ball(s)) list.push_back(policy[static_cast<std::size_t>(t)]);
    fixed.push_back({policy[static_cast<std::size_t>(s)]});
  }
  const QTable<Real> q = reference::attacked(mdp, balls, policy);
  Values<Real> attacked(mdp.states());
  for (State s = 0; s < mdp.states(); ++s) {
    Real worst = INFINITY;
    for (const Action a : provokable[static_cast<std::size_t>(s)]) worst = std::min(worst, q(s, a));
    attacked[s] = worst;
  }
  RC_ASSERT(macqueen_contains(Problem::optimal_control(mdp), reference::optimal(mdp).rowwise().maxCoeff()));
  RC_ASSERT(macqueen_contains(Problem(mdp, Problem::Player::maximise, fixed), reference::values_of(mdp, policy)));
  RC_ASSERT(macqueen_contains(Problem(mdp, Problem::Player::minimise, provokable), attacked));
}

}  // namespace
}  // namespace maximin
