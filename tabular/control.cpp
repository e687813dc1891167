#include <maximin/tabular/control.hpp>

#include <string>

#include <fmt/format.h>

#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/theory/bellman.hpp>

namespace maximin::internal {
namespace {

[[noreturn]] void give_up(const char* method, long sweeps, double error, double target) {
  throw BudgetExhausted(
      fmt::format("{}: certified error {:.3g} after {} sweeps, asked for {:.3g}; allow more sweeps or a "
                  "larger tolerance",
                  method, error, sweeps, target));
}

/// How far the backups of v can be told apart at all.
template <class Scalar>
Scalar improvement_margin(const MacQueenBound<Scalar>& bound, const Values<Scalar>& v) {
  return Scalar(2) * bound.rounding_of_backup(v.cwiseAbs().maxCoeff());
}

/// Changes the policy only where another choice is better by more than the rounding of a backup.
template <class Scalar>
bool improve(const ControlProblem<Scalar>& problem, const Values<Scalar>& v, Scalar margin, Policy& policy) {
  bool changed = false;
  for (State s = 0; s < problem.mdp().states(); ++s) {
    Action& current = policy[static_cast<std::size_t>(s)];
    Action best = current;
    Scalar best_value = problem.backup(s, current, v);
    const Scalar kept = best_value;
    for (const Action a : problem.choices(s)) {
      const Scalar value = problem.backup(s, a, v);
      if (!problem.better(value, best_value)) continue;
      best = a;
      best_value = value;
    }
    if (std::abs(best_value - kept) > margin) {
      current = best;
      changed = true;
    }
  }
  return changed;
}

/// Evaluation is only as good as the rounding of the linear solve; a few plain sweeps bring it to the target.
template <class Scalar>
CertifiedSolution<Scalar> iterate_inexact_policies(const ControlProblem<Scalar>& problem,
                                                   const SolverOptions& options) {
  const MacQueenBound<Scalar> bound(problem.mdp());
  const Scalar target = bound.target(options);
  Values<Scalar> v = Values<Scalar>::Zero(problem.mdp().states()), tv;
  Policy policy;
  problem.sweep(v, tv, policy, options.tie);
  long sweeps = 1;
  // Improvement ends after a handful of solves; the limit is for a solve so inexact that it would go round in circles.
  constexpr long most_solves = 1000;
  do {
    if (sweeps >= options.max_sweeps) give_up("policy iteration", sweeps, INFINITY, target);
    v = solve_policy_values(problem.mdp(), policy);
    ++sweeps;
  } while (sweeps <= most_solves && improve(problem, v, improvement_margin(bound, v), policy));
  for (long polish = 0; polish < 1000 && sweeps < options.max_sweeps; ++polish, ++sweeps) {
    problem.sweep(v, tv, policy, options.tie);
    const auto interval = bound(v, tv);
    if (interval.error <= target) {
      tv.array() += interval.shift;
      return finish(problem, bound, std::move(tv), std::move(policy), interval.error, sweeps);
    }
    v.swap(tv);
  }
  give_up("policy iteration", sweeps, bound(v, tv).error, target);
}

}  // namespace

template <class Scalar>
CertifiedSolution<Scalar> finish(const ControlProblem<Scalar>& problem, const MacQueenBound<Scalar>& bound,
                                 Values<Scalar> v, Policy policy, Scalar error, long sweeps) {
  CertifiedSolution<Scalar> solution;
  backup(problem.mdp(), v, solution.q);
  solution.error = error + bound.rounding_of_backup(v.cwiseAbs().maxCoeff());
  solution.v = std::move(v);
  solution.policy = std::move(policy);
  solution.sweeps = sweeps;
  return solution;
}

template <class Scalar>
CertifiedSolution<Scalar> iterate_values(const ControlProblem<Scalar>& problem, const SolverOptions& options,
                                         long partial_sweeps) {
  const MacQueenBound<Scalar> bound(problem.mdp());
  const Scalar target = bound.target(options);
  Values<Scalar> v = Values<Scalar>::Zero(problem.mdp().states()), tv;
  Policy policy;
  for (long sweeps = 1;; ++sweeps) {
    problem.sweep(v, tv, policy, options.tie);
    const auto interval = bound(v, tv);
    if (interval.error <= target) {
      tv.array() += interval.shift;
      return finish(problem, bound, std::move(tv), std::move(policy), interval.error, sweeps);
    }
    if (!(sweeps + partial_sweeps < options.max_sweeps)) {
      give_up(partial_sweeps ? "modified policy iteration" : "value iteration", sweeps, interval.error, target);
    }
    for (long k = 0; k < partial_sweeps; ++k, ++sweeps) {
      v.swap(tv);
      problem.sweep_policy(v, policy, tv);
    }
    v.swap(tv);
  }
}

template <class Scalar>
CertifiedSolution<Scalar> iterate_policies(const ControlProblem<Scalar>& problem, const SolverOptions& options) {
  if constexpr (is_exact_v<Scalar>) {
    return iterate_policies_exactly(problem, options);
  } else {
    return iterate_inexact_policies(problem, options);
  }
}

template CertifiedSolution<double> finish(const ControlProblem<double>&, const MacQueenBound<double>&, Values<double>,
                                          Policy, double, long);
template CertifiedSolution<double> iterate_values(const ControlProblem<double>&, const SolverOptions&, long);
template CertifiedSolution<double> iterate_policies(const ControlProblem<double>&, const SolverOptions&);
template CertifiedSolution<Rational> iterate_policies(const ControlProblem<Rational>&, const SolverOptions&);

}  // namespace maximin::internal
