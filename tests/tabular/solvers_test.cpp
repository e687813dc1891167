#include <gtest/gtest.h>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

FiniteMdp<double> one_sided() {
  FiniteMdpBuilder<double> b(3, 2, 0.5);
  const double x[] = {0, 1, 20};
  for (State s = 0; s < 3; ++s) {
    for (Action a = 0; a < 2; ++a) b.reward(s, a, -x[s]);
  }
  b.transition(0, 0, 0, 1).transition(0, 1, 2, 1).transition(1, 1, 1, 1).transition(1, 0, 2, 1);
  b.transition(2, 0, 2, 1).transition(2, 1, 2, 1);
  return std::move(b).build();
}

Perturbation<double> line() {
  Metric<double>::Points points(3, 1);
  points << 0, 1, 20;
  return Perturbation<double>(Metric<double>::from_points(points, Norm::l1), 1.0);
}

TEST(OneSided, GapIsTenAndPrintedBoundSix) {
  const auto mdp = one_sided();
  const auto pert = line();
  const auto optimal = policy_iteration(mdp);
  const auto vi = value_iteration(mdp);
  const auto mpi = modified_policy_iteration(mdp);
  EXPECT_NEAR((optimal.q - vi.q).cwiseAbs().maxCoeff(), 0, optimal.error + vi.error);
  EXPECT_NEAR((optimal.q - mpi.q).cwiseAbs().maxCoeff(), 0, optimal.error + mpi.error);
  const auto run = pessimistic_q_iteration(mdp, pert);
  ASSERT_EQ(run.fate, Fate::settled);
  const auto& pair = run.pairs[static_cast<std::size_t>(run.pair_of.back())];
  Policy composed;
  compose(pair.policy, pair.attack, composed);
  const auto attacked = evaluate_policy(mdp, composed);
  EXPECT_NEAR((optimal.q - attacked.q).maxCoeff(), 10.0, 1e-9);
  const auto robust = evaluate_against_optimal_attack(mdp, pert, pair.policy);
  EXPECT_GE((optimal.q - robust.q).maxCoeff(), 10.0 - 1e-9);
  const auto game = solve_belief_game(mdp, pert, maximin_belief_policy(optimal.q));
  EXPECT_GT(game.positions, 3);
  printf("errors %g %g %g  sweeps %ld %ld %ld game %ld positions reach %g\n", optimal.error, vi.error, mpi.error, optimal.sweeps, vi.sweeps, mpi.sweeps, game.positions, game.reach);
}

TEST(Cycle, PeriodThree) {
  FiniteMdpBuilder<double> b(2, 2, 0.9);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 0, 1).transition(1, 1, 1, 1);
  b.reward(0, 1, 2).reward(1, 0, 3);
  const auto mdp = std::move(b).build();
  const auto pert = Perturbation<double>::from_neighbourhoods({{0, 1}, {0, 1}});
  const auto run = pessimistic_q_iteration(mdp, pert);
  EXPECT_EQ(run.fate, Fate::cycles);
  EXPECT_EQ(run.period, 3);
}

}  // namespace
}  // namespace maximin
