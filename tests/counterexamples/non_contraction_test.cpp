#include <gtest/gtest.h>

#include <cmath>

#include <maximin/counterexamples/non_contraction.hpp>

namespace maximin::non_contraction {
namespace {

class BothTieBreaks : public testing::TestWithParam<TieBreak> {};
INSTANTIATE_TEST_SUITE_P(NonContraction, BothTieBreaks,
                         testing::Values(TieBreak::lowest_index, TieBreak::highest_index));

TEST_P(BothTieBreaks, TheNumbersOfThePaper) {
  const auto e = examine(0.95, GetParam());
  EXPECT_EQ(e.distance_before, 10);
  EXPECT_NEAR(e.distance_after, 11 * 0.95, 1e-14);
  EXPECT_EQ(e.first.step.policy, (Policy{0, 0, 0})) << "a1 whatever is seen";
  EXPECT_EQ(e.second.step.policy, (Policy{1, 1, 1})) << "a2 whatever is seen";
  EXPECT_EQ(e.first.step.values[1], 11);
  EXPECT_EQ(e.second.step.values[1], 0);
  // The largest of |Q1 - Q2| is at (s2, a2).
  EXPECT_EQ(e.first.q(1, 1) - e.second.q(1, 1), 10);
}

TEST_P(BothTieBreaks, TheThresholdIsTenElevenths) {
  const auto exact = exact_distances(GetParam());
  EXPECT_EQ(exact.before, 10);
  EXPECT_EQ(exact.after_per_gamma, 11);
  EXPECT_EQ(exact.threshold(), Fraction(10, 11));
  EXPECT_FALSE(exact.expands(Fraction(10, 11))) << "at the threshold the distance stays";
  EXPECT_EQ(exact.after(Fraction(10, 11)), Fraction(10));
  constexpr std::int64_t fine = 1'000'000'000'000;
  EXPECT_TRUE(exact.expands(Fraction(10, 11) + Fraction(1, 11 * fine)));
  EXPECT_FALSE(exact.expands(Fraction(10, 11) - Fraction(1, 11 * fine)));
  EXPECT_TRUE(exact.expands(Fraction(99, 100)));
  EXPECT_FALSE(exact.expands(Fraction(0)));
}

TEST(NonContraction, BothArithmeticsAgree) {
  const auto exact = exact_distances();
  for (int percent = 0; percent < 100; ++percent) {
    const auto e = examine(percent / 100.0);
    const Fraction gamma(percent, 100);
    EXPECT_NEAR(e.distance_after, boost::rational_cast<double>(exact.after(gamma)), 1e-14);
    EXPECT_EQ(e.distance_after > e.distance_before, exact.expands(gamma)) << percent;
    EXPECT_EQ(exact.expands(gamma), percent >= 91) << percent;
  }
}

/// What the counterexample turns on: with the pair of either side held fixed the operator is a contraction.
TEST(NonContraction, AFixedPairContracts) {
  const double gamma = 0.95;
  const auto e = examine(gamma);
  const auto mdp = model(gamma);
  for (const auto* side : {&e.first, &e.second}) {
    Values<double> v;
    QTable<double> t1, t2;
    bellman_pair(mdp, side->step.composed, e.first.q, v, t1);
    bellman_pair(mdp, side->step.composed, e.second.q, v, t2);
    EXPECT_LE((t1 - t2).cwiseAbs().maxCoeff(), gamma * e.distance_before);
  }
}

TEST(NonContraction, WithoutAttackItContracts) {
  // Negative control: the same tables under balls of one state each.
  const Perturbation<double> trivial(Metric<double>::discrete(3), 0);
  PessimisticStep<double> step;
  QTable<double> t1, t2;
  pessimistic_update(model(0.99), trivial, q1<double>(), step, t1);
  pessimistic_update(model(0.99), trivial, q2<double>(), step, t2);
  EXPECT_LE((t1 - t2).cwiseAbs().maxCoeff(), 0.99 * 10);
}

TEST(NonContraction, RefusesADiscountOutOfRange) {
  EXPECT_THROW(examine(1), InputError);
  EXPECT_THROW(examine(-0.1), InputError);
  EXPECT_THROW(examine(NAN), InputError);
}

}  // namespace
}  // namespace maximin::non_contraction
