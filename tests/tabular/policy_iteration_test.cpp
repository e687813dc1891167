#include <maximin/tabular/policy_iteration.hpp>

#include <gtest/gtest.h>

#include <maximin/tabular/value_iteration.hpp>

#include "random_model.hpp"

namespace maximin {
namespace {

void expect_same(const CertifiedSolution<double>& x, const CertifiedSolution<double>& y) {
  EXPECT_LE((x.v - y.v).cwiseAbs().maxCoeff(), x.error + y.error);
  EXPECT_LE((x.q - y.q).cwiseAbs().maxCoeff(), x.error + y.error);
}

TEST(PolicyIteration, TheDetourThatPaysLater) {
  // Three steps at a cost of 1 lead to a state that pays 10 a step; staying pays 2. gamma = 0.9.
  FiniteMdpBuilder<double> b(4, 2, 0.9);
  for (State s = 0; s < 3; ++s) {
    b.transition(s, 0, s, 1).reward(s, 0, 2);
    b.transition(s, 1, s + 1, 1).reward(s, 1, -1);
  }
  for (Action a = 0; a < 2; ++a) b.transition(3, a, 3, 1).reward(3, a, 10);
  const auto found = policy_iteration(std::move(b).build());
  EXPECT_NEAR(found.v[3], 100, 1e-9);
  EXPECT_NEAR(found.v[2], -1 + 90, 1e-9);
  EXPECT_NEAR(found.v[0], -1 - 0.9 - 0.81 + 0.729 * 100, 1e-9);
  EXPECT_EQ(found.policy, (Policy{1, 1, 1, 0}));
}

TEST(PolicyIteration, AgreesWithTheOthersOnLargerModels) {
  for (const double discount : {0.5, 0.9, 0.99}) {
    Stream rng(3, static_cast<std::uint64_t>(100 * discount));
    const auto mdp = random_model(150, 4, discount, rng);
    const auto howard = policy_iteration(mdp);
    expect_same(howard, value_iteration(mdp));
    for (const long partial : {0L, 1L, 20L, 100L}) expect_same(howard, modified_policy_iteration(mdp, {}, partial));
  }
}

/// Twin actions, equal but for rounding, must not keep improvement going for ever.
TEST(PolicyIteration, EndsAmongTiesHoweverPatientTheAgent) {
  for (const double discount : {0.9, 0.999, 1 - 1e-6}) {
    for (std::uint64_t trial = 0; trial < 20; ++trial) {
      Stream rng(4, trial);
      const State n = 12;
      FiniteMdpBuilder<double> b(n, 4, discount);
      for (State s = 0; s < n; ++s) {
        const double reward = rng.uniform(-1, 1), p = rng.uniform(0.1, 0.9);
        const State one = rng.below(n), other = (one + 1 + rng.below(n - 1)) % n;
        for (Action a = 0; a < 4; ++a) {
          b.reward(s, a, reward).transition(s, a, one, p).transition(s, a, other, 1 - p);
        }
      }
      const auto mdp = std::move(b).build();
      for (const TieBreak tie : {TieBreak::lowest_index, TieBreak::highest_index}) {
        const auto found = policy_iteration(mdp, {.max_sweeps = 1000, .tie = tie});
        EXPECT_LE(found.error, 1e-9 / (1 - discount) / (1 - discount));
      }
    }
  }
}

TEST(PolicyIteration, GivesUpRatherThanReturnUncertifiedValues) {
  Stream rng(5);
  const auto mdp = random_model(30, 3, 0.95, rng);
  EXPECT_THROW(policy_iteration(mdp, {.max_sweeps = 1}), BudgetExhausted);
  EXPECT_THROW(modified_policy_iteration(mdp, {.max_sweeps = 10}, 5), BudgetExhausted);
}

TEST(ModifiedPolicyIteration, WithoutPartialSweepsIsValueIteration) {
  Stream rng(6);
  const auto mdp = random_model(20, 3, 0.9, rng);
  const auto x = modified_policy_iteration(mdp, {}, 0), y = value_iteration(mdp);
  EXPECT_EQ(x.q, y.q);
  EXPECT_EQ(x.sweeps, y.sweeps);
}

TEST(ModifiedPolicyIteration, RefusesANegativeNumberOfSweeps) {
  Stream rng(7);
  EXPECT_THROW(modified_policy_iteration(random_model(2, 2, 0.9, rng), {}, -1), InputError);
}

}  // namespace
}  // namespace maximin
