#include <maximin/tabular/exact_control.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/scaled.hpp>

namespace maximin::internal {

FiniteMdp<double> rounded(const FiniteMdp<Rational>& mdp) {
  FiniteMdpBuilder<double> builder(mdp.states(), mdp.actions(), static_cast<double>(mdp.discount()));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, static_cast<double>(mdp.reward(s, a)));
      for (const auto& next : mdp.successors(s, a)) {
        builder.transition(s, a, next.target, static_cast<double>(next.probability));
      }
    }
  }
  return std::move(builder).build();
}

namespace {

/// What floating point finds best; any policy, where the numbers do not fit.
Policy floating_point_policy(const ControlProblem<Rational>& problem) {
  const State n = problem.mdp().states();
  std::vector<std::vector<Action>> choices;
  for (State s = 0; s < n; ++s) {
    const auto list = problem.choices(s);
    choices.emplace_back(list.begin(), list.end());
  }
  try {
    const FiniteMdp<double> mdp = rounded(problem.mdp());
    const auto player = problem.maximises() ? ControlProblem<double>::Player::maximise  //
                                            : ControlProblem<double>::Player::minimise;
    return iterate_policies(ControlProblem<double>(mdp, player, choices), SolverOptions{}).policy;
  } catch (const std::runtime_error&) {
    Policy first;
    for (const auto& list : choices) first.push_back(list.front());
    return first;
  }
}

/// The choice with the best backup, the first or the last of them.
Action best_choice(const ControlProblem<Rational>& problem, const ScaledTable& q, State s, TieBreak tie) {
  const auto better = [&](Action x, Action y) {
    return problem.maximises() ? q.numerators(s, x) > q.numerators(s, y) : q.numerators(s, x) < q.numerators(s, y);
  };
  const auto list = problem.choices(s);
  Action best = list.front();
  for (const Action a : list.subspan(1)) {
    if (tie == TieBreak::lowest_index ? better(a, best) : !better(best, a)) best = a;
  }
  return best;
}

/// Moves to strictly better choices. Returns whether there was one.
bool improve(const ControlProblem<Rational>& problem, const ScaledTable& q, Policy& policy) {
  bool changed = false;
  for (State s = 0; s < q.numerators.rows(); ++s) {
    Action& current = policy[static_cast<std::size_t>(s)];
    const Action best = best_choice(problem, q, s, TieBreak::lowest_index);
    if (q.numerators(s, best) == q.numerators(s, current)) continue;
    current = best;
    changed = true;
  }
  return changed;
}

}  // namespace

Values<Rational> solve_policy_values_exactly(const FiniteMdp<Rational>& mdp, const Policy& action) {
  ExactSystem system{mdp.discount(), {}, {}};
  for (State s = 0; s < mdp.states(); ++s) {
    const Action a = action[static_cast<std::size_t>(s)];
    const auto row = mdp.successors(s, a);
    system.rewards.push_back(mdp.reward(s, a));
    system.rows.emplace_back(row.begin(), row.end());
  }
  return solve_exactly(system);
}

CertifiedSolution<Rational> iterate_policies_exactly(const ControlProblem<Rational>& problem,
                                                     const SolverOptions& options) {
  const ScaledMdp scaled(problem.mdp());
  CertifiedSolution<Rational> solution;
  solution.policy = floating_point_policy(problem);
  ScaledTable q;
  do {
    solution.v = solve_policy_values_exactly(problem.mdp(), solution.policy);
    q = scaled.backup(ScaledValues(solution.v));
    ++solution.sweeps;
  } while (improve(problem, q, solution.policy));
  for (State s = 0; s < q.numerators.rows(); ++s) {
    solution.policy[static_cast<std::size_t>(s)] = best_choice(problem, q, s, options.tie);
  }
  solution.q = q.rational();
  return solution;
}

}  // namespace maximin::internal
