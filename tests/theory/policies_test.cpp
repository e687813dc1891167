#include <maximin/theory/policies.hpp>

#include <gtest/gtest.h>

#include <vector>

#include <maximin/theory/random.hpp>

#include "small_models.hpp"

namespace maximin {
namespace {

constexpr TieBreak both_ties[] = {TieBreak::lowest_index, TieBreak::highest_index};

/// Three states on a line, neighbours confused.
Perturbation<double> line_of_three() {
  return on_line<double>({0, 1, 2}, 1);
}

QTable<double> table() {
  QTable<double> q(3, 2);
  q << 4, 2,  //
      3, 2,   //
      -1, 2;
  return q;
}

Policy maximin(const QTable<double>& q, const Perturbation<double>& balls, TieBreak tie = TieBreak::lowest_index) {
  Policy policy;
  std::vector<double> scratch;
  maximin_policy(q, balls, policy, scratch, MinAggregator{}, tie);
  return policy;
}

TEST(Policies, GreedyMaximinAndOptimistByHand) {
  const auto balls = line_of_three();
  Policy greedy, optimist, average;
  std::vector<double> scratch;
  greedy_policy(table(), greedy);
  EXPECT_EQ(greedy, (Policy{0, 0, 1}));
  // Worst cases: at 0 over {0,1} min(4,3) against 2; at 1 and 2 the -1 of state 2 counts.
  EXPECT_EQ(maximin(table(), balls), (Policy{0, 1, 1}));
  maximin_policy(table(), balls, optimist, scratch, MaxAggregator{});
  EXPECT_EQ(optimist, (Policy{0, 0, 0}));
  maximin_policy(table(), balls, average, scratch, MeanAggregator{});
  EXPECT_EQ(average, (Policy{0, 0, 1})) << "7/2, 6/3 and 2/2 against 2: the tie goes to action 0";
}

TEST(Policies, TiesGoToTheEndThatWasAskedFor) {
  const QTable<double> equal = QTable<double>::Zero(3, 4);
  const auto balls = line_of_three();
  Policy policy;
  AttackPolicy attack;
  greedy_policy(equal, policy);
  EXPECT_EQ(policy, (Policy{0, 0, 0}));
  greedy_policy(equal, policy, TieBreak::highest_index);
  EXPECT_EQ(policy, (Policy{3, 3, 3}));
  EXPECT_EQ(maximin(equal, balls), (Policy{0, 0, 0}));
  EXPECT_EQ(maximin(equal, balls, TieBreak::highest_index), (Policy{3, 3, 3}));
  best_response_attack(equal, policy, balls, attack);
  EXPECT_EQ(attack, (AttackPolicy{0, 0, 1}));
  best_response_attack(equal, policy, balls, attack, TieBreak::highest_index);
  EXPECT_EQ(attack, (AttackPolicy{1, 2, 2}));
}

TEST(Policies, ATieAmongSomeGoesToTheEndOfThese) {
  QTable<double> q(1, 5);
  q << 1, 7, 3, 7, 0;
  Policy policy;
  greedy_policy(q, policy);
  EXPECT_EQ(policy[0], 1);
  greedy_policy(q, policy, TieBreak::highest_index);
  EXPECT_EQ(policy[0], 3);
}

TEST(Policies, BestResponseByHand) {
  // pi = 0 1 0: true state 0 may be shown as 0 or 1, 1 as anything, 2 as 1 or 2.
  const Policy policy{0, 1, 0};
  AttackPolicy attack;
  best_response_attack(table(), policy, line_of_three(), attack);
  EXPECT_EQ(attack, (AttackPolicy{1, 1, 2}));
  Policy composed;
  compose(policy, attack, composed);
  EXPECT_EQ(composed, (Policy{1, 1, 0}));
}

TEST(Policies, NoAttackChangesNothing) {
  const Policy policy{2, 0, 1};
  Policy composed;
  compose(policy, no_attack(3), composed);
  EXPECT_EQ(composed, policy);
}

/// The definitions, by exhaustion: no action has a larger minimum over the ball, no disguise a smaller value.
TEST(Policies, AreTheArgmaxAndArgminOfTheirDefinitions) {
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    Stream rng(3, trial);
    const State n = rng.integer(1, 7);
    const Action actions = rng.integer(1, 4);
    std::vector<double> x;
    for (State s = 0; s < n; ++s) x.push_back(rng.integer(0, 6));
    const auto balls = on_line(x, static_cast<double>(rng.integer(0, 3)));
    QTable<double> q(n, actions);
    for (State s = 0; s < n; ++s) {
      for (Action a = 0; a < actions; ++a) q(s, a) = rng.integer(-2, 2);
    }
    const auto worst = [&](State t, Action a) {
      double least = q(t, a);
      for (State m = 0; m < n; ++m) {
        if (balls.metric().distance(t, m) <= balls.eps()) least = std::min(least, q(m, a));
      }
      return least;
    };
    for (const TieBreak tie : both_ties) {
      const Policy policy = maximin(q, balls, tie);
      AttackPolicy attack;
      best_response_attack(q, policy, balls, attack, tie);
      const auto act = [&](State t) { return policy[static_cast<std::size_t>(t)]; };
      for (State s = 0; s < n; ++s) {
        for (Action a = 0; a < actions; ++a) {
          EXPECT_LE(worst(s, a), worst(s, act(s)));
          const bool wins_ties = tie == TieBreak::lowest_index ? a < act(s) : a > act(s);
          EXPECT_TRUE(!wins_ties || worst(s, a) < worst(s, act(s)));
        }
        const State shown = attack[static_cast<std::size_t>(s)];
        EXPECT_TRUE(balls.contains(s, shown));
        for (const State t : balls.ball(s)) {
          EXPECT_GE(q(s, act(t)), q(s, act(shown)));
          const bool wins_ties = tie == TieBreak::lowest_index ? t < shown : t > shown;
          EXPECT_TRUE(!wins_ties || q(s, act(t)) > q(s, act(shown)));
        }
      }
    }
  }
}

TEST(Policies, BeliefActionTakesAnyBelief) {
  std::vector<double> scratch;
  const auto act = [&](std::vector<State> belief) {
    return belief_action(table(), std::span<const State>(belief), scratch);
  };
  EXPECT_EQ(act({0}), 0);
  EXPECT_EQ(act({2}), 1);
  EXPECT_EQ(act({0, 1}), 0);
  EXPECT_EQ(act({0, 2}), 1);
  EXPECT_EQ(act({0, 1, 2}), 1);
}

}  // namespace
}  // namespace maximin
