#include <maximin/theory/finite_mdp.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "small_models.hpp"

namespace maximin {
namespace {

using Builder = FiniteMdpBuilder<double>;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// Two states, one action; both rows sure.
Builder two_states() {
  Builder b(2, 1, 0.5);
  b.transition(0, 0, 1, 1).transition(1, 0, 1, 1);
  return b;
}

TEST(FiniteMdp, KeepsWhatItWasGivenInRowsOfAscendingTargets) {
  Builder b(3, 2, 0.25);
  b.transition(0, 1, 2, 0.5).transition(0, 1, 0, 0.25).transition(0, 1, 1, 0.25);
  for (State s = 0; s < 3; ++s) b.transition(s, 0, s, 1);
  b.transition(1, 1, 0, 1).transition(2, 1, 0, 0).transition(2, 1, 1, 1);
  b.reward(0, 1, 4).reward(0, 1, -3).reward(2, 0, 7);
  const auto mdp = std::move(b).build();
  EXPECT_EQ(mdp.states(), 3);
  EXPECT_EQ(mdp.actions(), 2);
  EXPECT_EQ(mdp.discount(), 0.25);
  EXPECT_EQ(mdp.reward(0, 1), -3) << "the last value counts";
  EXPECT_EQ(mdp.reward(2, 0), 7);
  EXPECT_EQ(mdp.reward(1, 1), 0) << "the default";
  const auto row = mdp.successors(0, 1);
  EXPECT_EQ(std::vector(row.begin(), row.end()), (std::vector<Successor<double>>{{0, 0.25}, {1, 0.25}, {2, 0.5}}));
  EXPECT_EQ(mdp.successors(2, 1).size(), 1u) << "a probability of zero is no transition";
  EXPECT_EQ(mdp.successors(2, 1)[0].target, 1);
  EXPECT_EQ(mdp.transition_count(), 8u);
  const Values<double> v{{8, 4, 2}};
  EXPECT_EQ(mdp.expectation(0, 1, v), 0.25 * 8 + 0.25 * 4 + 0.5 * 2);
}

TEST(FiniteMdp, EqualWhenEverythingIs) {
  const auto mdp = two_states().build();
  EXPECT_EQ(mdp, two_states().build());
  EXPECT_NE(mdp, std::move(two_states().reward(0, 0, 1)).build());
  Builder other_row(2, 1, 0.5), other_discount(2, 1, 0.25), one_more(3, 1, 0.5);
  other_row.transition(0, 0, 0, 1).transition(1, 0, 1, 1);
  other_discount.transition(0, 0, 1, 1).transition(1, 0, 1, 1);
  one_more.transition(0, 0, 1, 1).transition(1, 0, 1, 1).transition(2, 0, 2, 1);
  EXPECT_NE(mdp, std::move(other_row).build());
  EXPECT_NE(mdp, std::move(other_discount).build());
  EXPECT_NE(mdp, std::move(one_more).build());
}

TEST(FiniteMdpBuilder, RefusesSizesAndDiscountsOutOfRange) {
  EXPECT_EQ(complaint([] { Builder(0, 1, 0.5); }), "states: 0, expected at least 1");
  EXPECT_EQ(complaint([] { Builder(-3, 1, 0.5); }), "states: -3, expected at least 1");
  EXPECT_EQ(complaint([] { Builder(1, 0, 0.5); }), "actions: 0, expected at least 1");
  for (const double gamma : {1.0, -0.1, 2.0, nan, inf, -inf}) {
    EXPECT_EQ(complaint([&] { Builder(1, 1, gamma); }), "discount: outside the range, expected 0 <= discount < 1");
  }
  EXPECT_NO_THROW(Builder(1, 1, 0.0));
  EXPECT_NO_THROW(Builder(1, 1, std::nextafter(1.0, 0.0)));
}

TEST(FiniteMdpBuilder, RefusesPairsAndTargetsThatAreNone) {
  Builder b(2, 3, 0.5);
  EXPECT_EQ(complaint([&] { b.reward(2, 0, 1); }),
            "reward (state 2, action 0): no such pair, expected states 0 to 1 and actions 0 to 2");
  EXPECT_EQ(complaint([&] { b.transition(0, -1, 0, 1); }),
            "transition (state 0, action -1): no such pair, expected states 0 to 1 and actions 0 to 2");
  EXPECT_NE(complaint([&] { b.reward(-1, 0, 1); }), "accepted");
  EXPECT_NE(complaint([&] { b.reward(0, 3, 1); }), "accepted");
  for (const State target : {-1, 2}) {
    EXPECT_EQ(complaint([&] { b.transition(1, 2, target, 1); }),
              "transition (state 1, action 2): target " + std::to_string(target) + " is not a state, expected 0 to 1");
  }
}

TEST(FiniteMdpBuilder, RefusesNumbersThatAreNone) {
  Builder b(2, 1, 0.5);
  for (const double value : {nan, inf, -inf}) {
    EXPECT_EQ(complaint([&] { b.reward(1, 0, value); }),
              "reward (state 1, action 0): not finite, expected a finite number");
  }
  for (const double p : {nan, inf, -inf, -1e-300, -0.5}) {
    EXPECT_EQ(complaint([&] { b.transition(1, 0, 0, p); }),
              "transition (state 1, action 0) -> 0: probability is negative or not finite, expected a number from 0 "
              "to 1");
  }
  EXPECT_NO_THROW(b.transition(1, 0, 0, -0.0));
}

TEST(FiniteMdpBuilder, RefusesRowsThatAreNoDistribution) {
  Builder missing(2, 1, 0.5);
  missing.transition(0, 0, 0, 1);
  EXPECT_EQ(complaint([&] { std::move(missing).build(); }),
            "transition (state 1, action 0): no transitions, expected probabilities that sum to 1");
  Builder short_row(2, 1, 0.5);
  short_row.transition(0, 0, 0, 0.5).transition(0, 0, 1, 0.25).transition(1, 0, 1, 1);
  EXPECT_EQ(complaint([&] { std::move(short_row).build(); }),
            "transition (state 0, action 0): probabilities sum to 0.750000, expected 1");
  Builder long_row(2, 1, 0.5);
  long_row.transition(0, 0, 0, 0.75).transition(0, 0, 1, 0.5).transition(1, 0, 1, 1);
  EXPECT_EQ(complaint([&] { std::move(long_row).build(); }),
            "transition (state 0, action 0): probabilities sum to 1.250000, expected 1");
  Builder twice(2, 1, 0.5);
  twice.transition(0, 0, 0, 0.5).transition(0, 0, 1, 0).transition(0, 0, 0, 0.5).transition(1, 0, 1, 1);
  EXPECT_EQ(complaint([&] { std::move(twice).build(); }),
            "transition (state 0, action 0) -> 0: given twice, expected each (state, action, target) once");
}

TEST(FiniteMdpBuilder, RowsMaySumToOneUpToRoundingAndNoFurther) {
  const auto row_of_sum = [](double sum) {
    Builder b(1, 1, 0.5);
    b.transition(0, 0, 0, sum);
    return complaint([&] { std::move(b).build(); });
  };
  const double tolerance = Builder::row_tolerance();
  EXPECT_LT(tolerance, 1e-12);
  EXPECT_EQ(row_of_sum(1 + tolerance), "accepted");
  EXPECT_EQ(row_of_sum(1 - tolerance), "accepted");
  EXPECT_NE(row_of_sum(1 + 2 * tolerance), "accepted");
  EXPECT_NE(row_of_sum(1 - 2 * tolerance), "accepted");
  Builder tenths(10, 1, 0.5);
  for (State s = 0; s < 10; ++s) {
    for (State t = 0; t < 10; ++t) tenths.transition(s, 0, t, 0.1);
  }
  EXPECT_NO_THROW(std::move(tenths).build());
}

}  // namespace
}  // namespace maximin
