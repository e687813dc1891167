#include <maximin/tabular/belief_game.hpp>

#include <gtest/gtest.h>

#include <string>

#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>

#include "../theory/small_models.hpp"
#include "random_model.hpp"

namespace maximin {
namespace {

/// States 0 and 1 look alike and stay what they are; action a pays 1 in state a, else 0. State 2 leads to state 1 and
/// looks like neither, so that an agent that comes from there knows where it is. gamma = 1/2.
FiniteMdp<double> told_apart_by_history() {
  FiniteMdpBuilder<double> b(3, 2, 0.5);
  for (Action a = 0; a < 2; ++a) {
    b.transition(0, a, 0, 1).transition(1, a, 1, 1).transition(2, a, 1, 1);
    b.reward(a, a, 1);
  }
  return std::move(b).build();
}

Perturbation<double> two_alike() {
  return Perturbation<double>::from_neighbourhoods({{0, 1}, {0, 1}, {2}});
}

TEST(BeliefGame, HistoryTellsLookalikesApart) {
  const auto mdp = told_apart_by_history();
  const auto balls = two_alike();
  const auto q = policy_iteration(mdp).q;
  const auto game = solve_belief_game(mdp, balls, maximin_belief_policy(q), {.keep_positions = true});
  // Started among the lookalikes, the agent does action 0 for ever; started in 2, it is told.
  EXPECT_NEAR(game.v[0], 2, game.error);
  EXPECT_NEAR(game.v[1], 0, game.error);
  EXPECT_NEAR(game.v[2], 1, game.error) << "nothing now, then 2";
  EXPECT_EQ(game.positions, 4);
  EXPECT_EQ(game.beliefs, 3) << "{0,1}, {2} and {1}";
  EXPECT_EQ(game.reach, 1);
  EXPECT_EQ(game.mean_size, (2 + 2 + 1 + 1) / 4.0);
  ASSERT_EQ(game.w.size(), 4u);
  EXPECT_NEAR(game.w.at({1, {0, 1}}), 0, game.error);
  EXPECT_NEAR(game.w.at({1, {1}}), 2, game.error);
  // An agent without memory is not told.
  const auto forgetful =
      evaluate_against_optimal_attack(mdp, balls, stationary_policy_of(balls, maximin_belief_policy(q)));
  EXPECT_NEAR(forgetful.v[2], 0, 1e-9);
}

TEST(BeliefGame, TiesAreBrokenAsAsked) {
  const auto mdp = told_apart_by_history();
  const auto q = policy_iteration(mdp).q;
  const auto policy = maximin_belief_policy(q, TieBreak::highest_index);
  EXPECT_EQ(stationary_policy_of(two_alike(), policy), (Policy{1, 1, 1}));
  EXPECT_EQ(stationary_policy_of(two_alike(), maximin_belief_policy(q)), (Policy{0, 0, 0}));
}

TEST(BeliefGame, OnTheOneSidedModelTheBeliefIsOfNoHelp) {
  const auto mdp = one_sided<double>();
  const auto balls = one_sided_balls<double>();
  const auto policy = maximin_belief_policy(policy_iteration(mdp).q);
  const auto game = solve_belief_game(mdp, balls, policy);
  const auto ball = evaluate_against_optimal_attack(mdp, balls, stationary_policy_of(balls, policy));
  EXPECT_LE(game.v[2], -40 + 1e-9);
  EXPECT_LE(std::min(game.v[0], game.v[1]), -20 + 1e-9);
  EXPECT_LE(std::min(ball.v[0], ball.v[1]), -20 + 1e-9);
}

TEST(BeliefGame, KeepsNoPositionsUnlessAsked) {
  const auto game = solve_belief_game(one_sided<double>(), one_sided_balls<double>(),
                                      [](std::span<const State>) { return Action{0}; });
  EXPECT_TRUE(game.w.empty());
  EXPECT_GT(game.sweeps, 0);
}

TEST(BeliefGame, GivesUpOnTooManyPositionsOrSweeps) {
  Stream rng(1);
  const auto mdp = random_model(20, 3, 0.95, rng);
  const auto balls = line_balls(20, 3);
  const auto policy = maximin_belief_policy(policy_iteration(mdp).q);
  try {
    solve_belief_game(mdp, balls, policy, {.max_positions = 10});
    FAIL() << "expected BudgetExhausted";
  } catch (const BudgetExhausted& e) {
    EXPECT_STREQ(e.what(),
                 "belief game: more than 10 reachable (state, belief) pairs; allow more or take a smaller model or "
                 "eps");
  }
  try {
    solve_belief_game(mdp, balls, policy, {.max_sweeps = 3});
    FAIL() << "expected BudgetExhausted";
  } catch (const BudgetExhausted& e) {
    EXPECT_STREQ(e.what(), "belief game: not certified after 3 sweeps; allow more");
  }
}

/// As many positions as there are may be allowed, not one fewer.
TEST(BeliefGame, TheBudgetIsMetExactly) {
  const auto mdp = told_apart_by_history();
  const auto policy = maximin_belief_policy(policy_iteration(mdp).q);
  EXPECT_NO_THROW(solve_belief_game(mdp, two_alike(), policy, {.max_positions = 4}));
  EXPECT_THROW(solve_belief_game(mdp, two_alike(), policy, {.max_positions = 3}), BudgetExhausted);
}

}  // namespace
}  // namespace maximin
