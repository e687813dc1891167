#include <maximin/theory/lipschitz.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <maximin/theory/random.hpp>

#include "small_models.hpp"

namespace maximin {
namespace {

template <class Scalar>
class Lipschitz : public testing::Test {};
using Scalars = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Lipschitz, Scalars);

TYPED_TEST(Lipschitz, ConstantsOfTheOneSidedModel) {
  using Scalar = TypeParam;
  const auto c = model_constants(one_sided<Scalar>(), one_sided_balls<Scalar>().metric());
  EXPECT_EQ(c.l_r.value, Scalar(1));
  EXPECT_EQ(c.l_p.value, Scalar(1));
  EXPECT_EQ(c.k_tv.value, Scalar(1));
  EXPECT_EQ(c.r_min, Scalar(-20));
  EXPECT_EQ(c.r_max_signed, Scalar(0));
  EXPECT_EQ(c.r_max, Scalar(20));
  EXPECT_EQ(c.span, Scalar(20));
  EXPECT_TRUE(c.finite());
}

/// Four successors, none shared in full: the constants and who attains them, by hand.
TEST(Lipschitz, ConstantsWithTheirWitnessesByHand) {
  FiniteMdpBuilder<double> b(3, 2, 0.5);
  for (State s = 0; s < 3; ++s) b.transition(s, 0, 0, 1);
  b.transition(0, 1, 0, 0.5).transition(0, 1, 1, 0.5);
  b.transition(1, 1, 1, 0.25).transition(1, 1, 2, 0.75);
  b.transition(2, 1, 2, 1);
  b.reward(0, 0, 1).reward(1, 0, 2).reward(2, 0, 3).reward(0, 1, 0).reward(1, 1, 3).reward(2, 1, -5);
  const auto mdp = std::move(b).build();
  const auto c = model_constants(mdp, on_line<double>({0, 2, 6}, 1).metric());
  // Action 1: rewards differ by 3 over 2, 8 over 4, 5 over 6.
  EXPECT_EQ(c.l_r.value, 2);
  EXPECT_EQ(c.l_r.s1, 1);
  EXPECT_EQ(c.l_r.s2, 2);
  EXPECT_EQ(c.l_r.action, 1);
  // Rows of states 0 and 1 differ by 1/2, 1/4, 3/4 over a distance of 2.
  EXPECT_EQ(c.l_p.value, 0.375);
  EXPECT_EQ(c.l_p.s1, 0);
  EXPECT_EQ(c.l_p.s2, 1);
  EXPECT_EQ(c.l_p.action, 1);
  EXPECT_EQ(c.l_p.target, 2);
  EXPECT_EQ(c.k_tv.value, 0.375) << "half of 3/2, over 2";
  EXPECT_EQ(c.k_tv.s1, 0);
  EXPECT_EQ(c.k_tv.s2, 1);
  EXPECT_EQ(c.r_max, 5);
  EXPECT_EQ(c.r_max_signed, 3);
  EXPECT_EQ(c.span, 8);
}

TEST(Lipschitz, AConstantFunctionHasConstantZero) {
  const auto metric = on_line<double>({0, 1, 3}, 1).metric();
  const auto c = lipschitz_constant(QTable<double>(QTable<double>::Constant(3, 2, 7.0)), metric);
  EXPECT_EQ(c.value, 0);
  EXPECT_FALSE(c.infinite);
  EXPECT_EQ(c.s1, c.s2);
}

TEST(Lipschitz, TwinsMustAgree) {
  const auto twins = on_line<double>({0, 1, 1}, 1).metric();
  QTable<double> q(3, 2);
  q << 0, 0, 5, 2, 5, 2;
  const auto agree = lipschitz_constant(q, twins);
  EXPECT_FALSE(agree.infinite);
  EXPECT_EQ(agree.value, 5);
  q(2, 1) = 2.5;
  const auto differ = lipschitz_constant(q, twins);
  EXPECT_TRUE(differ.infinite);
  EXPECT_EQ(differ.s1, 1);
  EXPECT_EQ(differ.s2, 2);
  EXPECT_EQ(differ.action, 1);

  FiniteMdpBuilder<double> b(3, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).transition(2, 0, 2, 1);
  const auto c = model_constants(std::move(b).build(), twins);
  EXPECT_FALSE(c.l_r.infinite);
  EXPECT_TRUE(c.l_p.infinite);
  EXPECT_TRUE(c.k_tv.infinite);
  EXPECT_FALSE(c.finite());
}

TEST(Lipschitz, StatesInfinitelyFarApartAskForNothing) {
  const double inf = std::numeric_limits<double>::infinity();
  QTable<double> d(3, 3), q(3, 1);
  d << 0, 2, inf, 2, 0, inf, inf, inf, 0;
  q << 0, 1, 1000;
  const auto metric = Metric<double>::from_distances(d);
  EXPECT_TRUE(metric.finite(0, 1));
  EXPECT_FALSE(metric.finite(0, 2));
  const auto c = lipschitz_constant(q, metric);
  EXPECT_FALSE(c.infinite);
  EXPECT_EQ(c.value, 0.5);
}

/// Against the definition, on dense rows built without the library's merge of sparse ones.
TEST(Lipschitz, SparseRowsGiveWhatDenseOnesWould) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Stream rng(4, trial);
    const State n = rng.integer(2, 6);
    std::vector<double> x;
    for (State s = 0; s < n; ++s) x.push_back(s + rng.uniform(0, 0.5));
    const auto metric = on_line(x, 1.0).metric();
    QTable<double> dense = QTable<double>::Zero(n, n);
    FiniteMdpBuilder<double> b(n, 1, 0.5);
    for (State s = 0; s < n; ++s) {
      for (int quarter = 0; quarter < 4; ++quarter) dense(s, rng.below(n)) += 0.25;
      for (State t = 0; t < n; ++t) b.transition(s, 0, t, dense(s, t));
    }
    double l_p = 0, k = 0;
    for (State s = 0; s < n; ++s) {
      for (State t = 0; t < s; ++t) {
        const auto difference = (dense.row(s) - dense.row(t)).cwiseAbs();
        l_p = std::max(l_p, difference.maxCoeff() / metric.distance(s, t));
        k = std::max(k, difference.sum() / 2 / metric.distance(s, t));
      }
    }
    const auto c = model_constants(std::move(b).build(), metric);
    EXPECT_DOUBLE_EQ(c.l_p.value, l_p);
    EXPECT_DOUBLE_EQ(c.k_tv.value, k);
    EXPECT_LE(c.k_tv.value, n * c.l_p.value / 2) << "strengthening D: never worse than |S| l_p";
  }
}

}  // namespace
}  // namespace maximin
