#include <maximin/theory/bounds.hpp>

#include <gtest/gtest.h>

#include <cmath>

#include <maximin/theory/lipschitz.hpp>

#include "small_models.hpp"

namespace maximin {
namespace {

template <class Scalar>
class Bounds : public testing::Test {};
using Scalars = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Bounds, Scalars);

/// Every formula with numbers that keep it exact: gamma = 1/2, l_r = 3, l_p = 1/4, K = 1/2, |S| = 8, R_max = 5,
/// span = 6, eps = 2.
TYPED_TEST(Bounds, ByHand) {
  using Scalar = TypeParam;
  const Scalar half = Scalar(1) / 2, quarter = Scalar(1) / 4;
  EXPECT_EQ(bounds::lipschitz_of_q_printed<Scalar>(half, 3, quarter, 8, 5), Scalar(23)) << "3 + 8/4 * 10";
  EXPECT_EQ(bounds::lipschitz_of_q<Scalar>(half, 3, quarter, 8, 5), Scalar(13)) << "3 + 1/2 * 8/4 * 10";
  EXPECT_EQ(bounds::lipschitz_of_q_tv<Scalar>(half, 3, half, 6), Scalar(6)) << "3 + 1/2 * 1/2 * 12";
  EXPECT_EQ(bounds::delta<Scalar>(2, half, 13), Scalar(26)) << "2 * 2 * 1/2 * 13";
  EXPECT_EQ(bounds::theorem_1<Scalar>(half, 26), Scalar(156)) << "(3/2) / (1/4) * 26";
  EXPECT_EQ(bounds::theorem_1_one_sided<Scalar>(half, 26), Scalar(104)) << "4 * 26";
  EXPECT_EQ(bounds::test_time_pessimism<Scalar>(2, half, 13), Scalar(52)) << "26 / (1/2)";
  EXPECT_EQ(bounds::belief<Scalar>(4, half, 13), Scalar(104)) << "4 * 13 / (1/2)";
  EXPECT_EQ(bounds::trivial<Scalar>(half, 6), Scalar(6));
}

TYPED_TEST(Bounds, FiniteNByHandAndInTheLimit) {
  using Scalar = TypeParam;
  const Scalar half = Scalar(1) / 2;
  // gamma = 1/2, Delta = 8, d_0 = 3, u_0 = 1:
  EXPECT_EQ(bounds::finite_n<Scalar>(half, 8, 3, 1, 0), Scalar(20)) << "[ (1/2)(4) + 8 ] * 2";
  EXPECT_EQ(bounds::finite_n<Scalar>(half, 8, 3, 1, 1), Scalar(26)) << "[ (1/2)(2 + 8) + 8 ] * 2";
  EXPECT_EQ(bounds::finite_n<Scalar>(half, 8, 3, 1, 2), Scalar(29)) << "[ (1/2)(1 + 8 * 3/2) + 8 ] * 2";
  EXPECT_EQ(bounds::finite_n<Scalar>(half, 8, 3, 1, 10'000), bounds::theorem_1_one_sided<Scalar>(half, 8))
      << "what is left in the limit is strengthening B";
  EXPECT_EQ(bounds::finite_n<Scalar>(Scalar(0), 0, 5, 5, 0), Scalar(0)) << "gamma = 0: nothing to lose later";
}

TEST(Bounds, Powers) {
  for (const double gamma : {0.0, 0.25, 0.9, 0.999}) {
    EXPECT_EQ(bounds::power(gamma, 0), 1);
    EXPECT_EQ(bounds::power(gamma, 1), gamma);
    for (const long n : {2L, 3L, 7L, 64L, 1000L}) {
      const double expected = std::pow(gamma, static_cast<double>(n));
      EXPECT_NEAR(bounds::power(gamma, n), expected, 1e-13 * expected);
    }
  }
}

TEST(Bounds, OneSidedModelAsPrintedGivesSix) {
  const auto mdp = one_sided<double>();
  const auto balls = one_sided_balls<double>();
  const auto c = model_constants(mdp, balls.metric());
  const double gamma = mdp.discount();
  const auto theorem = [&](double r_max) {
    const double l = bounds::lipschitz_of_q_printed(gamma, c.l_r.value, c.l_p.value, mdp.states(), r_max);
    return bounds::theorem_1(gamma, bounds::delta(balls.radius(), gamma, l));
  };
  EXPECT_EQ(theorem(c.r_max_signed), 6) << "R <= R_max";
  EXPECT_EQ(theorem(c.r_max), 6 * (1 + 3 * 40)) << "|R| <= R_max";
}

/// Each strengthening is one: never larger than what it replaces.
TEST(Bounds, StrengtheningsAreOrdered) {
  for (const double gamma : {0.0, 0.3, 0.9, 0.99}) {
    const double printed = bounds::lipschitz_of_q_printed(gamma, 1.0, 0.5, 10, 2.0);
    const double repaired = bounds::lipschitz_of_q(gamma, 1.0, 0.5, 10, 2.0);
    const double tv = bounds::lipschitz_of_q_tv(gamma, 1.0, 10 * 0.5 / 2, 4.0);
    EXPECT_LE(repaired, printed);
    EXPECT_DOUBLE_EQ(tv, repaired)
        << "at worst: with K at its largest, |S| l_p / 2, and span(R) at its largest, 2 R_max";
    const double delta = bounds::delta(0.1, gamma, repaired);
    EXPECT_LE(bounds::theorem_1_one_sided(gamma, delta), bounds::theorem_1(gamma, delta));
    EXPECT_LE(bounds::test_time_pessimism(0.1, gamma, repaired), bounds::theorem_1_one_sided(gamma, delta));
  }
}

}  // namespace
}  // namespace maximin
