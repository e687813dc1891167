#include <gtest/gtest.h>

#include <maximin/theory/bellman.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/concepts.hpp>
#include <maximin/theory/lipschitz.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/rollout.hpp>

namespace maximin {
namespace {

template <class Scalar>
class Theory : public testing::Test {};
using Scalars = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Theory, Scalars);

/// The one-sided reward model: S = {0, 1, 20} on a line, R(s,a) = -x_s.
template <class Scalar>
FiniteMdp<Scalar> one_sided() {
  FiniteMdpBuilder<Scalar> b(3, 2, Scalar(1) / 2);
  const Scalar x[] = {0, 1, 20};
  for (State s = 0; s < 3; ++s) {
    for (Action a = 0; a < 2; ++a) b.reward(s, a, -x[s]);
  }
  b.transition(0, 0, 0, 1).transition(0, 1, 2, 1).transition(1, 1, 1, 1).transition(1, 0, 2, 1);
  b.transition(2, 0, 2, 1).transition(2, 1, 2, 1);
  return std::move(b).build();
}

TYPED_TEST(Theory, ConstantsOfTheOneSidedModel) {
  using Scalar = TypeParam;
  const auto mdp = one_sided<Scalar>();
  typename Metric<Scalar>::Points points(3, 1);
  points << 0, 1, 20;
  const Perturbation<Scalar> perturbation(Metric<Scalar>::from_points(points, Norm::l1), Scalar(1));
  const auto c = model_constants(mdp, perturbation.metric());
  EXPECT_EQ(c.l_r.value, Scalar(1));
  EXPECT_EQ(c.l_p.value, Scalar(1));
  EXPECT_EQ(c.k_tv.value, Scalar(1));
  EXPECT_EQ(c.r_max_signed, Scalar(0));
  EXPECT_EQ(c.r_max, Scalar(20));
  const Scalar half = Scalar(1) / 2;
  const Scalar l = bounds::lipschitz_of_q_printed(half, c.l_r.value, c.l_p.value, mdp.states(), c.r_max_signed);
  EXPECT_EQ(bounds::theorem_1(half, bounds::delta(Scalar(1), half, l)), Scalar(6));
  PessimisticStep<Scalar> step;
  QTable<Scalar> q = QTable<Scalar>::Zero(3, 2), next;
  pessimistic_update(mdp, perturbation, q, step, next);
  EXPECT_EQ(next(1, 0), Scalar(-1));
}

TEST(Philox, KnownAnswers) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

}  // namespace
}  // namespace maximin
