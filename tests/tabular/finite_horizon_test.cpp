#include <maximin/tabular/finite_horizon.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_control.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// The rules, played out over all histories, with nothing remembered between them: the agent looks up in all that it
/// has been shown and has done which states are possible.
class PlayedOut {
 public:
  PlayedOut(const FiniteMdp<double>& mdp, const Perturbation<double>& balls) : mdp_(mdp), balls_(balls) {}

  double optimal(State s, int left) const {
    if (left == 0) return 0;
    double most = -std::numeric_limits<double>::infinity();
    for (Action a = 0; a < mdp_.actions(); ++a) {
      most = std::max(most, after(s, a, [&](State next) { return optimal(next, left - 1); }));
    }
    return most;
  }

  double stationary(const Policy& policy, State s, int left) const {
    if (left == 0) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (const State t : balls_.ball(s)) {
      const Action a = policy[static_cast<std::size_t>(t)];
      least = std::min(least, after(s, a, [&](State next) { return stationary(policy, next, left - 1); }));
    }
    return least;
  }

  double game(const BeliefPolicy& policy, State s, int left) {
    if (left == 0) return 0;
    double least = std::numeric_limits<double>::infinity();
    for (const State t : balls_.ball(s)) {
      shown_.push_back(t);
      const Action a = policy(possible());
      done_.push_back(a);
      least = std::min(least, after(s, a, [&](State next) { return game(policy, next, left - 1); }));
      done_.pop_back();
      shown_.pop_back();
    }
    return least;
  }

 private:
  template <class Value>
  double after(State s, Action a, Value value) const {
    double sum = mdp_.reward(s, a);
    for (const auto& next : mdp_.successors(s, a)) sum += next.probability * value(next.target);
    return sum;
  }

  bool may_be_now(State s, std::size_t time) const {
    if (!balls_.contains(shown_[time], s)) return false;
    if (time == 0) return true;
    for (State before = 0; before < mdp_.states(); ++before) {
      for (const auto& next : mdp_.successors(before, done_[time - 1])) {
        if (next.target == s && may_be_now(before, time - 1)) return true;
      }
    }
    return false;
  }

  Belief possible() const {
    Belief belief;
    for (State s = 0; s < mdp_.states(); ++s) {
      if (may_be_now(s, shown_.size() - 1)) belief.push_back(s);
    }
    return belief;
  }

  const FiniteMdp<double>& mdp_;
  const Perturbation<double>& balls_;
  std::vector<State> shown_;
  std::vector<Action> done_;
};

BeliefPolicy whimsical_policy(Action actions, std::uint64_t seed) {
  return [actions, seed](std::span<const State> belief) {
    std::uint64_t members = 0;
    for (const State s : belief) members |= std::uint64_t{1} << s;
    return Stream(seed, members).below(actions);
  };
}

constexpr int few = 3;

RC_GTEST_PROP(FiniteHorizon, IsTheRulesPlayedOut, (const Model<double>& model, std::uint64_t seed)) {
  const auto& mdp = model.mdp;
  const auto balls = make_perturbation(model);
  const auto policy = whimsical_policy(mdp.actions(), seed);
  const Policy stationary = stationary_policy_of(balls, policy);
  const auto optimal = optimal_in_steps(mdp, few);
  const auto attacked = attacked_in_steps(mdp, balls, stationary, few);
  PlayedOut rules(mdp, balls);
  for (State s = 0; s < mdp.states(); ++s) {
    for (int k = 0; k <= few; ++k) {
      const auto i = static_cast<std::size_t>(k);
      RC_ASSERT(std::abs(optimal.v[i][s] - rules.optimal(s, k)) <= 2 * optimal.error);
      RC_ASSERT(std::abs(attacked.v[i][s] - rules.stationary(stationary, s, k)) <= 2 * attacked.error);
    }
  }
}

