#include <maximin/tabular/value_iteration.hpp>

#include <gtest/gtest.h>

#include <string>

#include "random_model.hpp"

namespace maximin {
namespace {

/// State 0: wait for 1 a step, or move on to state 1, which pays 3 a step for ever. gamma = 1/2.
FiniteMdp<double> wait_or_move() {
  FiniteMdpBuilder<double> b(2, 2, 0.5);
  b.transition(0, 0, 0, 1).reward(0, 0, 1).transition(0, 1, 1, 1);
  b.transition(1, 0, 1, 1).reward(1, 0, 3).transition(1, 1, 1, 1).reward(1, 1, 3);
  return std::move(b).build();
}

TEST(ValueIteration, InClosedForm) {
  const auto found = value_iteration(wait_or_move());
  EXPECT_NEAR(found.v[0], 3, found.error) << "waiting for ever is worth 2";
  EXPECT_NEAR(found.v[1], 6, found.error);
  EXPECT_NEAR(found.q(0, 0), 1 + 0.5 * 3, found.error);
  EXPECT_NEAR(found.q(0, 1), 3, found.error);
  EXPECT_NEAR(found.q(1, 1), 6, found.error);
  EXPECT_EQ(found.policy, (Policy{1, 0}));
  EXPECT_GT(found.error, 0);
  EXPECT_LT(found.error, 1e-11);
  EXPECT_EQ(value_iteration(wait_or_move(), {.tie = TieBreak::highest_index}).policy, (Policy{1, 1}));
}

/// Without the span correction one sweep of V = 1000 is V = 1.
TEST(ValueIteration, TheSpanCorrectionIsPartOfTheAnswer) {
  FiniteMdpBuilder<double> b(1, 1, 0.999);
  b.transition(0, 0, 0, 1).reward(0, 0, 1);
  const auto found = value_iteration(std::move(b).build());
  EXPECT_NEAR(found.v[0], 1000, found.error);
  EXPECT_EQ(found.sweeps, 1);
}

TEST(ValueIteration, WithoutAFutureItIsTheRewards) {
  FiniteMdpBuilder<double> b(2, 2, 0);
  b.reward(0, 0, 4).reward(0, 1, 5).reward(1, 0, -1).reward(1, 1, -2);
  for (State s = 0; s < 2; ++s) b.transition(s, 0, 0, 1).transition(s, 1, 1, 1);
  const auto mdp = std::move(b).build();
  const auto found = value_iteration(mdp);
  EXPECT_EQ(found.q, mdp.rewards());
  EXPECT_EQ(found.policy, (Policy{1, 0}));
}

TEST(ValueIteration, OfNoRewardsIsNothing) {
  FiniteMdpBuilder<double> b(2, 1, 0.9);
  b.transition(0, 0, 1, 1).transition(1, 0, 0, 1);
  const auto found = value_iteration(std::move(b).build());
  EXPECT_EQ(found.v, Values<double>::Zero(2));
  EXPECT_LE(found.error, 1e-300);
}

TEST(ValueIteration, ALooserToleranceIsCheaperAndHonest) {
  Stream rng(1);
  const auto mdp = random_model(30, 3, 0.95, rng);
  const auto exact = value_iteration(mdp);
  long sweeps = exact.sweeps + 1;
  for (const double tolerance : {1e-9, 1e-6, 1e-3}) {
    const auto loose = value_iteration(mdp, {.tolerance = tolerance});
    EXPECT_LE(loose.error, tolerance * 1 / (1 - 0.95));
    EXPECT_LE((loose.q - exact.q).cwiseAbs().maxCoeff(), loose.error + exact.error);
    EXPECT_LT(loose.sweeps, sweeps);
    sweeps = loose.sweeps;
  }
}

TEST(ValueIteration, GivesUpRatherThanReturnUncertifiedValues) {
  Stream rng(2);
  const auto mdp = random_model(30, 3, 0.95, rng);
  try {
    value_iteration(mdp, {.max_sweeps = 5});
    FAIL() << "expected BudgetExhausted";
  } catch (const BudgetExhausted& e) {
    const std::string message = e.what();
    EXPECT_EQ(message.rfind("value iteration: certified error ", 0), 0u) << message;
    EXPECT_NE(message.find("after 5 sweeps"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace maximin
