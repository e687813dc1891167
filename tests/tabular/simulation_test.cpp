#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <tuple>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/simulation.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include "random_model.hpp"

namespace maximin {
namespace {

static_assert(Environment<TabularEnvironment<double>>);
static_assert(TransparentAgent<TabularAgent>);
static_assert(TransparentAgent<BeliefAgent<double, BeliefFilter<double>>>);
static_assert(BeliefModel<BallBelief<double>>);
static_assert(Attack<NoAttack, State, TabularAgent>);
static_assert(Attack<RandomAttack<double>, State, TabularAgent>);
static_assert(Attack<FixedAttack, State, TabularAgent>);
static_assert(Attack<MyopicAttack<double>, State, BeliefAgent<double, BeliefFilter<double>>>);

/// An attack that breaks the rules: shows the next state but three.
struct FarAttack {
  State states;
  State perturb(State truth, const auto&, Stream&) const { return (truth + 3) % states; }
};

/// What a step of an episode was, for comparison of whole runs.
using Trace = std::vector<std::tuple<State, State, Action, double>>;

template <class AgentT, class AttackT>
Trace trace(const FiniteMdp<double>& mdp, AgentT& agent, AttackT& attack, const Perturbation<double>& perturbation) {
  Trace steps;
  TabularEnvironment env(mdp, State{0});
  SimulationOptions options;
  options.horizon = 40;
  for (std::uint64_t trial = 0; trial < 5; ++trial) {
    simulate_episode(env, agent, attack, perturbation, options, trial, [&](const auto& record, const auto&) {
      steps.emplace_back(record.truth, record.shown, record.action, record.reward);
    });
  }
  return steps;
}

TEST(TabularEnvironment, DrawsSuccessorsAndStartsWithTheirProbabilities) {
  FiniteMdpBuilder<double> b(3, 1, 0.5);
  b.transition(0, 0, 0, 0.125).transition(0, 0, 1, 0.5).transition(0, 0, 2, 0.375);
  b.transition(1, 0, 1, 1).transition(2, 0, 2, 1);
  const auto mdp = std::move(b).build();
  const TabularEnvironment env(mdp, std::vector<double>{0.25, 0, 0.75});
  Stream rng(1);
  constexpr int n = 100'000;
  std::map<State, int> starts, nexts;
  for (int k = 0; k < n; ++k) {
    ++starts[env.reset(rng)];
    ++nexts[env.step(0, 0, rng).next];
  }
  // Four standard errors of the largest are 0.0063.
  EXPECT_NEAR(starts[0] / double(n), 0.25, 0.0063);
  EXPECT_EQ(starts[1], 0);
  EXPECT_NEAR(nexts[0] / double(n), 0.125, 0.0063);
  EXPECT_NEAR(nexts[1] / double(n), 0.5, 0.0063);
  EXPECT_NEAR(nexts[2] / double(n), 0.375, 0.0063);
}

TEST(TabularEnvironment, EndsWhereNothingFollows) {
  FiniteMdpBuilder<double> b(3, 1, 0.5);
  b.transition(0, 0, 1, 1).transition(1, 0, 1, 1).transition(2, 0, 2, 1).reward(2, 0, 1);
  const auto mdp = std::move(b).build();
  const TabularEnvironment<double> env(mdp);
  EXPECT_FALSE(env.terminal(0)) << "it is left";
  EXPECT_TRUE(env.terminal(1));
  EXPECT_FALSE(env.terminal(2)) << "it pays for ever";
}

TEST(TabularEnvironment, RefusesABadStart) {
  Stream rng(2);
  const auto mdp = random_model(3, 2, 0.5, rng);
  EXPECT_THROW(TabularEnvironment(mdp, State{3}), InputError);
  EXPECT_THROW(TabularEnvironment(mdp, std::vector<double>{0.5, 0.5}), InputError);
  EXPECT_THROW(TabularEnvironment(mdp, std::vector<double>{0.5, 0.5, 0.5}), InputError);
  EXPECT_THROW(TabularEnvironment(mdp, std::vector<double>{1.5, -0.5, 0}), InputError);
}

TEST(Simulation, HorizonLeavesNoMoreThanTheTolerance) {
  FiniteMdpBuilder<double> b(1, 1, 0.5);
  b.transition(0, 0, 0, 1).reward(0, 0, 1);
  const auto mdp = std::move(b).build();
  EXPECT_EQ(truncation_horizon(mdp, 0.25), 3);  // 2 * 0.5^3
  EXPECT_EQ(truncation_horizon(mdp, 100), 1);
  EXPECT_THROW(truncation_horizon(mdp, 0), InputError);
}

/// On 40 models: the simulated mean of the maximin agent under the optimal attack against the exact value.
TEST(Simulation, MeanReturnAgreesWithTheExactValue) {
  int inside = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    Stream rng(3, trial);
    const auto mdp = random_model(rng.integer(2, 12), rng.integer(2, 4), rng.uniform(0.3, 0.9), rng);
    const auto perturbation = line_balls(mdp.states(), 1);
    Policy policy;
    std::vector<double> scratch;
    maximin_policy(value_iteration(mdp).q, perturbation, policy, scratch);
    const auto exact = evaluate_against_optimal_attack(mdp, perturbation, policy);
    TabularAgent agent(policy);
    FixedAttack attack(exact.attack);
    TabularEnvironment env(mdp, State{0});
    const auto found = simulate(env, agent, attack, perturbation, {.episodes = 400, .seed = trial});
    const double deviation = std::abs(found.mean - exact.v[0]);
    EXPECT_LE(deviation, 2 * found.half_width + 1e-7) << "trial " << trial;  // 3.9 standard errors
    inside += deviation <= found.half_width + 1e-7;
  }
  EXPECT_GE(inside, 34) << "of 40, for a 95 percent interval";
}

TEST(Simulation, DistinguishesAttackedFromUnattackedValues) {
  // Negative control of the test above: the value without attack is refuted where the attack matters.
  int refuted = 0, matters = 0;
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Stream rng(4, trial);
    const auto mdp = random_model(8, 3, 0.8, rng);
    const auto perturbation = line_balls(8, 2);
    const auto best = value_iteration(mdp);
    const auto exact = evaluate_against_optimal_attack(mdp, perturbation, best.policy);
    TabularAgent agent(best.policy);
    FixedAttack attack(exact.attack);
    TabularEnvironment env(mdp, State{0});
    const auto found = simulate(env, agent, attack, perturbation, {.episodes = 400, .seed = trial});
    if (best.v[0] - exact.v[0] < 0.5) continue;
    ++matters;
    refuted += std::abs(found.mean - best.v[0]) > 2 * found.half_width;
  }
  EXPECT_GE(matters, 15);
  EXPECT_EQ(refuted, matters);
}

