#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include <maximin/tabular/belief_game_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/simulation.hpp>

namespace maximin {
namespace {

/// What the steps after the horizon may add: 1e-9 of max|R|/(1-gamma) = 10, and rounding.
constexpr double truncation = 1.1e-8;

using BeliefAgentOfQ = BeliefAgent<double, BeliefFilter<double>>;

/// A ring of six states: action 0 stays, action 1 goes on, slipping sometimes; state 3 pays.
FiniteMdp<double> ring() {
  FiniteMdpBuilder<double> b(6, 2, 0.8);
  for (State s = 0; s < 6; ++s) {
    b.transition(s, 0, s, 1).transition(s, 1, (s + 1) % 6, 0.75).transition(s, 1, s, 0.25);
  }
  b.reward(3, 0, 1).reward(3, 1, -2).reward(0, 1, 0.5);
  return std::move(b).build();
}

Perturbation<double> neighbours() {
  return Perturbation<double>::from_neighbourhoods({{0, 1, 5}, {0, 1, 2}, {1, 2, 3}, {2, 3, 4}, {3, 4, 5}, {4, 5, 0}});
}

class BeliefGameAttackTest : public ::testing::Test {
 protected:
  const FiniteMdp<double> mdp = ring();
  const Perturbation<double> perturbation = neighbours();
  const QTable<double> q = policy_iteration(mdp).q;
  const BeliefGameValue<double> game =
      solve_belief_game(mdp, perturbation, maximin_belief_policy(q), {.keep_positions = true});

  template <class AttackT>
  Evaluation play(AttackT attack, State start) const {
    TabularEnvironment<double> env(mdp, start);
    BeliefAgentOfQ agent(q, BeliefFilter<double>(mdp, perturbation));
    SimulationOptions options;
    options.episodes = 4000;
    return simulate(env, agent, attack, perturbation, options);
  }
};

TEST_F(BeliefGameAttackTest, BringsAboutTheValueOfTheGame) {
  ASSERT_EQ(game.w.size(), static_cast<std::size_t>(game.positions));
  for (State s = 0; s < mdp.states(); ++s) {
    const Evaluation e = play(BeliefGameAttack<double>(game, perturbation), s);
    // Twice the 95 percent interval: six states, one run in some 2,000 would miss by chance, and the seed is fixed.
    EXPECT_NEAR(e.mean, game.v[s], 2 * e.half_width + truncation) << "state " << s;
  }
}

TEST_F(BeliefGameAttackTest, NoOtherAttackDoesWorseToTheAgent) {
  bool myopic_is_weaker = false;
  for (State s = 0; s < mdp.states(); ++s) {
    const Evaluation myopic = play(MyopicAttack<double>(q, perturbation), s);
    EXPECT_GE(myopic.mean, game.v[s] - 2 * myopic.half_width - truncation) << "state " << s;
    EXPECT_GE(play(NoAttack{}, s).mean, game.v[s] - 2 * myopic.half_width - truncation) << "state " << s;
    myopic_is_weaker |= myopic.mean > game.v[s] + 2 * myopic.half_width + truncation;
  }
  EXPECT_TRUE(myopic_is_weaker) << "the model was chosen so that misleading the belief pays";
}

TEST_F(BeliefGameAttackTest, NeedsThePositions) {
  const auto bare = solve_belief_game(mdp, perturbation, maximin_belief_policy(q));
  EXPECT_TRUE(bare.w.empty());
  EXPECT_THROW(BeliefGameAttack<double>(bare, perturbation), std::invalid_argument);
}

}  // namespace
}  // namespace maximin
