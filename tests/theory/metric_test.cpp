#include <maximin/theory/metric.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "small_models.hpp"

namespace maximin {
namespace {

using M = Metric<double>;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

M::Points corner_points() {
  M::Points points(3, 2);
  points << 0, 0, 3, -4, 3, 0;
  return points;
}

TEST(Metric, OfPointsUnderEachNorm) {
  const auto l1 = M::from_points(corner_points(), Norm::l1);
  const auto l2 = M::from_points(corner_points(), Norm::l2);
  const auto linf = M::from_points(corner_points(), Norm::linf);
  EXPECT_EQ(l1.distance(0, 1), 7);
  EXPECT_EQ(l2.distance(0, 1), 5);
  EXPECT_EQ(linf.distance(0, 1), 4);
  for (const auto* metric : {&l1, &l2, &linf}) {
    EXPECT_EQ(metric->states(), 3);
    EXPECT_EQ(metric->distance(0, 2), 3) << "along one axis all norms agree";
    for (State s = 0; s < 3; ++s) {
      EXPECT_EQ(metric->distance(s, s), 0);
      for (State t = 0; t < 3; ++t) EXPECT_EQ(metric->distance(s, t), metric->distance(t, s));
    }
  }
  EXPECT_EQ(linf.norm(), Norm::linf);
  ASSERT_NE(l2.points(), nullptr);
  EXPECT_EQ(*l2.points(), corner_points());
}

TEST(Metric, L2NeitherOverflowsNorUnderflows) {
  for (const double scale : {1e-310, 1e-200, 1e-150, 1.0, 1e150, 1e200, 1e307}) {
    const auto metric = M::from_points(corner_points() * scale, Norm::l2);
    EXPECT_NEAR(metric.distance(0, 1) / (scale * 5), 1, 1e-12) << scale;
    EXPECT_EQ(metric.distance(1, 1), 0) << scale;
    EXPECT_TRUE(std::isfinite(metric.distance(0, 1))) << scale;
  }
}

TEST(Metric, RefusesPointsTooFarApart) {
  M::Points points(2, 2);
  points << 1e308, 1e308, 0, 0;
  const std::string message = "points: so far apart that distances overflow, expected smaller coordinates";
  EXPECT_EQ(complaint([&] { M::from_points(points, Norm::l1); }), message);
  EXPECT_EQ(complaint([&] { M::from_points(points * 1.7, Norm::l2); }), message);
  EXPECT_EQ(M::from_points(points, Norm::l2).distance(0, 1), std::sqrt(2) * 1e308);
  EXPECT_EQ(M::from_points(points, Norm::linf).distance(0, 1), 1e308);
  points << 1e308, 0, -1e308, 0;
  EXPECT_EQ(complaint([&] { M::from_points(points, Norm::linf); }), message);
}

TEST(Metric, RefusesPointsThatAreNone) {
  EXPECT_EQ(complaint([] { M::from_points(M::Points(0, 2), Norm::l1); }),
            "points: empty, expected one point per state");
  EXPECT_EQ(complaint([] { M::from_points(M::Points(2, 0), Norm::l1); }),
            "points: empty, expected one point per state");
  for (const double x : {nan, inf, -inf}) {
    auto points = corner_points();
    points(1, 1) = x;
    EXPECT_EQ(complaint([&] { M::from_points(points, Norm::l2); }),
              "points[1]: not finite, expected finite coordinates");
  }
}

TEST(Metric, OfAMatrix) {
  QTable<double> d(3, 3);
  d << 0, 1, 3, 1, 0, 2, 3, 2, 0;
  const auto metric = M::from_distances(d);
  EXPECT_EQ(metric.states(), 3);
  EXPECT_EQ(metric.distance(2, 0), 3);
  EXPECT_EQ(metric.points(), nullptr);
}

TEST(Metric, OfAMatrixWithRoundingInTheTriangle) {
  QTable<double> d(3, 3);
  d << 0, 0.1, 0.1 + 0.2, 0.1, 0, 0.2, 0.1 + 0.2, 0.2, 0;  // 0.1 + 0.2 rounds up
  EXPECT_NO_THROW(M::from_distances(d));
  d(0, 2) = d(2, 0) = 0.3 * (1 + 1e-14);
  EXPECT_NE(complaint([&] { M::from_distances(d); }), "accepted") << "more than rounding";
}

TEST(Metric, OfAMatrixWithIslands) {
  QTable<double> d(3, 3);
  d << 0, 1, inf, 1, 0, inf, inf, inf, 0;
  EXPECT_EQ(M::from_distances(d).distance(0, 2), inf);
}

TEST(Metric, RefusesMatricesThatAreNoDistance) {
  QTable<double> good(3, 3);
  good << 0, 1, 2, 1, 0, 1, 2, 1, 0;
  EXPECT_EQ(complaint([] { M::from_distances(QTable<double>(0, 0)); }),
            "distances: not square, expected one row and column per state");
  EXPECT_EQ(complaint([] { M::from_distances(QTable<double>::Zero(2, 3)); }),
            "distances: not square, expected one row and column per state");
  auto negative = good;
  negative(0, 1) = negative(1, 0) = -1;
  EXPECT_EQ(complaint([&] { M::from_distances(negative); }),
            "distances[0][1]: negative or not a number, expected a distance >= 0");
  auto not_a_number = good;
  not_a_number(2, 1) = nan;
  EXPECT_NE(complaint([&] { M::from_distances(not_a_number); }), "accepted");
  auto one_way = good;
  one_way(2, 0) = 1.5;
  EXPECT_EQ(complaint([&] { M::from_distances(one_way); }),
            "distances[0][2]: differs from distances[2][0], expected a symmetric matrix");
  auto from_itself = good;
  from_itself(1, 1) = 0.5;
  EXPECT_EQ(complaint([&] { M::from_distances(from_itself); }),
            "distances[1][1]: not 0, expected a state to be at distance 0 from itself");
  auto detour = good;
  detour(0, 2) = detour(2, 0) = 2.5;
  EXPECT_EQ(complaint([&] { M::from_distances(detour); }),
            "distances[0][2]: longer than the way through state 1, expected the triangle inequality to hold");
}

TEST(Metric, Discrete) {
  const auto metric = M::discrete(4);
  EXPECT_EQ(metric.states(), 4);
  for (State s = 0; s < 4; ++s) {
    for (State t = 0; t < 4; ++t) EXPECT_EQ(metric.distance(s, t), s == t ? 0 : 1);
  }
  EXPECT_EQ(complaint([] { M::discrete(0); }), "states: 0, expected at least 1");
}

}  // namespace
}  // namespace maximin
