#include <maximin/theory/bellman.hpp>

#include <gtest/gtest.h>

#include "small_models.hpp"

namespace maximin {
namespace {

template <class Scalar>
class Bellman : public testing::Test {};
using Scalars = testing::Types<float, double, long double>;
TYPED_TEST_SUITE(Bellman, Scalars);

/// Two states, two actions, gamma = 1/2; every number a short binary fraction, so that all of this is exact.
template <class Scalar>
FiniteMdp<Scalar> model() {
  FiniteMdpBuilder<Scalar> b(2, 2, Scalar(1) / 2);
  b.reward(0, 0, 1).reward(0, 1, 2).reward(1, 0, 3).reward(1, 1, -4);
  b.transition(0, 0, 0, Scalar(1) / 4).transition(0, 0, 1, Scalar(3) / 4);
  b.transition(0, 1, 1, 1).transition(1, 0, 0, 1);
  b.transition(1, 1, 0, Scalar(1) / 2).transition(1, 1, 1, Scalar(1) / 2);
  return std::move(b).build();
}

template <class Scalar>
QTable<Scalar> table(Scalar a, Scalar b, Scalar c, Scalar d) {
  QTable<Scalar> q(2, 2);
  q << a, b, c, d;
  return q;
}

TYPED_TEST(Bellman, BackupOfStateValues) {
  using Scalar = TypeParam;
  const Values<Scalar> v{{8, 4}};
  QTable<Scalar> out;
  backup(model<Scalar>(), v, out);
  EXPECT_EQ(out, table<Scalar>(1 + 2.5, 2 + 2, 3 + 4, -4 + 3));
}

TYPED_TEST(Bellman, TheFourWaysToReadValuesOffATable) {
  using Scalar = TypeParam;
  const auto q = table<Scalar>(8, 2, -4, 6);
  Values<Scalar> v;
  greedy_values(q, v);
  EXPECT_EQ(v, (Values<Scalar>{{8, 6}}));
  policy_values(q, {1, 0}, v);
  EXPECT_EQ(v, (Values<Scalar>{{2, -4}}));
  const auto together = on_line<Scalar>({0, 1}, 1), apart = on_line<Scalar>({0, 1}, 0);
  attacked_values(q, {0, 1}, together, v);
  EXPECT_EQ(v, (Values<Scalar>{{2, -4}})) << "each state is shown as the other";
  attacked_values(q, {0, 1}, apart, v);
  EXPECT_EQ(v, (Values<Scalar>{{8, 6}}));
}

TYPED_TEST(Bellman, OperatorsByHand) {
  using Scalar = TypeParam;
  const auto mdp = model<Scalar>();
  const auto together = on_line<Scalar>({0, 1}, 1);
  const auto q = table<Scalar>(8, 2, -4, 6);
  Values<Scalar> v;
  QTable<Scalar> out;
  bellman_optimality(mdp, q, v, out);  // V = 8, 6
  EXPECT_EQ(out, table<Scalar>(1 + 1 + 2.25, 2 + 3, 3 + 4, -4 + 3.5));
  bellman_pair(mdp, {1, 0}, q, v, out);  // V = 2, -4
  EXPECT_EQ(out, table<Scalar>(1 + 0.25 - 1.5, 2 - 2, 3 + 1, -4 - 0.5));
  QTable<Scalar> robust;
  bellman_robust(mdp, {0, 1}, together, q, v, robust);  // the same V
  EXPECT_EQ(robust, out);
}

TYPED_TEST(Bellman, PessimisticUpdateByHand) {
  using Scalar = TypeParam;
  const auto mdp = model<Scalar>();
  const auto together = on_line<Scalar>({0, 1}, 1);
  PessimisticStep<Scalar> step;
  QTable<Scalar> out;
  // min over the ball: -4 for action 0, 2 for action 1; whatever is shown, action 1 is taken: V = 2, 6.
  pessimistic_update(mdp, together, table<Scalar>(8, 2, -4, 6), step, out);
  EXPECT_EQ(step.policy, (Policy{1, 1}));
  EXPECT_EQ(step.attack, (AttackPolicy{0, 0}));
  EXPECT_EQ(step.composed, (Policy{1, 1}));
  EXPECT_EQ(step.values, (Values<Scalar>{{2, 6}}));
  EXPECT_EQ(out, table<Scalar>(1 + 0.25 + 2.25, 2 + 3, 3 + 1, -4 + 2));
  pessimistic_update(mdp, together, table<Scalar>(8, 2, -4, 6), step, out, TieBreak::highest_index);
  EXPECT_EQ(step.attack, (AttackPolicy{1, 1}));
}

TYPED_TEST(Bellman, OneSidedModelIsLuredIntoTheTrap) {
  using Scalar = TypeParam;
  const auto mdp = one_sided<Scalar>();
  const auto balls = one_sided_balls<Scalar>();
  QTable<Scalar> q = QTable<Scalar>::Zero(3, 2), next;
  PessimisticStep<Scalar> step;
  pessimistic_update(mdp, balls, q, step, next);
  EXPECT_EQ(next, mdp.rewards()) << "Q_1 = R";
  for (int n = 0; n < 200; ++n) {
    pessimistic_update(mdp, balls, q, step, next);
    q.swap(next);
  }
  // The agent cannot tell 0 from 1 and always does the same; in state 1 or in state 0 that is the way to 20.
  EXPECT_EQ(step.policy[0], step.policy[1]);
  EXPECT_EQ(q(2, 0), Scalar(-40));
}

}  // namespace
}  // namespace maximin
