// Enclosures of pessimistic Q-iteration and of values, against what exact arithmetic finds.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <vector>

#include <maximin/models/builtin_models.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/boxes.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bellman.hpp>

namespace maximin {
namespace {

/// One model, in rationals, and its enclosures.
struct Enclosed {
  explicit Enclosed(Model<Rational> of, TieBreak wins = TieBreak::lowest_index)
      : model(std::move(of)),
        balls(make_perturbation(model)),
        scaled(model.mdp),
        tie(wins),
        options{.tie = wins},
        boxes(model.mdp, balls, scaled, options) {}

  Model<Rational> model;
  Perturbation<Rational> balls;
  ScaledMdp scaled;
  TieBreak tie;
  CertifyOptions options;
  Boxes boxes;
};

Model<Rational> random_model(std::uint64_t trial) {
  FamilyOptions small;
  small.states = Range<State>{3, 9};
  Stream rng(29, trial);
  Model<double> model = coarsen(draw_family_member(family_named("mixed"), small, rng).model);
  model.geometry.norm = Norm::linf;
  return rationalise(model);
}

bool contains(const std::vector<Action>& list, Action a) {
  return std::find(list.begin(), list.end(), a) != list.end();
}

/// Q_n, the policies and what is passed up lie in the boxes.
void expect_inside(const RoundBox& box, const QTable<Rational>& q, const PessimisticStep<Rational>& step,
                   const Grid& grid) {
  for (State s = 0; s < q.rows(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    for (Action a = 0; a < q.cols(); ++a) {
      EXPECT_LE(Rational(box.q.low(s, a), box.denominator), q(s, a));
      EXPECT_GE(Rational(box.q.high(s, a), box.denominator), q(s, a));
    }
    EXPECT_TRUE(contains(box.choices[i], step.policy[i]));
    const Action done = step.composed[i];
    EXPECT_TRUE(contains(box.provoked[i], done));
    EXPECT_LE(Rational(box.passed.low.numerators[i], grid.denominator()), q(s, done));
    EXPECT_GE(Rational(box.passed.high.numerators[i], grid.denominator()), q(s, done));
  }
}

TEST(Boxes, HoldTheRoundsOfPessimisticQIterationAndItsLimit) {
  int found = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    const Enclosed x(random_model(trial), trial % 2 == 0 ? TieBreak::lowest_index : TieBreak::highest_index);
    constexpr int rounds = 30, later = 60;
    RoundBox box = x.boxes.first_round();
    std::optional<BoxLimit> limit;
    QTable<Rational> q = QTable<Rational>::Constant(x.model.mdp.states(), x.model.mdp.actions(), Rational(0)), next;
    PessimisticStep<Rational> step;
    for (int n = 0; n < later; ++n) {
      SCOPED_TRACE(testing::Message() << "trial " << trial << ", round " << n);
      pessimistic_update(x.model.mdp, x.balls, q, step, next, x.tie);
      if (n < rounds) {
        expect_inside(box, q, step, x.boxes.grid());
        if (n == rounds - 1) limit = x.boxes.limit_after(box.passed, 1 + static_cast<long>(trial % 3));
        box = x.boxes.round_after(box.passed);
      } else if (limit) {
        expect_inside(limit->phases[static_cast<std::size_t>(n - rounds) % limit->phases.size()], q, step,
                      x.boxes.grid());
      }
      std::swap(q, next);
    }
    found += limit.has_value();
  }
  EXPECT_GE(found, 38);
}

TEST(Boxes, EncloseValuesOnBothSides) {
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    const Enclosed x(random_model(trial));
    const auto optimal = policy_iteration(x.model.mdp);
    const ValueBox v = x.boxes.enclose_optimal();
    Policy policy;
    std::vector<Rational> scratch;
    maximin_policy(optimal.q, x.balls, policy, scratch, MinAggregator{}, x.tie);
    Choices choices;
    for (const Action a : policy) choices.push_back({a});
    Choices provoked(choices.size());
    for (State s = 0; s < x.model.mdp.states(); ++s) {
      for (const State t : x.balls.ball(s))
        provoked[static_cast<std::size_t>(s)].push_back(policy[static_cast<std::size_t>(t)]);
    }
    const auto robust = evaluate_against_optimal_attack(x.model.mdp, x.balls, policy);
    const PairBox pair = x.boxes.enclose_pair(choices, provoked);
    for (State s = 0; s < x.model.mdp.states(); ++s) {
      EXPECT_LE(v.low[s], optimal.v[s]);
      EXPECT_GE(v.high[s], optimal.v[s]);
      EXPECT_LT(v.high[s] - v.low[s], Rational(1, 1'000'000));
      EXPECT_LE(pair.below[s], robust.v[s]);
      EXPECT_LT(robust.v[s] - pair.below[s], Rational(1, 1'000'000));
      EXPECT_GE(pair.above[s], robust.v[s]);
    }
  }
}

/// A tie that only differences which vanish decide: the box takes in both ways, and their backups.
TEST(Boxes, ATieThatVanishesLeavesBothChoices) {
  const Enclosed x(rationalise(builtin_model("grid")));
  RoundBox box = x.boxes.first_round();
  for (int n = 1; n < 200; ++n) box = x.boxes.round_after(box.passed);
  const auto limit = x.boxes.limit_after(box.passed, 1);
  ASSERT_TRUE(limit);
  const auto several = [](const std::vector<Action>& list) { return list.size() > 1; };
  EXPECT_TRUE(std::any_of(limit->phases.front().choices.begin(), limit->phases.front().choices.end(), several));
}

TEST(Boxes, CandidatesAreThoseThatNothingIsSureToBeat) {
  TableBox<Integer> q{QTable<Integer>(1, 4), QTable<Integer>(1, 4)};
  q.low << 0, 3, 5, 5;
  q.high << 4, 5, 5, 5;
  const State only = 0;
  const std::span<const State> belief(&only, 1);
  EXPECT_EQ(candidates(q, belief, TieBreak::lowest_index), (std::vector<Action>{1, 2}));
  EXPECT_EQ(candidates(q, belief, TieBreak::highest_index), (std::vector<Action>{3}));
}

}  // namespace
}  // namespace maximin
