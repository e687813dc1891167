#include <algorithm>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/attacks/place_attacks.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/place_beliefs.hpp>
#include <maximin/deep/table_values.hpp>
#include <maximin/tabular/tabular_agents.hpp>
#include <maximin/tabular/tabular_attacks.hpp>
#include <maximin/theory/rollout.hpp>
#include "lipschitz_places.hpp"

namespace maximin::deep {
namespace {

/// What happened, step by step and episode by episode.
struct Play {
  std::vector<std::vector<std::tuple<State, State, Action, double>>> steps;  // truth, shown, action, reward
  std::vector<double> returns;

  friend bool operator==(const Play&, const Play&) = default;
};

constexpr long episodes = 12, horizon = 40;
constexpr std::uint64_t seed = 3;

/// The exact layer's simulation, one episode after another.
template <class AgentT, class AttackT>
Play tabular_play(const LipschitzPlaces& m, AgentT agent, AttackT attack) {
  Play play;
  for (long k = 0; k < episodes; ++k) {
    Stream rng(seed, static_cast<std::uint64_t>(k));
    auto& steps = play.steps.emplace_back();
    const auto note = [&](const auto& r, const auto&) { steps.emplace_back(r.truth, r.shown, r.action, r.reward); };
    const double discount = m.model.mdp.discount();
    play.returns.push_back(rollout(m.environment, agent, attack, discount, horizon, rng, note).discounted_return);
  }
  return play;
}

/// The deep layer's, several lanes at a time.
Play deep_play(const LipschitzPlaces& m, BeliefAgent& agent, GridAttack& attack) {
  const PlacesWorld world(m.environment, m.places);
  const EpisodesInStep options{m.model.mdp.discount(), horizon, episodes, seed, 5};
  Play play;
  play.steps.resize(episodes);
  const auto note = [&](long k, const auto& r) {
    play.steps[static_cast<std::size_t>(k)].emplace_back(m.places.state_at(r.truth), m.places.state_at(r.shown),
                                                         r.action, r.reward);
  };
  for (const Episode& e : rollout_in_step(world, agent, attack, options, note)) {
    play.returns.push_back(e.discounted_return);
  }
  return play;
}

BeliefAgent deep_agent(const LipschitzPlaces& m, const QTable<double>& q, SetBelief kind) {
  return BeliefAgent(std::make_shared<TableValues>(q, m.places),
                     std::make_shared<PlaceBeliefs>(kind, m.model.mdp, m.balls, m.places), MinAggregator{});
}

/// A table with every value twice: ties that the first action must win.
QTable<double> with_twins(const QTable<double>& q) {
  QTable<double> twins = q;
  twins.col(1) = twins.col(0);
  twins.col(3) = twins.col(2);
  return twins;
}

/// Plays the same agent with the same table in both layers, against omega and against best responses.
template <BeliefModel B>
void expect_same_play(const LipschitzPlaces& m, const QTable<double>& q, SetBelief kind, const B& belief) {
  const maximin::BeliefAgent<double, B> exact(q, belief);
  BeliefAgent deep = deep_agent(m, q, kind);
  const AttackPolicy omega = evaluate_against_optimal_attack(m.model.mdp, m.balls, m.policy).attack;
  FixedPlaceAttack fixed(omega, m.balls, m.places);
  const Play against_fixed = deep_play(m, deep, fixed);
  EXPECT_EQ(against_fixed, tabular_play(m, exact, FixedAttack(omega)));
  PlaceBestResponse response(std::make_shared<TableValues>(q, m.places), m.balls, m.places);
  EXPECT_EQ(deep_play(m, deep, response), tabular_play(m, exact, MyopicAttack<double>(q, m.balls)));
  EXPECT_EQ(deep.belief().empty_intersections(), 0);

  // Controls: the comparison sees a table that is off by one row, and a belief of the other kind where that matters.
  QTable<double> shifted = q;
  shifted.topRows(q.rows() - 1) = q.bottomRows(q.rows() - 1);
  BeliefAgent wrong_rows = deep_agent(m, shifted, kind);
  EXPECT_NE(deep_play(m, wrong_rows, fixed), against_fixed);
}

// An agent of the deep layer whose values are a table does what the exact layer's agent does with that table: in every
// observation the same action, in every step of every episode the same, and returns that are equal as doubles.
TEST(Places, ATableInTheDeepAgentPlaysAsInTheExactLayer) {
  int kinds_differ = 0;
  for (const std::uint64_t model_seed : {8U, 16U, 83U, 138U}) {
    const LipschitzPlaces m(model_seed, 0.2);
    for (const QTable<double>& q : {m.pessimistic.q, with_twins(m.pessimistic.q)}) {
      expect_same_play(m, q, SetBelief::ball, BallBelief<double>(m.balls));
      expect_same_play(m, q, SetBelief::exact, BeliefFilter<double>(m.model.mdp, m.balls));
    }
    // The policy of pessimistic Q-iteration itself, observation by observation.
    BeliefAgent agent = deep_agent(m, m.pessimistic.q, SetBelief::ball);
    agent.resize(1);
    const std::vector<Lane> lanes(20, 0);
    std::vector<Point> all;
    for (State t = 0; t < 20; ++t) all.push_back(m.places.point(t));
    Policy actions(20);
    agent.would_do(lanes, all, actions);
    EXPECT_EQ(actions, m.policy);
    // Control: the exact filter is not the ball.
    BeliefAgent remembering = deep_agent(m, m.pessimistic.q, SetBelief::exact);
    FixedPlaceAttack truth(no_attack(20), m.balls, m.places);
    kinds_differ += deep_play(m, remembering, truth) != deep_play(m, agent, truth);
  }
  EXPECT_GT(kinds_differ, 0);
}

TEST(Places, BeliefsAreThoseOfTheExactLayer) {
  const LipschitzPlaces m(8, 0.2);
  const long k = m.balls.largest_ball();
  for (const SetBelief kind : {SetBelief::ball, SetBelief::exact}) {
    PlaceBeliefs beliefs(kind, m.model.mdp, m.balls, m.places);
    beliefs.resize(1);
    BeliefFilter<double> filter(m.model.mdp, m.balls);
    ASSERT_EQ(beliefs.states_per_belief(), k);
    Stream rng(1);
    State truth = 0;
    Action action = 0;  // that led here
    int smaller = 0;
    for (int t = 0; t < 60; ++t) {
      const auto ball = m.balls.ball(truth);
      const State shown = ball[static_cast<std::size_t>(rng.below(static_cast<int>(ball.size())))];
      const Lane lane = 0;
      const Point seen = m.places.point(shown);
      const BeliefStates peeked = beliefs.peek({&lane, 1}, {&action, 1}, {&seen, 1});
      const BeliefStates b = beliefs.update({&lane, 1}, {&action, 1}, {&seen, 1});
      EXPECT_TRUE(torch::equal(peeked.states, b.states) && torch::equal(peeked.weights, b.weights));
      if (t == 0 || kind == SetBelief::ball) {
        filter.reset(shown);
      } else {
        filter.update(action, shown);
      }
      const Belief& expected = filter.belief();
      smaller += expected.size() < static_cast<std::size_t>(k);
      ASSERT_EQ(beliefs.places(0), expected);
      EXPECT_TRUE(beliefs.holds(0, m.places.point(truth)));
      for (long i = 0; i < k; ++i) {
        const bool present = i < static_cast<long>(expected.size());
        const float weight = present ? 1.0F / static_cast<float>(expected.size()) : 0.0F;
        EXPECT_EQ(b.weights[0][i].item<float>(), weight);
        const State at = m.places.state_at(b.states[0][i][0].item<float>(), b.states[0][i][1].item<float>());
        EXPECT_EQ(at, expected[present ? static_cast<std::size_t>(i) : 0]);
      }
      action = rng.below(4);
      truth = m.environment.step(truth, action, rng).next;
    }
    EXPECT_GT(smaller, 0);  // some belief had to be filled up
  }
}

TEST(Places, RejectsWhatIsNoPlace) {
  Metric<double>::Points points(2, 2);
  points << 0, 0.5, 1, 0.25;
  const Places places(points);
  EXPECT_EQ(places.state_at(Point{1, 0.25}), 1);
  EXPECT_EQ(places.state_at(-0.0F, 0.5F), 0);
  EXPECT_THROW(places.state_at(Point{1, 0.25 + 1e-15}), InputError);
  EXPECT_THROW(places.state_at(Point{0.5, 0.5}), InputError);
  points(1, 0) = 1e-60;
  points(1, 1) = 0.5;
  EXPECT_THROW(Places{points}, InputError);  // the same for a network
  EXPECT_THROW(Places{Metric<double>::Points::Zero(2, 3)}, InputError);

  const LipschitzPlaces m(8, 0.2);
  EXPECT_THROW(PlacesWorld(m.environment, places), InputError);
  EXPECT_THROW(TableValues(QTable<double>::Zero(3, 1), places), InputError);
  AttackPolicy omega = no_attack(20);
  EXPECT_THROW(FixedPlaceAttack({0}, m.balls, m.places), InputError);
  for (State t = 0; t < 20; ++t) {
    if (!m.balls.contains(0, t)) omega[0] = t;
  }
  EXPECT_THROW(FixedPlaceAttack(omega, m.balls, m.places), std::logic_error);
}

}  // namespace
}  // namespace maximin::deep