TEST(Simulation, RandomAttackHasTheValueOfTheMixedPolicy) {
  // The ball of every state is everything: a random attack makes the agent choose at random.
  Stream rng(5);
  const auto mdp = random_model(3, 2, 0.7, rng);
  const auto perturbation = line_balls(3, 2);
  FiniteMdpBuilder<double> mixed(3, 1, 0.7);
  const Policy policy{0, 1, 1};
  for (State s = 0; s < 3; ++s) {
    std::map<State, double> row;
    double reward = 0;
    for (const Action a : policy) {
      reward += mdp.reward(s, a) / 3;
      for (const auto& next : mdp.successors(s, a)) row[next.target] += next.probability / 3;
    }
    mixed.reward(s, 0, reward);
    for (const auto& [target, p] : row) mixed.transition(s, 0, target, p);
  }
  const auto exact = value_iteration(std::move(mixed).build());
  TabularAgent agent(policy);
  RandomAttack attack(perturbation);
  TabularEnvironment env(mdp, State{1});
  const auto found = simulate(env, agent, attack, perturbation, {.episodes = 4000, .seed = 9});
  EXPECT_NEAR(found.mean, exact.v[1], 2 * found.half_width);
  EXPECT_LT(found.half_width, 0.05);
}

TEST(Simulation, AnAgentWithoutMemoryIsItsMaximinPolicy) {
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    Stream rng(6, trial);
    const auto mdp = random_model(7, 3, 0.9, rng);
    const auto perturbation = line_balls(7, 1);
    const auto q = value_iteration(mdp).q;
    Policy policy;
    AttackPolicy response;
    std::vector<double> scratch;
    maximin_policy(q, perturbation, policy, scratch);
    best_response_attack(q, policy, perturbation, response);
    TabularAgent table(policy);
    BeliefAgent memoryless(q, BallBelief(perturbation));
    FixedAttack fixed(response);
    MyopicAttack myopic(q, perturbation);
    EXPECT_EQ(trace(mdp, table, fixed, perturbation), trace(mdp, memoryless, myopic, perturbation));
  }
}

