#include <maximin/tabular/optimal_attack.hpp>

#include <gtest/gtest.h>

#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/theory/policies.hpp>

#include "../theory/small_models.hpp"
#include "random_model.hpp"

namespace maximin {
namespace {

TEST(OptimalAttack, LuresTheAgentIntoTheTrap) {
  // On the one-sided model the agent that does action 0 where it sees 0 or 1 is sent from 1 to 20 without any attack;
  // one that tells them apart is sent there by showing each state as the other.
  const auto mdp = one_sided<double>();
  const auto found = evaluate_against_optimal_attack(mdp, one_sided_balls<double>(), {0, 1, 0});
  EXPECT_NEAR(found.v[0], -20, 1e-9) << "0 now, -40 from the next step on";
  EXPECT_NEAR(found.v[1], -21, 1e-9);
  EXPECT_NEAR(found.v[2], -40, 1e-9);
  EXPECT_EQ(found.attack, (AttackPolicy{1, 0, 2}));
  EXPECT_EQ(found.composed, (Policy{1, 0, 0}));
}

/// State 0 can be shown as 1, so that the agent takes action 1: it pays 1 less at once, but leads away from a loss. A
/// myopic attacker takes the 1 and forgoes the loss.
TEST(OptimalAttack, MayForgoHarmNowForMoreHarmLater) {
  FiniteMdpBuilder<double> b(4, 2, 0.9);
  b.reward(0, 0, 1).transition(0, 0, 2, 1);  // pays now, to the bad state
  b.reward(0, 1, 0).transition(0, 1, 3, 1);  // pays nothing, to the good one
  for (Action a = 0; a < 2; ++a) {
    b.transition(1, a, 3, 1);
    b.reward(2, a, -10).transition(2, a, 2, 1);
    b.reward(3, a, 10).transition(3, a, 3, 1);
  }
  const auto mdp = std::move(b).build();
  const auto balls = Perturbation<double>::from_neighbourhoods({{0, 1}, {0, 1}, {2}, {3}});
  const Policy policy{1, 0, 0, 0};
  const auto found = evaluate_against_optimal_attack(mdp, balls, policy);
  EXPECT_NEAR(found.v[0], 1 - 90, 1e-9);
  EXPECT_EQ(found.composed[0], 0);
  AttackPolicy myopic;
  best_response_attack(mdp.rewards(), policy, balls, myopic);
  EXPECT_EQ(policy[static_cast<std::size_t>(myopic[0])], 1);
}

TEST(OptimalAttack, WithTrivialBallsItIsThePolicysValue) {
  Stream rng(1);
  const auto mdp = random_model(20, 3, 0.9, rng);
  Policy policy;
  for (State s = 0; s < 20; ++s) policy.push_back(rng.below(3));
  const auto found = evaluate_against_optimal_attack(mdp, line_balls(20, 0), policy);
  const auto value = evaluate_policy(mdp, policy);
  EXPECT_LE((found.v - value.v).cwiseAbs().maxCoeff(), found.error + value.error);
  EXPECT_EQ(found.attack, no_attack(20));
}

TEST(OptimalAttack, AWiderBallLeavesLess) {
  Stream rng(2);
  const auto mdp = random_model(20, 3, 0.9, rng);
  Policy policy;
  for (State s = 0; s < 20; ++s) policy.push_back(rng.below(3));
  auto before = evaluate_against_optimal_attack(mdp, line_balls(20, 0), policy);
  for (const double eps : {1.0, 2.0, 5.0, 19.0}) {
    const auto now = evaluate_against_optimal_attack(mdp, line_balls(20, eps), policy);
    EXPECT_LE((now.v - before.v).maxCoeff(), now.error + before.error);
    EXPECT_LT(now.v.sum(), before.v.sum() + 1e-9);
    before = now;
  }
}

TEST(OptimalAttack, GivesUpRatherThanReturnUncertifiedValues) {
  Stream rng(3);
  const auto mdp = random_model(20, 3, 0.9, rng);
  EXPECT_THROW(evaluate_against_optimal_attack(mdp, line_balls(20, 1), Policy(20, 0), {.max_sweeps = 1}),
               BudgetExhausted);
}

}  // namespace
}  // namespace maximin
