#include <maximin/tabular/belief_control.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// A truth that is still possible, and what it has been paid.
struct Truth {
  State at;
  double paid;
};

/// The most that an agent can be sure of in so many steps by the definition: over all trees of actions, the least
/// total over all truths, runs and observations. Truths keep their own account, so nothing is assumed of rewards.
class BruteForce {
 public:
  BruteForce(const FiniteMdp<double>& mdp, const Perturbation<double>& balls) : mdp_(mdp), balls_(balls), env_(mdp) {}

  double shown(State t, int steps) const {
    std::vector<Truth> truths;
    for (const State s : balls_.ball(t)) {
      if (!env_.terminal(s)) truths.push_back({s, 0});
    }
    return truths.empty() ? 0 : best(truths, steps);
  }

 private:
  double best(const std::vector<Truth>& truths, int steps) const {
    double most = -std::numeric_limits<double>::infinity();
    if (steps == 0) {
      for (const Truth& t : truths) most = std::max(most, -t.paid);
      return -most;
    }
    for (Action a = 0; a < mdp_.actions(); ++a) {
      double least = std::numeric_limits<double>::infinity();
      std::vector<Truth> next;
      for (const Truth& t : truths) {
        const double paid = t.paid + mdp_.reward(t.at, a);
        for (const auto& s : mdp_.successors(t.at, a)) {
          if (env_.terminal(s.target)) {
            least = std::min(least, paid);
          } else {
            next.push_back({s.target, paid});
          }
        }
      }
      for (State o = 0; o < mdp_.states(); ++o) {
        std::vector<Truth> met;
        for (const Truth& t : next) {
          if (balls_.contains(t.at, o)) met.push_back(t);
        }
        if (!met.empty()) least = std::min(least, best(met, steps - 1));
      }
      most = std::max(most, least);
    }
    return most;
  }

  const FiniteMdp<double>& mdp_;
  const Perturbation<double>& balls_;
  TabularEnvironment<double> env_;
};

/// Six states on a line, deterministic or with two successors, some of them ends. A step costs 1 but for the pay of
/// what ends the episode, if `state_rewards` is not set.
FiniteMdp<double> little(bool state_rewards, bool random, Stream& rng) {
  FiniteMdpBuilder<double> b(6, 2, 0.75);
  for (State s = 0; s < 6; ++s) {
    const bool end = s == 0 || s == 5;
    for (Action a = 0; a < 2; ++a) {
      if (end) {
        b.transition(s, a, s, 1);
        continue;
      }
      const State to = rng.below(6), other = (to + 1 + rng.below(5)) % 6;
      if (random && rng.chance(0.4)) {
        b.transition(s, a, to, 0.5).transition(s, a, other, 0.5);
      } else {
        b.transition(s, a, to, 1);
      }
      b.reward(s, a, state_rewards ? rng.integer(-3, 3) : to == 5 ? 8 : -1);
    }
  }
  return std::move(b).build();
}

Perturbation<double> on_a_line(State states, double eps) {
  Metric<double>::Points points(states, 1);
  for (State s = 0; s < states; ++s) points(s, 0) = s;
  return Perturbation<double>(Metric<double>::from_points(points, Norm::l1), eps);
}

RC_GTEST_PROP(GuaranteedValue, IsTheBestTreeOfActionsAgainstEveryTruth, (std::uint64_t seed)) {
  Stream rng(seed);
  const auto mdp = little(false, false, rng);
  const auto balls = on_a_line(6, rng.integer(0, 2));
  const int steps = rng.integer(1, 4);
  const auto sure = guaranteed_value(mdp, balls, {.steps = steps});
  const BruteForce brute(mdp, balls);
  for (State t = 0; t < 6; ++t) RC_ASSERT(std::abs(sure.shown[t] - brute.shown(t, steps)) <= sure.error);
}

/// Where rewards tell of the truth, or the model is random, it never promises too much.
RC_GTEST_PROP(GuaranteedValue, NeverPromisesTooMuch, (std::uint64_t seed)) {
  Stream rng(seed);
  const auto mdp = little(rng.chance(0.7), rng.chance(0.7), rng);
  const auto balls = on_a_line(6, rng.integer(0, 2));
  const int steps = rng.integer(1, 3);
  const auto sure = guaranteed_value(mdp, balls, {.steps = steps});
  const BruteForce brute(mdp, balls);
  for (State t = 0; t < 6; ++t) RC_ASSERT(sure.shown[t] <= brute.shown(t, steps) + sure.error);
}

