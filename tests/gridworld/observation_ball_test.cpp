#include <maximin/gridworld/observation_ball.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

namespace maximin {
namespace {

constexpr double q = gridworld::quantum;

template <class Call>
std::string complaint(Call&& call) {
  try {
    call();
  } catch (const InputError& e) {
    return e.what();
  }
  return "accepted";
}

TEST(ObservationBall, IsClosedExactAndCutToTheWorld) {
  const ObservationBall ball(0.5);
  const Point p{5, 5};
  EXPECT_TRUE(ball.contains(p, p));
  EXPECT_TRUE(ball.contains(p, {5.5, 4.5}));
  EXPECT_FALSE(ball.contains(p, {5.5 + q, 5}));
  EXPECT_FALSE(ball.contains(p, {5, 4.5 - q}));
  EXPECT_FALSE(ball.contains(p, {5 + q / 2, 5})) << "off the grid";
  EXPECT_TRUE(ball.contains({0.25, 9.75}, {0, 10})) << "the edges of the world may be shown";
  EXPECT_FALSE(ball.contains({0.25, 5}, {-q, 5}));
  EXPECT_FALSE(ball.contains({5, 9.75}, {5, 10 + q}));
  EXPECT_FALSE(ball.contains(p, {std::nan(""), 5}));
  const ObservationBall none(0);
  EXPECT_TRUE(none.contains(p, p));
  EXPECT_FALSE(none.contains(p, {5 + q, 5}));
}

TEST(ObservationBall, RoundsEpsDownToTheGrid) {
  const ObservationBall ball(0.1);
  EXPECT_LE(ball.eps(), 0.1);
  EXPECT_GT(ball.eps(), 0.1 - q);
  EXPECT_EQ(gridworld::round_down(ball.eps()), ball.eps());
  EXPECT_TRUE(ball.contains({5, 5}, {5 + ball.eps(), 5}));
  EXPECT_FALSE(ball.contains({5, 5}, {5 + ball.eps() + q, 5}));
}

TEST(ObservationBall, RefusesBadRadii) {
  EXPECT_EQ(complaint([] { ObservationBall(-0.1); }).substr(0, 5), "eps: ");
  EXPECT_EQ(complaint([] { ObservationBall(5.1); }).substr(0, 5), "eps: ");
  EXPECT_EQ(complaint([] { ObservationBall(std::nan("")); }).substr(0, 5), "eps: ");
  EXPECT_EQ(complaint([] { ObservationBall(5); }), "accepted");
  EXPECT_EQ(complaint([] { ObservationBall(0); }), "accepted");
}

/// A place of the world, its edges and corners as often as the rest.
Point any_place(Stream& rng) {
  const auto coordinate = [&rng] {
    if (rng.chance(0.2)) return 0.0;
    if (rng.chance(0.2)) return 10.0 - q;
    return gridworld::round_down(rng.uniform(0, 10));
  };
  const double x = coordinate();
  return {x, coordinate()};
}

RC_GTEST_PROP(ObservationBall, WhatIsDrawnOrProjectedMayBeShown, (std::uint64_t seed)) {
  Stream rng(seed);
  const ObservationBall ball(rng.chance(0.2) ? 0 : rng.uniform(0, 1));
  const Point truth = any_place(rng);
  const Point drawn = ball.draw(truth, rng);
  RC_ASSERT(ball.contains(truth, drawn));
  RC_ASSERT(ball.around(drawn).contains(truth));
  const Point wanted{rng.uniform(-2, 12), rng.uniform(-2, 12)};
  const Point shown = ball.project(truth, wanted);
  RC_ASSERT(ball.contains(truth, shown));
  RC_ASSERT(ball.project(truth, shown) == shown);
  RC_ASSERT(ball.project(truth, drawn) == drawn);
  for (int k = 0; k < 10; ++k) {  // nothing that may be shown is nearer, to a quantum
    const Point other = ball.draw(truth, rng);
    RC_ASSERT(std::abs(other.x - wanted.x) >= std::abs(shown.x - wanted.x) - q);
    RC_ASSERT(std::abs(other.y - wanted.y) >= std::abs(shown.y - wanted.y) - q);
  }
}

/// The box around what is shown holds exactly the truths that may be behind it.
RC_GTEST_PROP(ObservationBall, AroundIsTheOtherSideOfContains, (std::uint64_t seed)) {
  Stream rng(seed);
  const ObservationBall ball(rng.uniform(0, 1));
  const Point shown = ball.draw(any_place(rng), rng);
  const Box box = ball.around(shown);
  for (const double x : {box.x_low - q, box.x_low, shown.x, box.x_high - q, box.x_high}) {
    for (const double y : {box.y_low - q, box.y_low, shown.y, box.y_high - q, box.y_high}) {
      if (x < 0 || x >= 10 || y < 0 || y >= 10) continue;
      RC_ASSERT(box.contains({x, y}) == ball.contains({x, y}, shown));
    }
  }
}

TEST(ObservationBall, DrawsReachEveryCornerEvenly) {
  const ObservationBall ball(0.5);
  Stream rng(7);
  for (const Point truth : {Point{5, 5}, Point{0, 0}, Point{10 - q, 10 - q}}) {
    int low = 0, left = 0;
    const double x = (ball.low(truth.x) + ball.high(truth.x)) / 2, y = (ball.low(truth.y) + ball.high(truth.y)) / 2;
    double least = 10, most = 0;
    for (int k = 0; k < 20'000; ++k) {
      const Point p = ball.draw(truth, rng);
      left += p.x < x;
      low += p.y < y;
      least = std::min(least, p.x);
      most = std::max(most, p.x);
    }
    EXPECT_NEAR(left, 10'000, 400);
    EXPECT_NEAR(low, 10'000, 400);
    EXPECT_LT(least, ball.low(truth.x) + 0.001);
    EXPECT_GT(most, ball.high(truth.x) - 0.001);
  }
}

TEST(ObservationBall, ProjectsWhatIsFarAwayAndRefusesWhatIsNoNumber) {
  const ObservationBall ball(0.5);
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ball.project({5, 5}, {1e300, -1e300}), (Point{5.5, 4.5}));
  EXPECT_EQ(ball.project({0.25, 9.75}, {-7, 70}), (Point{0, 10}));
  EXPECT_THROW(ball.project({5, 5}, {infinity, 5}), std::invalid_argument);
  EXPECT_THROW(ball.project({5, 5}, {5, std::nan("")}), std::invalid_argument);
  // The random start of the authors' code, cut to [0,1], is no observation of a place beyond it.
  EXPECT_FALSE(ball.contains({5, 5}, {1, 1}));
}

}  // namespace
}  // namespace maximin