RC_GTEST_PROP(FiniteHorizon, OfTheBeliefGameIsItsRulesPlayedOut, (const Model<double>& model, std::uint64_t seed)) {
  RC_PRE(model.mdp.states() <= 5);
  const auto& mdp = model.mdp;
  const auto balls = make_perturbation(model);
  const auto policy = whimsical_policy(mdp.actions(), seed);
  const auto game = solve_belief_game_in_steps(mdp, balls, policy, few, {.keep_positions = true});
  PlayedOut rules(mdp, balls);
  for (State s = 0; s < mdp.states(); ++s) {
    RC_ASSERT(std::abs(game.v[s] - rules.game(policy, s, few)) <= 2 * game.error);
    double least = std::numeric_limits<double>::infinity();
    for (const State t : balls.ball(s)) {
      const auto ball = balls.ball(t);
      least = std::min(least, game.w.back()[game.numbers.at({s, Belief(ball.begin(), ball.end())})]);
    }
    RC_ASSERT(least == game.v[s]);
  }
  RC_TAG(game.positions > mdp.states() ? "several beliefs per state" : "one");
}

/// What the comparison would find: one step too few, a discount, an agent who sees through the attacker.
TEST(FiniteHorizon, TheComparisonFindsWrongGames) {
  const auto model = gridworld_lattice();
  const auto balls = make_perturbation(model);
  const auto q = policy_iteration(model.mdp).q;
  const auto policy = maximin_belief_policy(q);
  const Policy stationary = stationary_policy_of(balls, policy);
  PlayedOut rules(model.mdp, balls);
  const auto attacked = attacked_in_steps(model.mdp, balls, stationary, few);
  int short_of_a_step = 0, seen_through = 0;
  for (State s = 0; s < model.mdp.states(); ++s) {
    const double right = rules.stationary(stationary, s, few);
    EXPECT_NEAR(attacked.v[few][s], right, 2 * attacked.error);
    short_of_a_step += std::abs(attacked.v[few - 1][s] - right) > 0.5;
    seen_through += optimal_in_steps(model.mdp, few).v[few][s] > right + 0.5;
  }
  EXPECT_GT(short_of_a_step, 200);
  EXPECT_GT(seen_through, 0);
}

/// Both layers' answers for the same thing: no attack on a policy, and one that is sure of its return.
TEST(FiniteHorizon, OfAHundredStepsOnTheLattice) {
  const auto model = gridworld_lattice();
  const auto balls = make_perturbation(model);
  const auto sure = guaranteed_value(model.mdp, balls, {.steps = 100});
  const auto forever = guaranteed_value(model.mdp, balls);
  const auto game = solve_belief_game_in_steps(model.mdp, balls, guaranteed_policy(model.mdp, forever), 100);
  const auto optimal = optimal_in_steps(model.mdp, 100);
  for (State s = 0; s < model.mdp.states(); ++s) {
    EXPECT_LE(sure.v[s], optimal.with_all_steps()[s] + optimal.error + sure.error);
    EXPECT_GE(game.v[s], sure.v[s] - game.error - sure.error) << "state " << s;
  }
}

TEST(FiniteHorizon, RefusesLessThanNoStepsAndTooManyPositions) {
  const auto model = gridworld_lattice();
  const auto balls = make_perturbation(model);
  const auto policy = maximin_belief_policy(policy_iteration(model.mdp).q);
  EXPECT_THROW(optimal_in_steps(model.mdp, -1), InputError);
  EXPECT_THROW(attacked_in_steps(model.mdp, balls, stationary_policy_of(balls, policy), -1), InputError);
  EXPECT_THROW(solve_belief_game_in_steps(model.mdp, balls, policy, -1), InputError);
  EXPECT_THROW(solve_belief_game_in_steps(model.mdp, balls, policy, 5, {.max_positions = 100}), BudgetExhausted);
  EXPECT_TRUE(solve_belief_game_in_steps(model.mdp, balls, policy, 0).v.isZero());
}

}  // namespace
}  // namespace maximin