TEST(Simulation, MyopicAttackForeseesWhatABeliefAgentDoes) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Stream rng(7, trial);
    const auto mdp = random_model(8, 3, 0.9, rng);
    const auto perturbation = line_balls(8, 2);
    const auto q = value_iteration(mdp).q;
    BeliefAgent agent(q, BeliefFilter(mdp, perturbation));
    MyopicAttack attack(q, perturbation);
    TabularEnvironment<double> env(mdp);
    for (std::uint64_t episode = 0; episode < 5; ++episode) {
      BeliefFilter mirror(mdp, perturbation);
      Belief predicted;
      Action last = 0;
      simulate_episode(env, agent, attack, perturbation, {.horizon = 30}, episode, [&](const auto& r, const auto& a) {
        // Worst over what could have been shown, given what the agent remembered.
        double worst = 1e300;
        for (const State t : perturbation.ball(r.truth)) {
          BeliefFilter probe = mirror;
          const Belief& m = r.time == 0 ? probe.reset(t) : probe.update(last, t);
          std::vector<double> scratch;
          worst = std::min(worst, q(r.truth, belief_action(q, std::span<const State>(m), scratch)));
        }
        EXPECT_EQ(q(r.truth, r.action), worst);
        const Belief& held = r.time == 0 ? mirror.reset(r.shown) : mirror.update(last, r.shown);
        EXPECT_EQ(a.belief_model().belief(), held);
        EXPECT_TRUE(std::binary_search(held.begin(), held.end(), r.truth));
        last = r.action;
      });
      EXPECT_EQ(agent.belief_model().empty_intersections(), 0);
    }
  }
}

TEST(Simulation, NoAttackPushesABeliefAgentBelowItsGameValue) {
  for (std::uint64_t trial = 0; trial < 10; ++trial) {
    Stream rng(8, trial);
    const auto mdp = random_model(6, 3, 0.8, rng);
    const auto perturbation = line_balls(6, 1);
    const auto q = value_iteration(mdp).q;
    const auto game = solve_belief_game(mdp, perturbation, maximin_belief_policy(q));
    TabularEnvironment env(mdp, State{2});
    BeliefAgent agent(q, BeliefFilter(mdp, perturbation));
    MyopicAttack myopic(q, perturbation);
    RandomAttack random(perturbation);
    const SimulationOptions options{.episodes = 400, .seed = trial};
    for (const auto& found :
         {simulate(env, agent, myopic, perturbation, options), simulate(env, agent, random, perturbation, options)}) {
      EXPECT_GE(found.mean + 2 * found.half_width + 1e-7, game.v[2] - game.error);
    }
  }
}

TEST(Simulation, AnAttackOutsideTheBallIsAnErrorNotANumber) {
  Stream rng(9);
  const auto mdp = random_model(8, 3, 0.9, rng);
  const auto perturbation = line_balls(8, 1);
  const auto q = value_iteration(mdp).q;
  TabularEnvironment<double> env(mdp);
  BeliefAgent agent(q, BeliefFilter(mdp, perturbation));
  FarAttack far{8};
  EXPECT_THROW(simulate(env, agent, far, perturbation, {.episodes = 1}), std::logic_error);
  FixedAttack wrong(AttackPolicy{1, 0, 1, 2, 3, 4, 5, 0});
  EXPECT_THROW(simulate(env, agent, wrong, perturbation, {.episodes = 20}), std::logic_error);
  FixedAttack too_short(AttackPolicy{0, 1});
  EXPECT_THROW(simulate(env, agent, too_short, perturbation, {.episodes = 20}), std::logic_error);
  TabularAgent ignorant(Policy{0});
  NoAttack none;
  EXPECT_THROW(simulate(env, ignorant, none, perturbation, {.episodes = 20}), std::logic_error);
  // Unchecked, the same attack contradicts the agent's history, and the agent counts it.
  evaluate(env, agent, far, 0.9, 50, 5, 1);
  EXPECT_GT(agent.belief_model().empty_intersections(), 0);
}

TEST(Simulation, TheSameSeedGivesTheSameRun) {
  Stream rng(10);
  const auto mdp = random_model(8, 3, 0.9, rng);
  const auto perturbation = line_balls(8, 1);
  TabularEnvironment<double> env(mdp);
  BeliefAgent agent(value_iteration(mdp).q, BeliefFilter(mdp, perturbation));
  RandomAttack attack(perturbation);
  const auto first = simulate(env, agent, attack, perturbation, {.episodes = 50, .seed = 4});
  const auto second = simulate(env, agent, attack, perturbation, {.episodes = 50, .seed = 4});
  const auto other = simulate(env, agent, attack, perturbation, {.episodes = 50, .seed = 5});
  EXPECT_EQ(first.mean, second.mean);
  EXPECT_NE(first.mean, other.mean);
}

}  // namespace
}  // namespace maximin
