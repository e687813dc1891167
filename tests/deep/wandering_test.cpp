#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include <maximin/deep/wandering.hpp>
#include <maximin/gridworld/box_belief.hpp>

namespace maximin::deep {
namespace {

TEST(Wandering, WhatIsShownIsInTheBallAndTheMixtureCoversTheWorld) {
  constexpr double eps = 0.5;
  const ObservationBall ball(eps);
  std::array<int, 100> visits{};
  std::set<Action> drawn, drawn_of_seven;
  long outside_of_half = 0;
  for (int kind = 0; kind <= deceptions; ++kind) {
    Wandering lane(Walk::mixed, static_cast<Deception>(kind), eps),
        seven(Walk::random, static_cast<Deception>(kind), eps, 7);
    for (std::uint64_t episode = 0; episode < 60; ++episode) {
      lane.begin(1, episode);
      BoxBelief exact(ball);
      exact.reset(lane.shown());
      long steps = 0;
      do {
        if (lane.last_action() >= 0) {
          drawn.insert(lane.last_action());
          exact.update(lane.last_action(), lane.shown());
        }
        ASSERT_TRUE(ball.contains(lane.truth(), lane.shown()))
            << words_of(Deception::none).at(static_cast<std::size_t>(kind));
        ASSERT_TRUE(exact.belief().contains(lane.truth()));
        outside_of_half += !ObservationBall(eps / 2).contains(lane.truth(), lane.shown());
        ++visits[static_cast<std::size_t>(std::floor(lane.truth().y) * 10 + std::floor(lane.truth().x))];
        ++steps;
      } while (lane.step());
      ASSERT_LE(steps, 100);
      EXPECT_EQ(exact.empty_intersections(), 0);
      for (seven.begin(1, episode); seven.step();) drawn_of_seven.insert(seven.last_action());
    }
  }
  EXPECT_GT(outside_of_half, 0);
  EXPECT_EQ(drawn.size(), 8U);
  EXPECT_EQ(drawn_of_seven.size(), 7U);
  for (int c = 0; c < 100; ++c) {
    const bool free = gridworld::cell(c % 10, c / 10) == gridworld::Cell::free;
    EXPECT_EQ(visits[static_cast<std::size_t>(c)] > 0, free) << "cell " << c % 10 << ", " << c / 10;
  }
}

TEST(Wandering, AnEpisodeIsAFunctionOfItsNumber) {
  Wandering one(Walk::mixed, Deception::mixed, 0.1), other(Walk::mixed, Deception::mixed, 0.1);
  for (std::uint64_t episode = 0; episode < 5; ++episode) one.begin(9, episode);
  one.begin(9, 3);
  other.begin(9, 3);
  while (one.step()) {
    ASSERT_TRUE(other.step());
    ASSERT_EQ(one.shown(), other.shown());
    ASSERT_EQ(one.truth(), other.truth());
  }
  EXPECT_FALSE(other.step());
  one.begin(9, 4);
  other.begin(9, 3);
  EXPECT_FALSE(one.truth() == other.truth());
}

}  // namespace
}  // namespace maximin::deep
