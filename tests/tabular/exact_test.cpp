// Rational arithmetic through the solvers: residuals are zero, not small.

#include <gtest/gtest.h>

#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/bellman.hpp>
#include <maximin/theory/random.hpp>

#include "../theory/small_models.hpp"

namespace maximin {
namespace {

/// A model of rationals with `successors` successors a row, weights 1 to 9, rewards in tenths.
FiniteMdp<Rational> rational_model(State n, Action actions, int successors, Stream& rng) {
  FiniteMdpBuilder<Rational> b(n, actions, Rational(19, 20));
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      b.reward(s, a, Rational(rng.integer(-30, 30), 10));
      std::vector<State> targets;
      for (State t = 0; t < n; ++t) targets.push_back(t);
      for (int k = 0; k < successors; ++k) std::swap(targets[k], targets[rng.integer(k, n - 1)]);
      std::vector<int> weights;
      int total = 0;
      for (int k = 0; k < successors; ++k) total += weights.emplace_back(rng.integer(1, 9));
      for (int k = 0; k < successors; ++k) b.transition(s, a, targets[k], Rational(weights[k], total));
    }
  }
  return std::move(b).build();
}

TEST(ExactSolve, HasNoResidual) {
  Stream rng(1);
  for (int trial = 0; trial < 20; ++trial) {
    const auto mdp = rational_model(rng.integer(4, 30), 2, 3, rng);
    Policy policy;
    for (State s = 0; s < mdp.states(); ++s) policy.push_back(rng.integer(0, 1));
    const auto v = solve_policy_values(mdp, policy);
    for (State s = 0; s < mdp.states(); ++s) {
      const Action a = policy[s];
      EXPECT_EQ(v[s], mdp.reward(s, a) + mdp.discount() * mdp.expectation(s, a, v));
    }
  }
}

TEST(ExactSolve, OneUnknownByHand) {
  const auto x = solve_exactly({Rational(1, 3), {Rational(5, 7)}, {{{0, Rational(1)}}}});
  EXPECT_EQ(x[0], Rational(15, 14));
}

TEST(ExactSolve, RefusesWhatWouldNotEnd) {
  ExactSystem system{Rational(1, 2), {}, {}};
  system.rewards.resize(max_exact_unknowns + 1);
  system.rows.resize(max_exact_unknowns + 1);
  EXPECT_THROW(solve_exactly(system), BudgetExhausted);
}

TEST(ScaledMdp, BacksUpAsRationalsDo) {
  Stream rng(2);
  const auto mdp = rational_model(9, 3, 4, rng);
  Values<Rational> v(9);
  for (State s = 0; s < 9; ++s) v[s] = Rational(rng.integer(-9, 9), rng.integer(1, 9));
  const ScaledTable q = ScaledMdp(mdp).backup(ScaledValues(v));
  QTable<Rational> expected;
  backup(mdp, v, expected);
  EXPECT_EQ(q.rational(), expected);
  EXPECT_EQ(ScaledValues(v).rational(), v);
}

TEST(ScaledTable, DistancesAreThoseOfTheRationals) {
  QTable<Integer> x(1, 2), y(1, 2);
  x << 1, 7;
  y << 4, 1;
  for (const int denominator : {3, 5}) {  // shared, and not
    const ScaledTable p{x, 3}, q{y, denominator};
    EXPECT_EQ(difference(p, q).rational(), p.rational() - q.rational());
    EXPECT_EQ(distance(p, q), p(0, 1) - q(0, 1));
    EXPECT_EQ(distance(q, p), distance(p, q));
  }
  EXPECT_EQ(difference({x, 3}, {y, 3}).denominator, 3);
}

TEST(ExactPolicyIteration, SolvesTheOptimalityEquation) {
  Stream rng(3);
  for (int trial = 0; trial < 20; ++trial) {
    const auto mdp = rational_model(rng.integer(4, 25), 3, 3, rng);
    const auto solution = policy_iteration(mdp);
    QTable<Rational> q;
    Values<Rational> v;
    bellman_optimality(mdp, solution.q, v, q);
    EXPECT_EQ(q, solution.q);
    EXPECT_EQ(v, solution.v);
    EXPECT_EQ(solution.error, 0);
  }
}

TEST(ExactPolicyIteration, RepairsWhatFloatingPointCannotTellApart) {
  // Action 1 is better by 10^-40: in floating point the two are one.
  const Rational tiny = 1 / Rational(boost::multiprecision::pow(Integer(10), 40));
  FiniteMdpBuilder<Rational> b(1, 2, Rational(9, 10));
  b.reward(0, 0, 1).reward(0, 1, 1 + tiny).transition(0, 0, 0, 1).transition(0, 1, 0, 1);
  const auto solution = policy_iteration(std::move(b).build());
  EXPECT_EQ(solution.policy, Policy{1});
  EXPECT_EQ(solution.v[0], 10 * (1 + tiny));
}

TEST(ExactPolicyIteration, TakesRewardsThatFloatingPointCannotHold) {
  const Rational huge(boost::multiprecision::pow(Integer(10), 400));
  FiniteMdpBuilder<Rational> b(2, 2, Rational(1, 2));
  b.reward(0, 1, huge).transition(0, 0, 0, 1).transition(0, 1, 1, 1).transition(1, 0, 1, 1).transition(1, 1, 1, 1);
  EXPECT_EQ(policy_iteration(std::move(b).build()).v[0], huge);
}

TEST(ExactPolicyIteration, BreaksTiesAsAsked) {
  FiniteMdpBuilder<Rational> b(1, 3, Rational(1, 2));
  for (Action a = 0; a < 3; ++a) b.reward(0, a, a == 0 ? 0 : 1).transition(0, a, 0, 1);
  const auto mdp = std::move(b).build();
  EXPECT_EQ(policy_iteration(mdp).policy, Policy{1});
  SolverOptions highest;
  highest.tie = TieBreak::highest_index;
  EXPECT_EQ(policy_iteration(mdp, highest).policy, Policy{2});
}

TEST(ExactOptimalAttack, SolvesTheRobustEquation) {
  Stream rng(4);
  const auto mdp = rational_model(12, 3, 3, rng);
  const Perturbation<Rational> balls(Metric<Rational>::discrete(12), Rational(1));
  Policy policy;
  for (State s = 0; s < 12; ++s) policy.push_back(rng.integer(0, 2));
  const auto robust = evaluate_against_optimal_attack(mdp, balls, policy);
  QTable<Rational> q;
  Values<Rational> v;
  bellman_robust(mdp, policy, balls, robust.q, v, q);
  EXPECT_EQ(q, robust.q);
}

}  // namespace
}  // namespace maximin
