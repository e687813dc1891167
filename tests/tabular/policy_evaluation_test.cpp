#include <maximin/tabular/policy_evaluation.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include "random_model.hpp"

namespace maximin {
namespace {

/// A ring of n states; action 0 steps on and pays 1 when leaving state 0, action 1 stays and pays 2.
FiniteMdp<double> ring(State n, double discount) {
  FiniteMdpBuilder<double> b(n, 2, discount);
  b.reward(0, 0, 1);
  for (State s = 0; s < n; ++s) {
    b.transition(s, 0, (s + 1) % n, 1).transition(s, 1, s, 1).reward(s, 1, 2);
  }
  return std::move(b).build();
}

/// Small systems are solved dense, large sparse ones sparse.
class Evaluation : public testing::TestWithParam<State> {};

TEST_P(Evaluation, OfARingInClosedForm) {
  const State n = GetParam();
  const double gamma = 0.9;
  const auto mdp = ring(n, gamma);
  const Policy on(static_cast<std::size_t>(n), 0);
  const auto direct = evaluate_policy(mdp, on), iterative = evaluate_policy_iteratively(mdp, on);
  const Values<double> solved = solve_policy_values(mdp, on);
  const double round_trip = 1 / (1 - std::pow(gamma, n));
  for (State s = 0; s < n; ++s) {
    const double expected = std::pow(gamma, (n - s) % n) * round_trip;
    EXPECT_NEAR(direct.v[s], expected, 1e-10);
    EXPECT_NEAR(iterative.v[s], expected, 1e-10);
    EXPECT_NEAR(solved[s], expected, 1e-10);
    EXPECT_NEAR(direct.q(s, 1), 2 + gamma * expected, 1e-10) << "one deviation, then the policy";
  }
  EXPECT_EQ(direct.policy, on);
  EXPECT_LE((direct.q - iterative.q).cwiseAbs().maxCoeff(), direct.error + iterative.error);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Evaluation, testing::Values(1, 2, 64, 65, 500));

TEST(PolicyEvaluation, DenseSystemsBeyondTheSmallOnes) {
  constexpr State n = 80;
  FiniteMdpBuilder<double> b(n, 1, 0.95);
  for (State s = 0; s < n; ++s) {
    b.reward(s, 0, s % 7);
    for (State t = 0; t < n; ++t) b.transition(s, 0, t, 1.0 / n);
  }
  const auto mdp = std::move(b).build();
  const Policy only(n, 0);
  const double mean = mdp.rewards().mean();
  const auto direct = evaluate_policy(mdp, only);
  for (State s = 0; s < n; ++s) EXPECT_NEAR(direct.v[s], mdp.reward(s, 0) + 0.95 * mean / 0.05, 1e-9);
}

TEST(PolicyEvaluation, DirectAndIterativeAgreeOnRandomModels) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Stream rng(1, trial);
    const State n = rng.integer(2, 200);
    const auto mdp = random_model(n, 3, rng.uniform(0, 0.99), rng);
    Policy action;
    for (State s = 0; s < n; ++s) action.push_back(rng.below(3));
    const auto direct = evaluate_policy(mdp, action), iterative = evaluate_policy_iteratively(mdp, action);
    EXPECT_LE((direct.q - iterative.q).cwiseAbs().maxCoeff(), direct.error + iterative.error);
    EXPECT_LE((direct.v - iterative.v).cwiseAbs().maxCoeff(), direct.error + iterative.error);
  }
}

TEST(PolicyEvaluation, GivesUpRatherThanReturnUncertifiedValues) {
  const auto mdp = ring(50, 0.99);
  EXPECT_THROW(evaluate_policy_iteratively(mdp, Policy(50, 0), {.max_sweeps = 10}), BudgetExhausted);
}

}  // namespace
}  // namespace maximin