TEST(GuaranteedValue, TheComparisonFindsWrongValues) {
  Stream rng(1);
  int wrong_steps = 0, wrong_ball = 0;
  for (int k = 0; k < 100; ++k) {
    const auto mdp = little(false, false, rng);
    const auto balls = on_a_line(6, 1), none = on_a_line(6, 0);
    const BruteForce brute(mdp, balls);
    const auto shorter = guaranteed_value(mdp, balls, {.steps = 2});
    const auto seeing = guaranteed_value(mdp, none, {.steps = 3});
    for (State t = 0; t < 6; ++t) {
      wrong_steps += std::abs(shorter.shown[t] - brute.shown(t, 3)) > 1e-6;
      wrong_ball += seeing.shown[t] > brute.shown(t, 3) + 1e-6;
    }
  }
  EXPECT_GT(wrong_steps, 100);
  EXPECT_GT(wrong_ball, 30);
}

/// The guaranteed policy, played by the rules of the belief game, keeps its promise; and no policy of a table has the
/// optimal attacker promise more from the worst truth than is possible.
RC_GTEST_PROP(GuaranteedValue, IsKeptByItsPolicyAndBelowTheOptimum, (const Model<double>& model)) {
  const auto balls = make_perturbation(model);
  const auto sure = guaranteed_value(model.mdp, balls);
  const auto best = policy_iteration(model.mdp);
  const auto game = solve_belief_game(model.mdp, balls, guaranteed_policy(model.mdp, sure));
  for (State s = 0; s < model.mdp.states(); ++s) {
    RC_ASSERT(sure.v[s] <= game.v[s] + sure.error + game.error);
    RC_ASSERT(sure.v[s] <= best.v[s] + sure.error + best.error);
    if (TabularEnvironment<double>(model.mdp).terminal(s)) continue;
    for (const State t : balls.ball(s)) RC_ASSERT(sure.v[s] <= sure.shown[t]);
  }
}

TEST(GuaranteedValue, OfThatIsSeenAsItIsIsTheOptimum) {
  auto model = gridworld_lattice({.eps = 0});
  const auto sure = guaranteed_value(model.mdp, make_perturbation(model));
  const auto best = policy_iteration(model.mdp);
  EXPECT_LE((sure.v - best.v).cwiseAbs().maxCoeff(), sure.error + best.error);
  EXPECT_EQ(sure.beliefs, 264);
}

/// On the paper's world with balls of 0.5: from every start, whoever attacks, the gold in at most 26 moves.
TEST(GuaranteedValue, ReachesTheGoldOfTheLattice) {
  const auto model = gridworld_lattice();
  const auto balls = make_perturbation(model);
  const auto sure = guaranteed_value(model.mdp, balls, {.steps = 100});
  double mean = 0, least = 200;
  for (State s = 0; s < model.mdp.states(); ++s) {
    const double start = model.start[static_cast<std::size_t>(s)];
    mean += start * sure.v[s];
    if (start > 0) least = std::min(least, sure.v[s]);
  }
  EXPECT_NEAR(mean, 185.436, 1e-3);
  EXPECT_NEAR(least, 175, 1e-6);
  const auto maximin = solve_belief_game(model.mdp, balls, maximin_belief_policy(policy_iteration(model.mdp).q));
  EXPECT_LT(maximin.v.minCoeff(), -99) << "the maximin policy of the clean Q* deadlocks";
}

TEST(GuaranteedValue, SaysWhenItIsTooMuch) {
  const auto model = gridworld_lattice();
  const auto balls = make_perturbation(model);
  EXPECT_THROW(guaranteed_value(model.mdp, balls, {.max_beliefs = 1000}), BudgetExhausted);
  EXPECT_THROW(guaranteed_value(model.mdp, balls, {.max_sweeps = 3}), BudgetExhausted);
  EXPECT_THROW(guaranteed_value(model.mdp, on_a_line(3, 1)), InputError);
  EXPECT_THROW(guaranteed_value(model.mdp, balls, {.steps = -1}), InputError);
}

}  // namespace
}  // namespace maximin
