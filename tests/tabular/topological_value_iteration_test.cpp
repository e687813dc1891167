#include <gtest/gtest.h>

#include <cmath>

#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/topological_value_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {
namespace {

/// A random model whose arcs seldom lead back: many components, some of several states.
FiniteMdp<double> random_terraces(State n, double discount, std::uint64_t trial) {
  Stream rng(5, trial);
  FiniteMdpBuilder<double> b(n, 3, discount);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < 3; ++a) {
      b.reward(s, a, rng.uniform(-10, 10));
      const State first = rng.chance(0.3) ? std::max(0, s - rng.below(3)) : s;
      const State second = std::min(n - 1, first + 1 + rng.below(4));
      const double p = rng.uniform();
      if (second == first) {
        b.transition(s, a, first, 1);
      } else {
        b.transition(s, a, first, p).transition(s, a, second, 1 - p);
      }
    }
  }
  return std::move(b).build();
}

void expect_same(const CertifiedSolution<double>& x, const CertifiedSolution<double>& y) {
  const double slack = x.error + y.error;
  EXPECT_LE((x.v - y.v).cwiseAbs().maxCoeff(), slack);
  EXPECT_LE((x.q - y.q).cwiseAbs().maxCoeff(), slack);
}

TEST(TopologicalValueIteration, GeometricSumsInClosedForm) {
  // A loop that pays 1 for ever, and a corridor of three steps to it that pays nothing.
  FiniteMdpBuilder<double> b(4, 1, 0.5);
  for (State s = 0; s < 3; ++s) b.transition(s, 0, s + 1, 1);
  b.transition(3, 0, 3, 1).reward(3, 0, 1);
  const auto found = topological_value_iteration(std::move(b).build());
  const double expected[] = {0.25, 0.5, 1, 2};
  for (State s = 0; s < 4; ++s) EXPECT_NEAR(found.v[s], expected[s], found.error);
  EXPECT_LT(found.error, 1e-11);
  EXPECT_LE(found.sweeps, 3);
}

TEST(TopologicalValueIteration, ALoopWithALeakInClosedForm) {
  // V = 1 + gamma (p V + (1-p) W), W = 3/(1-gamma).
  FiniteMdpBuilder<double> b(2, 1, 0.9);
  b.transition(0, 0, 0, 0.75).transition(0, 0, 1, 0.25).reward(0, 0, 1);
  b.transition(1, 0, 1, 1).reward(1, 0, 3);
  const auto found = topological_value_iteration(std::move(b).build());
  EXPECT_NEAR(found.v[1], 30, 1e-9);
  EXPECT_NEAR(found.v[0], (1 + 0.9 * 0.25 * 30) / (1 - 0.9 * 0.75), 1e-9);
}

TEST(TopologicalValueIteration, AComponentOfTwoWithAnExitInClosedForm) {
  // 0 <-> 1 for nothing, or leave 1 for a state worth 10: V(1) = gamma 10, V(0) = gamma^2 10.
  FiniteMdpBuilder<double> b(3, 2, 0.9);
  b.transition(0, 0, 1, 1).transition(0, 1, 1, 1);
  b.transition(1, 0, 0, 1).transition(1, 1, 2, 1);
  b.transition(2, 0, 2, 1).transition(2, 1, 2, 1).reward(2, 0, 1);
  const auto found = topological_value_iteration(std::move(b).build());
  EXPECT_NEAR(found.v[2], 10, 1e-10);
  EXPECT_NEAR(found.v[1], 9, 1e-10);
  EXPECT_NEAR(found.v[0], 8.1, 1e-10);
  EXPECT_EQ(found.policy[1], 1);
}

TEST(TopologicalValueIteration, AgreesWithTheOtherSolversWithinTheCertificates) {
  for (std::uint64_t trial = 0; trial < 60; ++trial) {
    const double discount = trial % 3 == 0 ? 0.5 : trial % 3 == 1 ? 0.95 : 0.995;
    const auto mdp = random_terraces(2 + static_cast<State>(trial), discount, trial);
    const auto found = topological_value_iteration(mdp);
    expect_same(found, policy_iteration(mdp));
    expect_same(found, value_iteration(mdp));
  }
}

TEST(TopologicalValueIteration, ALargeComponentIsSwept) {
  // A ring of 1,500 states, one of which pays 1: V = gamma^distance / (1 - gamma^1500).
  constexpr State n = 1500;
  FiniteMdpBuilder<double> b(n, 1, 0.99);
  for (State s = 0; s < n; ++s) b.transition(s, 0, (s + 1) % n, 1);
  b.reward(0, 0, 1);
  const auto found = topological_value_iteration(std::move(b).build());
  for (State s = 0; s < n; s += 100) {
    const int distance = (n - s) % n;
    EXPECT_NEAR(found.v[s], std::pow(0.99, distance) / (1 - std::pow(0.99, n)), found.error + 1e-12);
  }
}

TEST(TopologicalValueIteration, AChainOfManyComponentsTakesFewSweeps) {
  constexpr State n = 2000;
  FiniteMdpBuilder<double> b(n, 1, 0.999);
  for (State s = 0; s + 1 < n; ++s) b.transition(s, 0, s + 1, 1);
  b.transition(n - 1, 0, n - 1, 1).reward(n - 1, 0, 1);
  const auto mdp = std::move(b).build();
  const auto found = topological_value_iteration(mdp);
  EXPECT_LE(found.sweeps, 3);
  EXPECT_GT(value_iteration(mdp).sweeps, 1000) << "the comparison must mean something";
}

TEST(TopologicalValueIteration, GivesUpRatherThanReturnUncertifiedValues) {
  SolverOptions options;
  options.tolerance = 1e-30;
  options.max_sweeps = 50;
  EXPECT_THROW(topological_value_iteration(random_terraces(20, 0.99, 1), options), BudgetExhausted);
}

TEST(TopologicalValueIteration, TheCertificateCanFail) {
  // Negative control: values of a model with another reward are outside the certificate.
  const auto mdp = random_terraces(20, 0.9, 2);
  FiniteMdpBuilder<double> b(20, 3, 0.9);
  for (State s = 0; s < 20; ++s) {
    for (Action a = 0; a < 3; ++a) {
      b.reward(s, a, mdp.reward(s, a) + 1e-6);
      for (const auto& next : mdp.successors(s, a)) b.transition(s, a, next.target, next.probability);
    }
  }
  const auto right = topological_value_iteration(mdp), wrong = topological_value_iteration(std::move(b).build());
  EXPECT_GT((right.v - wrong.v).cwiseAbs().maxCoeff(), right.error + wrong.error);
}

}  // namespace
}  // namespace maximin
