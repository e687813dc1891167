#include <maximin/theory/perturbation.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "small_models.hpp"

namespace maximin {
namespace {

using Lists = std::vector<std::vector<State>>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

std::vector<State> members(const Perturbation<double>& perturbation, State s) {
  const auto ball = perturbation.ball(s);
  return {ball.begin(), ball.end()};
}

TEST(Perturbation, BallsAreClosedSymmetricAndHoldTheirCentre) {
  const auto balls = on_line<double>({0, 2, 1, 20}, 1);
  EXPECT_EQ(members(balls, 0), (std::vector<State>{0, 2}));
  EXPECT_EQ(members(balls, 2), (std::vector<State>{0, 1, 2}));
  EXPECT_EQ(members(balls, 3), (std::vector<State>{3}));
  EXPECT_EQ(balls.states(), 4);
  EXPECT_EQ(balls.largest_ball(), 3);
  EXPECT_EQ(balls.eps(), 1);
  EXPECT_EQ(balls.radius(), 1);
  for (State s = 0; s < 4; ++s) {
    EXPECT_TRUE(balls.contains(s, s));
    for (State t = 0; t < 4; ++t) EXPECT_EQ(balls.contains(s, t), balls.contains(t, s));
  }
  EXPECT_TRUE(balls.contains(1, 2));
  EXPECT_FALSE(balls.contains(0, 1));
}

TEST(Perturbation, OfRadiusZero) {
  const auto alone = on_line<double>({0, 1, 2}, 0);
  for (State s = 0; s < 3; ++s) EXPECT_EQ(members(alone, s), (std::vector<State>{s}));
  EXPECT_EQ(alone.largest_ball(), 1);
  EXPECT_EQ(alone.radius(), 0);
  const auto twins = on_line<double>({0, 1, 1}, 0);
  EXPECT_EQ(members(twins, 1), (std::vector<State>{1, 2})) << "distance 0 is within 0";
}

/// Tenths are no doubles: 0.3 - 0.2 exceeds 0.1. On a grid of them the closed ball must hold its rim all the same, and
/// `radius` must own up to it.
TEST(Perturbation, GridsOfTenthsKeepTheRimOfTheBall) {
  constexpr State side = 30;
  std::vector<double> x;
  for (State s = 0; s < side; ++s) x.push_back(0.1 * s);
  bool rounding_seen = false;
  for (State k = 1; k <= 10; ++k) {
    const double eps = 0.1 * k;
    const auto balls = on_line(x, eps);
    for (State s = 0; s < side; ++s) {
      for (State t = 0; t < side; ++t) {
        EXPECT_EQ(balls.contains(s, t), std::abs(s - t) <= k) << s << " " << t << " eps " << eps;
        EXPECT_TRUE(!balls.contains(s, t) || balls.metric().distance(s, t) <= balls.radius());
      }
    }
    EXPECT_GE(balls.radius(), eps);
    EXPECT_LE(balls.radius(), eps * (1 + 1e-12));
    rounding_seen |= balls.radius() > eps;
  }
  EXPECT_TRUE(rounding_seen);
}

TEST(Perturbation, GridsOfTenthsInThePlaneUnderEachNorm) {
  constexpr State side = 9;
  Metric<double>::Points points(side * side, 2);
  for (State s = 0; s < side * side; ++s) points.row(s) << 0.1 * (s / side), 0.1 * (s % side);
  for (const Norm norm : {Norm::l1, Norm::l2, Norm::linf}) {
    const Perturbation<double> balls(Metric<double>::from_points(points, norm), 0.5);
    for (State s = 0; s < side * side; ++s) {
      for (State t = 0; t < side * side; ++t) {
        const int dx = std::abs(s / side - t / side), dy = std::abs(s % side - t % side);
        const bool inside = norm == Norm::l1   ? dx + dy <= 5
                            : norm == Norm::l2 ? dx * dx + dy * dy <= 25
                                               : std::max(dx, dy) <= 5;
        EXPECT_EQ(balls.contains(s, t), inside);
      }
    }
  }
}

TEST(Perturbation, WhatIsOutsideByMoreThanRoundingStaysOutside) {
  const auto balls = on_line<double>({0, 1 + 1e-11}, 1);
  EXPECT_FALSE(balls.contains(0, 1));
  EXPECT_EQ(balls.radius(), 1);
}

TEST(Perturbation, RefusesRadiiThatAreNone) {
  for (const double eps : {-1.0, -1e-300, nan, inf, -inf}) {
    EXPECT_EQ(complaint([&] { on_line<double>({0, 1}, eps); }), "eps: negative or not finite, expected eps >= 0");
  }
}

TEST(Perturbation, OfListsGivesBackTheListsAndCountsHops) {
  const auto balls = Perturbation<double>::from_neighbourhoods({{1, 0}, {0, 2, 1}, {1, 2}, {3}});
  EXPECT_EQ(members(balls, 0), (std::vector<State>{0, 1}));
  EXPECT_EQ(members(balls, 1), (std::vector<State>{0, 1, 2}));
  EXPECT_EQ(members(balls, 2), (std::vector<State>{1, 2}));
  EXPECT_EQ(members(balls, 3), (std::vector<State>{3}));
  EXPECT_EQ(balls.metric().distance(0, 2), 2);
  EXPECT_EQ(balls.metric().distance(2, 0), 2);
  EXPECT_EQ(balls.metric().distance(0, 3), inf);
  EXPECT_EQ(balls.metric().distance(3, 3), 0);
  EXPECT_EQ(balls.eps(), 1);
  EXPECT_EQ(balls.radius(), 1);
}

TEST(Perturbation, RefusesListsThatAreNoBalls) {
  const auto of = [](const Lists& lists) {
    return complaint([&] { Perturbation<double>::from_neighbourhoods(lists); });
  };
  EXPECT_EQ(of({}), "neighbourhoods: empty, expected one list per state");
  EXPECT_EQ(of({{0}, {}}), "neighbourhoods[1]: empty ball, expected at least the state itself");
  EXPECT_EQ(of({{0, 2}, {1}}), "neighbourhoods[0]: state 2 does not exist, expected 0 to 1");
  EXPECT_EQ(of({{0, -1}, {1}}), "neighbourhoods[0]: state -1 does not exist, expected 0 to 1");
  EXPECT_EQ(of({{0, 1, 0}, {0, 1}}), "neighbourhoods[0]: state 0 listed twice, expected each state once");
  EXPECT_EQ(of({{0, 1}, {1}}),
            "neighbourhoods[0]: lists state 1, which does not list it back, expected symmetric balls");
  EXPECT_EQ(of({{1}, {0, 1}}), "neighbourhoods[0]: lacks state 0 itself, expected a ball to contain its centre");
  EXPECT_EQ(of(Lists(static_cast<std::size_t>(Perturbation<double>::max_listed_states) + 1)),
            "neighbourhoods: 10001 lists, expected at most 10000; give points and a norm instead");
}

TEST(Perturbation, OfTheDiscreteMetricHasOneStateOrAll) {
  const auto balls = [](double eps) { return Perturbation<double>(Metric<double>::discrete(3), eps); };
  EXPECT_EQ(members(balls(0.9), 1), std::vector<State>{1});
  EXPECT_EQ(balls(0.9).radius(), 0.9);
  EXPECT_EQ(members(balls(1), 1), (std::vector<State>{0, 1, 2}));
  EXPECT_EQ(balls(1 - 1e-15).radius(), 1);
  EXPECT_EQ(balls(7).radius(), 7);
}

TEST(Perturbation, RefusesBallsAndScansBeyondItsLimits) {
  const auto discrete = [](double eps) { Perturbation<double>(Metric<double>::discrete(1'000'000), eps); };
  EXPECT_EQ(complaint([&] { discrete(0.5); }), "accepted");
  EXPECT_EQ(complaint([&] { discrete(1); }),
            "eps: the balls of 1000000 states have more than 268435456 members, expected a smaller eps or model");
  const auto points = [] { return Metric<double>::from_points(Metric<double>::Points::Zero(100'001, 1), Norm::linf); };
  EXPECT_EQ(complaint([&] { Perturbation<double>(points(), 1.0); }),
            "metric: 100001 states have more than 10000000000 pairs, expected a smaller model or the discrete metric");
}

}  // namespace
}  // namespace maximin
