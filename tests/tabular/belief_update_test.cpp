#include <maximin/tabular/belief_update.hpp>

#include <gtest/gtest.h>

#include <maximin/theory/concepts.hpp>

#include "random_model.hpp"

namespace maximin {
namespace {

static_assert(BeliefModel<BeliefFilter<double>>);

/// A corridor of five states: action 0 goes left, action 1 right; walls stop it. State 2 slips: it may stay.
FiniteMdp<double> corridor() {
  FiniteMdpBuilder<double> b(5, 2, 0.9);
  for (State s = 0; s < 5; ++s) {
    const State left = std::max(0, s - 1), right = std::min(4, s + 1);
    if (s == 2) {
      b.transition(s, 0, 2, 0.25).transition(s, 0, left, 0.75).transition(s, 1, 2, 0.25).transition(s, 1, right, 0.75);
    } else {
      b.transition(s, 0, left, 1).transition(s, 1, right, 1);
    }
  }
  return std::move(b).build();
}

Belief after(const Belief& belief, Action a) {
  Belief out;
  belief_successors(corridor(), std::span<const State>(belief), a, out);
  return out;
}

TEST(BeliefUpdate, SuccessorsOfEveryMember) {
  EXPECT_EQ(after({0}, 1), (Belief{1}));
  EXPECT_EQ(after({0}, 0), (Belief{0}));
  EXPECT_EQ(after({2}, 1), (Belief{2, 3}));
  EXPECT_EQ(after({0, 1, 2}, 1), (Belief{1, 2, 3})) << "ascending, each once";
  EXPECT_EQ(after({3, 4}, 1), (Belief{4}));
  EXPECT_EQ(after({0, 1, 2, 3, 4}, 0), (Belief{0, 1, 2, 3}));
}

TEST(BeliefUpdate, MeetsTheBallOfTheObservation) {
  const auto balls = line_balls(5, 1);
  Belief met;
  const Belief predicted{1, 2, 3};
  EXPECT_EQ(meet_observation(balls, std::span<const State>(predicted), 4, met), BeliefUpdate::met);
  EXPECT_EQ(met, (Belief{3}));
  EXPECT_EQ(meet_observation(balls, std::span<const State>(predicted), 2, met), BeliefUpdate::met);
  EXPECT_EQ(met, (Belief{1, 2, 3}));
}

TEST(BeliefUpdate, TrustsTheObservationWhereTheyDoNotMeet) {
  const auto balls = line_balls(5, 1);
  Belief met;
  const Belief predicted{0, 1};
  EXPECT_EQ(meet_observation(balls, std::span<const State>(predicted), 4, met), BeliefUpdate::empty);
  EXPECT_EQ(met, (Belief{3, 4}));
}

TEST(BeliefFilter, WalksTheCorridor) {
  const auto mdp = corridor();
  const auto balls = line_balls(5, 1);
  BeliefFilter filter(mdp, balls);
  EXPECT_EQ(filter.reset(0), (Belief{0, 1}));
  EXPECT_EQ(filter.update(1, 1), (Belief{1, 2}));
  EXPECT_EQ(filter.predicted(), (Belief{1, 2}));
  EXPECT_EQ(filter.update(1, 3), (Belief{2, 3}));
  EXPECT_EQ(filter.update(1, 4), (Belief{3, 4}));
  EXPECT_EQ(filter.predicted(), (Belief{2, 3, 4}));
  EXPECT_EQ(filter.update(1, 3), (Belief{4})) << "3 was left for sure";
  EXPECT_EQ(filter.belief(), (Belief{4}));
  EXPECT_EQ(filter.empty_intersections(), 0);
}

TEST(BeliefFilter, CountsWhereHistoryAndObservationContradict) {
  const auto mdp = corridor();
  const auto balls = line_balls(5, 1);
  BeliefFilter filter(mdp, balls);
  filter.reset(0);
  EXPECT_EQ(filter.update(0, 4), (Belief{3, 4})) << "the truth can only be 0";
  EXPECT_EQ(filter.empty_intersections(), 1);
  EXPECT_EQ(filter.update(1, 4), (Belief{4}));
  EXPECT_EQ(filter.empty_intersections(), 1);
  filter.reset(0);
  filter.update(0, 3);
  EXPECT_EQ(filter.empty_intersections(), 2) << "counted over all episodes";
}

}  // namespace
}  // namespace maximin
