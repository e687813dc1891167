#include <maximin/tabular/certified.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace maximin {
namespace {

FiniteMdp<double> loop(double reward, double discount, double probability = 1) {
  FiniteMdpBuilder<double> b(1, 1, discount);
  b.reward(0, 0, reward).transition(0, 0, 0, probability);
  return std::move(b).build();
}

/// v = (0, 0), Tv = (1, 3), gamma = 1/2: the fixed point lies between Tv + 1 and Tv + 3.
TEST(MacQueenBound, ByHand) {
  FiniteMdpBuilder<double> b(2, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(0, 0, 1).reward(1, 0, 3);
  const auto mdp = std::move(b).build();
  const MacQueenBound<double> bound(mdp);
  const auto interval = bound(Values<double>{{0, 0}}, Values<double>{{1, 3}});
  EXPECT_NEAR(interval.shift, 2, 1e-14);
  EXPECT_GE(interval.error, 1) << "the true values are 2 and 6";
  EXPECT_NEAR(interval.error, 1, 1e-13);
  EXPECT_EQ(bound.scale(), 6);
}

TEST(MacQueenBound, OneStateIsKnownAfterOneSweep) {
  const auto mdp = loop(1, 0.999);
  const auto interval = MacQueenBound<double>(mdp)(Values<double>{{0}}, Values<double>{{1}});
  EXPECT_NEAR(1 + interval.shift, 1000, interval.error);
  EXPECT_LT(interval.error, 1e-9);
}

TEST(MacQueenBound, RoundingIsCountedAndGrowsWithTheValues) {
  const MacQueenBound<double> bound(loop(1, 0.5));
  EXPECT_GT(bound.rounding_of_backup(1), 1e-16);
  EXPECT_LT(bound.rounding_of_backup(1), 1e-14);
  EXPECT_GT(bound.rounding_of_backup(1e6), 1e5 * bound.rounding_of_backup(1));
}

TEST(MacQueenBound, TargetsAreFractionsOfTheScaleAndNeverBelowRounding) {
  const MacQueenBound<double> bound(loop(3, 0.5));
  EXPECT_DOUBLE_EQ(bound.target({.tolerance = 0.01}), 0.06);
  EXPECT_DOUBLE_EQ(bound.target({}), 6e-12);
  const MacQueenBound<double> patient(loop(3, 1 - 1e-6));
  EXPECT_GT(patient.target({}), 1e-12 * patient.scale()) << "rounding allows no better";
  EXPECT_GT(MacQueenBound<double>(loop(0, 0.5)).target({}), 0);
}

/// A row that sums to 1 + d only to rounding is an operator of its own, with discount gamma (1 + d).
TEST(MacQueenBound, RowsOffByRoundingAreAllowedFor) {
  const double d = 0x1p-44;
  const auto mdp = loop(1, 0.5, 1 + d);
  const auto interval = MacQueenBound<double>(mdp)(Values<double>{{0}}, Values<double>{{1}});
  const long double truth = 1 / (1 - 0.5L * (1 + static_cast<long double>(d)));
  EXPECT_LE(std::abs(1 + static_cast<long double>(interval.shift) - truth), interval.error);
  EXPECT_GE(interval.error, 0.5 * d);
}

TEST(MacQueenBound, RefusesADiscountThatTheRowsMakeOne) {
  const auto mdp = loop(1, std::nextafter(1.0, 0.0), 1 + 0x1p-44);
  EXPECT_THROW(MacQueenBound<double>{mdp}, InputError);
}

}  // namespace
}  // namespace maximin
