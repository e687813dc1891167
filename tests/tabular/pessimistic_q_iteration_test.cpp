#include <maximin/tabular/pessimistic_q_iteration.hpp>

#include <gtest/gtest.h>

#include <maximin/tabular/value_iteration.hpp>

#include "../theory/small_models.hpp"
#include "random_model.hpp"

namespace maximin {
namespace {

using Options = PessimisticQIterationOptions<double>;

/// Non-convergence in integers: two states that look alike, two actions.
FiniteMdp<double> restless() {
  FiniteMdpBuilder<double> b(2, 2, 0.9);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 0, 1).transition(1, 1, 1, 1);
  b.reward(0, 1, 2).reward(1, 0, 3);
  return std::move(b).build();
}

Perturbation<double> alike() {
  return Perturbation<double>::from_neighbourhoods({{0, 1}, {0, 1}});
}

TEST(PessimisticQIteration, CyclesWithPeriodThree) {
  const auto run = pessimistic_q_iteration(restless(), alike());
  EXPECT_EQ(run.fate, Fate::cycles);
  EXPECT_EQ(run.period, 3);
  ASSERT_EQ(run.pair_of.size(), static_cast<std::size_t>(run.iterations));
  for (std::size_t n = static_cast<std::size_t>(run.periodic_from); n + 3 < run.pair_of.size(); ++n) {
    ASSERT_EQ(run.pair_of[n], run.pair_of[n + 3]);
  }
  ASSERT_GT(run.periodic_from, 0);
  const auto before = static_cast<std::size_t>(run.periodic_from) - 1;
  EXPECT_NE(run.pair_of[before], run.pair_of[before + 3]) << "periodic_from is the first such n";
}

TEST(PessimisticQIteration, KeepsTheWholeTrajectoryOnRequest) {
  Options options;
  options.keep_trajectory = true;
  options.max_iterations = 20;
  options.stop_when_periodic = false;
  const auto mdp = restless();
  const auto balls = alike();
  const auto run = pessimistic_q_iteration(mdp, balls, options);
  ASSERT_EQ(run.trajectory.size(), 21u);
  EXPECT_EQ(run.trajectory[0], QTable<double>::Zero(2, 2));
  EXPECT_EQ(run.trajectory[1], mdp.rewards());
  EXPECT_EQ(run.q, run.trajectory.back());
  PessimisticStep<double> step;
  QTable<double> next;
  for (std::size_t n = 0; n < 20; ++n) {
    pessimistic_update(mdp, balls, run.trajectory[n], step, next);
    EXPECT_EQ(next, run.trajectory[n + 1]);
    EXPECT_EQ(run.pairs[static_cast<std::size_t>(run.pair_of[n])], (PolicyPair{step.policy, step.attack}));
  }
  EXPECT_TRUE(pessimistic_q_iteration(mdp, balls).trajectory.empty());
}

TEST(PessimisticQIteration, ShowsEveryRound) {
  Options options;
  options.keep_trajectory = true;
  options.max_iterations = 10;
  std::vector<QTable<double>> seen;
  std::vector<int> pairs;
  const auto run = pessimistic_q_iteration<double>(
      restless(), alike(), options, [&](long n, const QTable<double>& q, int pair, const PolicyPair& policies) {
        EXPECT_EQ(n, static_cast<long>(seen.size()));
        EXPECT_EQ(policies.policy.size(), 2u);
        EXPECT_EQ(policies.attack.size(), 2u);
        seen.push_back(q);
        pairs.push_back(pair);
      });
  EXPECT_EQ(pairs, run.pair_of);
  ASSERT_EQ(seen.size(), 10u);
  for (std::size_t n = 0; n < 10; ++n) EXPECT_EQ(seen[n], run.trajectory[n]);
}

TEST(PessimisticQIteration, SettlesAtQStarWhereNothingIsConfused) {
  Stream rng(1);
  const auto mdp = random_model(20, 3, 0.9, rng);
  const auto run = pessimistic_q_iteration(mdp, line_balls(20, 0));
  const auto optimal = value_iteration(mdp);
  EXPECT_EQ(run.fate, Fate::settled);
  EXPECT_EQ(run.period, 1);
  EXPECT_LE((run.q - optimal.q).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_EQ(run.pairs[static_cast<std::size_t>(run.pair_of.back())].policy, optimal.policy);
}

TEST(PessimisticQIteration, SettlesOnTheOneSidedModel) {
  const auto run = pessimistic_q_iteration(one_sided<double>(), one_sided_balls<double>());
  EXPECT_EQ(run.fate, Fate::settled);
  EXPECT_NEAR(run.q(2, 0), -40, 1e-10);
}

TEST(PessimisticQIteration, IsUndeterminedWhenToldToStopTooSoon) {
  Options options;
  options.max_iterations = 8;
  const auto run = pessimistic_q_iteration(restless(), alike(), options);
  EXPECT_EQ(run.fate, Fate::undetermined);
  EXPECT_EQ(run.iterations, 8);
  options.max_iterations = 5000;
  options.max_period = 2;
  EXPECT_EQ(pessimistic_q_iteration(restless(), alike(), options).fate, Fate::undetermined);
}

TEST(PessimisticQIteration, GoesOnPastTheFirstPeriodIfAsked) {
  Options options;
  options.stop_when_periodic = false;
  options.max_iterations = 2000;
  const auto run = pessimistic_q_iteration(restless(), alike(), options);
  EXPECT_EQ(run.iterations, 2000);
  EXPECT_EQ(run.fate, Fate::cycles);
  EXPECT_EQ(run.period, 3);
}

TEST(PessimisticQIteration, StartsWhereItIsTold) {
  const auto mdp = restless();
  Options options;
  options.keep_trajectory = true;
  options.max_iterations = 3;
  options.initial = QTable<double>::Constant(2, 2, 7);
  const auto run = pessimistic_q_iteration(mdp, alike(), options);
  EXPECT_EQ(run.trajectory[0], *options.initial);
  const QTable<double> expected = mdp.rewards().array() + 0.9 * 7;
  EXPECT_LE((run.trajectory[1] - expected).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(PessimisticQIteration, TiesAreBrokenAsAsked) {
  FiniteMdpBuilder<double> b(2, 3, 0.5);
  for (State s = 0; s < 2; ++s) {
    for (Action a = 0; a < 3; ++a) b.transition(s, a, s, 1);
  }
  const auto mdp = std::move(b).build();
  Options options;
  EXPECT_EQ(pessimistic_q_iteration(mdp, alike(), options).pairs[0], (PolicyPair{{0, 0}, {0, 0}}));
  options.tie = TieBreak::highest_index;
  EXPECT_EQ(pessimistic_q_iteration(mdp, alike(), options).pairs[0], (PolicyPair{{2, 2}, {1, 1}}));
}

TEST(PessimisticQIteration, RefusesWhatDoesNotFit) {
  Options options;
  options.initial = QTable<double>::Zero(2, 3);
  EXPECT_EQ(complaint([&] { pessimistic_q_iteration(restless(), alike(), options); }),
            "Q_0: 2 x 3, expected one row per state and one column per action, 2 x 2");
  EXPECT_EQ(complaint([&] { pessimistic_q_iteration(restless(), line_balls(3, 1)); }),
            "perturbation: of 3 states, expected the model's 2");
}

}  // namespace
}  // namespace maximin
