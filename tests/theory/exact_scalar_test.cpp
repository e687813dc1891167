// The templates on an exact scalar: no rounding, no slack, one third is one third.

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_int.hpp>
#include <boost/multiprecision/eigen.hpp>

#include <maximin/theory/bellman.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

#include "small_models.hpp"

namespace maximin {
namespace {

using Exact = boost::multiprecision::number<boost::multiprecision::cpp_rational_backend, boost::multiprecision::et_off>;
static_assert(is_exact_v<Exact>);

const Exact third = Exact(1) / 3;
const Exact tiny = Exact(1) / Exact(boost::multiprecision::pow(boost::multiprecision::cpp_int(10), 100));

TEST(ExactScalar, RowsSumToOneExactly) {
  FiniteMdpBuilder<Exact> thirds(3, 1, third);
  for (State s = 0; s < 3; ++s) {
    for (State t = 0; t < 3; ++t) thirds.transition(s, 0, t, third);
  }
  EXPECT_NO_THROW(std::move(thirds).build());
  FiniteMdpBuilder<Exact> off(1, 1, third);
  off.transition(0, 0, 0, 1 - tiny);
  EXPECT_EQ(complaint([&] { std::move(off).build(); }),
            "transition (state 0, action 0): probabilities sum to 1.000000, expected 1");
}

TEST(ExactScalar, BallsAreClosedExactly) {
  const Exact tenth = Exact(1) / 10;
  EXPECT_TRUE(on_line<Exact>({3 * tenth, 2 * tenth}, tenth).contains(0, 1));
  EXPECT_FALSE(on_line<Exact>({3 * tenth + tiny, 2 * tenth}, tenth).contains(0, 1));
  EXPECT_EQ(on_line<Exact>({3 * tenth, 2 * tenth}, tenth).radius(), tenth);
}

TEST(ExactScalar, RefusesTheEuclideanNorm) {
  const auto metric = Metric<Exact>::from_points(Metric<Exact>::Points::Zero(2, 1), Norm::l2);
  EXPECT_EQ(complaint([&] { metric.distance(0, 1); }),
            "norm: l2 distances are not rational, expected l1 or linf with exact arithmetic");
}

TEST(ExactScalar, IslandsAreFartherThanAnyPath) {
  const auto balls = Perturbation<Exact>::from_neighbourhoods({{0, 1}, {0, 1}, {2}});
  EXPECT_EQ(balls.metric().distance(0, 2), 3);
  EXPECT_FALSE(balls.contains(0, 2));
}

TEST(ExactScalar, OneSidedModelHasGapTenAndPrintedBoundSix) {
  const auto mdp = one_sided<Exact>();
  const auto balls = one_sided_balls<Exact>();
  const auto c = model_constants(mdp, balls.metric());
  const Exact half = mdp.discount();
  const Exact l = bounds::lipschitz_of_q_printed(half, c.l_r.value, c.l_p.value, mdp.states(), c.r_max_signed);
  EXPECT_EQ(bounds::theorem_1(half, bounds::delta(balls.radius(), half, l)), 6);

  // Q_n after 40 rounds lies within 40/2^40 of its limit, and so does Q*: the gap is 10 to that.
  QTable<Exact> q = QTable<Exact>::Constant(3, 2, Exact(0)), best = q, next;
  PessimisticStep<Exact> step;
  Values<Exact> v;
  for (int n = 0; n < 40; ++n) {
    pessimistic_update(mdp, balls, q, step, next);
    q.swap(next);
    bellman_optimality(mdp, best, v, next);
    best.swap(next);
  }
  Exact gap(0);
  for (State s = 0; s < 3; ++s) {
    for (Action a = 0; a < 2; ++a) gap = std::max(gap, Exact(best(s, a) - q(s, a)));
  }
  const Exact left_over = Exact(80) / Exact(boost::multiprecision::pow(boost::multiprecision::cpp_int(2), 40));
  EXPECT_LE(gap, 10 + left_over);
  EXPECT_GE(gap, 10 - left_over);
}

}  // namespace
}  // namespace maximin
