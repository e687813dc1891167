#include <maximin/theory/aggregators.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>
#include <vector>

#include "small_models.hpp"

namespace maximin {
namespace {

template <class A>
double of(const A& aggregate, std::vector<double> values) {
  return aggregate(std::span<double>(values));
}

TEST(Aggregators, ByHand) {
  const std::vector<double> values{3, -1, 4, 2};
  EXPECT_EQ(of(MinAggregator{}, values), -1);
  EXPECT_EQ(of(MaxAggregator{}, values), 4);
  EXPECT_EQ(of(MeanAggregator{}, values), 2);
  EXPECT_EQ(of(CvarAggregator(0.25), values), -1) << "the worst of four";
  EXPECT_EQ(of(CvarAggregator(0.5), values), 0.5) << "the worst two of four";
  EXPECT_DOUBLE_EQ(of(CvarAggregator(0.375), values), (-1 + 0.5 * 2) / 1.5) << "the worst and half of the next";
  EXPECT_EQ(of(CvarAggregator(0.001), values), -1);
  EXPECT_EQ(of(CvarAggregator(1), values), 2);
  EXPECT_DOUBLE_EQ(of(SoftMinAggregator(1), {0, std::log(3.0)}), -std::log((1 + 1.0 / 3) / 2));
}

TEST(Aggregators, SoftMinApproachesMinAndMean) {
  const std::vector<double> values{3, -1, 4, 2};
  EXPECT_NEAR(of(SoftMinAggregator(1e4), values), -1, 1e-3);
  EXPECT_NEAR(of(SoftMinAggregator(1e-6), values), 2, 1e-5);
}

TEST(Aggregators, SoftMinSurvivesValuesFarApart) {
  EXPECT_NEAR(of(SoftMinAggregator(1), {-1e6, 1e6}), -1e6 + std::log(2.0), 1e-6);
  EXPECT_NEAR(of(SoftMinAggregator(1), {1e300, 1e300}), 1e300, 1e285);
}

TEST(Aggregators, RefuseParametersOutOfRange) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  for (const double beta : {0.0, -1.0, inf, nan}) {
    EXPECT_EQ(complaint([&] { SoftMinAggregator{beta}; }), "soft-min: beta must be positive and finite, e.g. 1");
  }
  for (const double alpha : {0.0, -0.5, 1.0001, inf, nan}) {
    EXPECT_EQ(complaint([&] { CvarAggregator{alpha}; }), "cvar: alpha must be above 0 and at most 1, e.g. 0.25");
  }
  EXPECT_EQ(SoftMinAggregator(2).beta(), 2);
  EXPECT_EQ(CvarAggregator(1).alpha(), 1);
}

struct Case {
  std::vector<double> values;
  double alpha, beta;
};

/// Values in whole tenths, many of them equal.
Case any_case() {
  const auto tenths = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(-50, 51)));
  Case c;
  for (const int x : tenths) c.values.push_back(x / 10.0);
  c.alpha = *rc::gen::inRange(1, 101) / 100.0;
  c.beta = *rc::gen::inRange(1, 201) / 20.0;
  return c;
}

constexpr double rounding = 1e-12;

RC_GTEST_PROP(Aggregators, MinIsBelowCvarIsBelowMean, ()) {
  const Case c = any_case();
  const double cvar = of(CvarAggregator(c.alpha), c.values);
  RC_ASSERT(of(MinAggregator{}, c.values) <= cvar + rounding);
  RC_ASSERT(cvar <= of(MeanAggregator{}, c.values) + rounding);
}

RC_GTEST_PROP(Aggregators, MinIsBelowSoftMinIsBelowMeanIsBelowMax, ()) {
  const Case c = any_case();
  const double soft = of(SoftMinAggregator(c.beta), c.values), mean = of(MeanAggregator{}, c.values);
  RC_ASSERT(of(MinAggregator{}, c.values) <= soft + rounding);
  RC_ASSERT(soft <= mean + rounding);
  RC_ASSERT(mean <= of(MaxAggregator{}, c.values) + rounding);
}

RC_GTEST_PROP(Aggregators, MorePessimismIsLower, ()) {
  const Case c = any_case();
  RC_ASSERT(of(CvarAggregator(c.alpha / 2), c.values) <= of(CvarAggregator(c.alpha), c.values) + rounding);
  RC_ASSERT(of(SoftMinAggregator(2 * c.beta), c.values) <= of(SoftMinAggregator(c.beta), c.values) + rounding);
}

RC_GTEST_PROP(Aggregators, AConstantComesOut, ()) {
  Case c = any_case();
  std::vector<double> shifted = c.values;
  for (double& v : shifted) v += 3;
  const auto shifts = [&](const auto& aggregate) {
    return std::abs(of(aggregate, shifted) - of(aggregate, c.values) - 3) <= rounding;
  };
  RC_ASSERT(shifts(MinAggregator{}));
  RC_ASSERT(shifts(MaxAggregator{}));
  RC_ASSERT(shifts(MeanAggregator{}));
  RC_ASSERT(shifts(SoftMinAggregator(c.beta)));
  RC_ASSERT(shifts(CvarAggregator(c.alpha)));
}

RC_GTEST_PROP(Aggregators, TheOrderOfTheValuesDoesNotMatter, ()) {
  const Case c = any_case();
  std::vector<double> backwards(c.values.rbegin(), c.values.rend());
  RC_ASSERT(of(MinAggregator{}, backwards) == of(MinAggregator{}, c.values));
  RC_ASSERT(of(CvarAggregator(c.alpha), backwards) == of(CvarAggregator(c.alpha), c.values));
  RC_ASSERT(std::abs(of(SoftMinAggregator(c.beta), backwards) - of(SoftMinAggregator(c.beta), c.values)) <= rounding);
}

}  // namespace
}  // namespace maximin
