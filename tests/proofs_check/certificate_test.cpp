// What `certify` proves, on models worked out by hand and against the examination in floating point.

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <maximin/models/builtin_models.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>

namespace maximin {
namespace {

const CertifiedClaim& of(const Certificate& c, ClaimId id) {
  for (const CertifiedClaim& claim : c.claims) {
    if (claim.id == id) return claim;
  }
  throw std::out_of_range("no such claim");
}

Model<Rational> example(const char* name) {
  return rationalise(builtin_model(name));
}

TEST(Certify, TheOneSidedModelRefutesTheoremOneAsPrinted) {
  const Certificate c = certify(example("one-sided"), {}, {.reading = Reading::paper});
  const CertifiedClaim& theorem = of(c, ClaimId::theorem_1);
  EXPECT_EQ(theorem.verdict, Verdict::violated);
  EXPECT_EQ(theorem.left, 10);
  EXPECT_EQ(theorem.right, 6);
  EXPECT_EQ(of(c, ClaimId::a_optimal_attacker).verdict, Verdict::holds) << "A needs |R| <= R_max in either reading";
}

TEST(Certify, TheOneSidedModelKeepsTheRepairedTheorem) {
  const Certificate c = certify(example("one-sided"));
  EXPECT_FALSE(c.any(Verdict::violated));
  EXPECT_FALSE(c.any(Verdict::undetermined));
  EXPECT_EQ(of(c, ClaimId::theorem_1).left, 10);
}

TEST(Certify, TheCycleIsProved) {
  const Certificate c = certify(example("cycling"));
  ASSERT_TRUE(c.limit);
  EXPECT_EQ(c.limit->period, 3);
  EXPECT_TRUE(c.limit->all_attained());
  EXPECT_EQ(c.limit->gap, Rational(189, 10));
  // U_0, U_1 and U_2 follow from each other by the backup: one of the three equations, by hand.
  const auto& u = c.limit->orbit;
  for (std::size_t j = 0; j < 3; ++j) {
    const Rational stay = 2 + Rational(9, 10) * u[j][0];
    EXPECT_TRUE(u[(j + 1) % 3][0] == stay || u[(j + 1) % 3][0] == Rational(9, 10) * u[j][0]) << j;
  }
}

TEST(Certify, WithoutAnOrbitBoxesDecideWhatTheyCan) {
  const Certificate c = certify(example("cycling"), {}, {.max_rounds = 2});
  EXPECT_FALSE(c.limit);
  ASSERT_TRUE(c.boxes);
  EXPECT_FALSE(c.any(Verdict::undetermined));
  EXPECT_EQ(of(c, ClaimId::theorem_1).right, of(certify(example("cycling")), ClaimId::theorem_1).right);
}

/// Boxes never say that a claim is violated: what they do not show to hold is left open.
TEST(Certify, WhatBoxesDoNotDecideIsLeftOpen) {
  const Certificate c = certify(example("one-sided"), {}, {.reading = Reading::paper, .max_rounds = 1});
  EXPECT_FALSE(c.limit);
  ASSERT_TRUE(c.boxes);
  EXPECT_EQ(of(c, ClaimId::theorem_1).verdict, Verdict::undetermined);
  EXPECT_EQ(of(c, ClaimId::lemma_3).verdict, Verdict::holds) << "it speaks of the rounds that were run";
  EXPECT_EQ(of(c, ClaimId::e_test_time).verdict, Verdict::holds);
}

/// Positions of the belief game that are not listed count for the least that a value can be: the loss looks greater.
TEST(Certify, TooManyPositionsLeaveALowerBound) {
  CertifyOptions options{.only = std::set{ClaimId::f_belief}, .max_rounds = 1};
  const Certificate all = certify(example("garnet"), {}, options);
  options.max_positions = 2'000;
  const Certificate few = certify(example("garnet"), {}, options);
  ASSERT_TRUE(few.belief_game);
  EXPECT_FALSE(few.belief_game->exact);
  EXPECT_EQ(few.belief_game->positions.size(), 2'000);
  EXPECT_GT(few.claims.front().left, all.claims.front().left);
  EXPECT_LE(few.belief_game->reach, all.belief_game->reach);
  options.max_positions = 5;
  EXPECT_FALSE(certify(example("garnet"), {}, options).belief_game) << "not even the starts";
}

Model<Rational> two_loops(const Rational& first, const Rational& second, Geometry<Rational>::Kind kind, int eps) {
  FiniteMdpBuilder<Rational> b(2, 1, Rational(1, 2));
  b.reward(0, 0, first).transition(0, 0, 0, 1).reward(1, 0, second).transition(1, 0, 1, 1);
  Model<Rational> model{std::move(b).build()};
  model.geometry.kind = kind;
  model.geometry.eps = eps;
  return model;
}

/// Whatever eps is: in exact arithmetic, no path was |S| hops.
TEST(Certify, NoBallReachesWhereNoPathLeads) {
  const auto model = two_loops(1, 2, Geometry<Rational>::Kind::hops, 5);
  EXPECT_EQ(ExactGeometry(model).balls().largest_ball(), 1);
  const Certificate c = certify(model);
  EXPECT_FALSE(c.any(Verdict::violated));
  EXPECT_FALSE(c.any(Verdict::undetermined));
}

TEST(Certify, ValuesBeyondFloatingPointAreNoTrouble) {
  const Rational huge = decimal(1e308);
  const Certificate c = certify(two_loops(huge, -huge, Geometry<Rational>::Kind::discrete, 1));
  EXPECT_FALSE(c.any(Verdict::violated));
  EXPECT_EQ(of(c, ClaimId::e_test_time).verdict, Verdict::holds);
  EXPECT_EQ(of(c, ClaimId::f_belief).verdict, Verdict::holds);
}

/// The page has it so: what needs the limit is undetermined without it, even where a round refutes it.
TEST(Certify, SaysNothingOfAClaimWhoseLimitIsUnknown) {
  const Certificate c =
      certify(two_loops(decimal(1e308) * 10, -decimal(1e308) * 10, Geometry<Rational>::Kind::discrete, 1), {},
              {.reading = Reading::paper, .max_rounds = 1});
  EXPECT_FALSE(c.limit);
  EXPECT_FALSE(c.boxes) << "floating point cannot propose any";
  EXPECT_EQ(of(c, ClaimId::lemma_1).verdict, Verdict::undetermined);
}

/// An absorbing state is in every ball and all its actions are one: the tie at every observation is for ever, and the
/// index decides it.
TEST(Certify, TiesForEverAreSettledByTheIndex) {
  FiniteMdpBuilder<Rational> b(2, 2, Rational(9, 10));
  b.reward(0, 0, 1).transition(0, 0, 0, 1).reward(0, 1, 2).transition(0, 1, 0, 1);
  b.transition(1, 0, 1, 1).transition(1, 1, 1, 1);
  Model<Rational> model{std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = 1;
  for (const auto& [tie, gap] : {std::pair(TieBreak::lowest_index, 9), std::pair(TieBreak::highest_index, 0)}) {
    const Certificate c = certify(model, {}, {.tie = tie});
    ASSERT_TRUE(c.limit);
    EXPECT_TRUE(c.limit->all_attained());
    EXPECT_EQ(c.limit->classes(1, 0), c.limit->classes(1, 1));
    EXPECT_NE(c.limit->classes(0, 0), c.limit->classes(0, 1));
    EXPECT_EQ(c.limit->gap, gap);
  }
}

TEST(Certify, WithoutACommonLipschitzConstantTheAssumptionIsNamed) {
  FiniteMdpBuilder<Rational> b(2, 1, Rational(1, 2));
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(1, 0, 1);
  Model<Rational> model{std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::points;
  model.geometry.points.resize(2, 1);
  model.geometry.points << Rational(1), Rational(1);
  model.geometry.norm = Norm::l1;
  model.geometry.eps = 1;
  EXPECT_THROW(certify(model), AssumptionFails);
  EXPECT_EQ(examine_exactly(model, {}, {}).check(ClaimId::theorem_1).verdict, Verdict::assumption_fails);
}

/// What is proved is what floating point finds, claim by claim.
TEST(Certify, AgreesWithTheExaminationInFloatingPoint) {
  FamilyOptions small;
  small.states = Range<State>{3, 12};
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    Stream rng(11, trial);
    const Model<double> model = coarsen(draw_family_member(family_named("mixed"), small, rng).model);
    const Examination seen = examine(model.mdp, make_perturbation(model));
    const Examination proved = examine_exactly(rationalise(model), {}, {});
    EXPECT_NEAR(proved.lipschitz_of_q_star, seen.lipschitz_of_q_star, 1e-9 * (1 + seen.lipschitz_of_q_star));
    EXPECT_EQ(proved.fate, seen.fate) << trial;
    EXPECT_EQ(proved.period, seen.period) << trial;
    for (const ClaimId id : {ClaimId::theorem_1, ClaimId::a_optimal_attacker, ClaimId::b_one_sided,
                             ClaimId::e_test_time, ClaimId::f_belief}) {
      const Check &x = proved.check(id), &y = seen.check(id);
      ASSERT_EQ(x.verdict, y.verdict) << claim(id).name << " on trial " << trial;
      EXPECT_NEAR(x.left, y.left, 1e-7 * (1 + std::abs(y.left))) << claim(id).name << " on trial " << trial;
      EXPECT_NEAR(x.right, y.right, 1e-9 * (1 + std::abs(y.right))) << claim(id).name << " on trial " << trial;
    }
  }
}

TEST(Certify, IsJsonWithExactNumbers) {
  const auto json =
      nlohmann::json::parse(certificate_json(certify(example("one-sided"), {}, {.reading = Reading::paper})));
  EXPECT_EQ(json["format"], "maximin-certificate");
  EXPECT_EQ(json["model"]["discount"], "1/2");
  EXPECT_EQ(json["claims"][4]["claim"], "theorem-1");
  EXPECT_EQ(json["claims"][4]["left"], "10");
  EXPECT_EQ(json["claims"][4]["right"], "6");
}

TEST(ExactGeometry, RootsLieBetweenNeighbouringMultiples) {
  FiniteMdpBuilder<Rational> b(3, 1, Rational(1, 2));
  for (State s = 0; s < 3; ++s) b.transition(s, 0, s, 1);
  Model<Rational> model{std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::points;
  model.geometry.points.resize(3, 2);
  model.geometry.points << Rational(0), Rational(0), Rational(3), Rational(4), Rational(1), Rational(1);
  model.geometry.norm = Norm::l2;
  model.geometry.eps = 5;
  const ExactGeometry g(model);
  EXPECT_FALSE(g.exact());
  EXPECT_EQ(g.lower(0, 1), 5);
  EXPECT_EQ(g.upper(0, 1), 5);
  EXPECT_LT(g.lower(0, 2) * g.lower(0, 2), 2);
  EXPECT_GT(g.upper(0, 2) * g.upper(0, 2), 2);
  EXPECT_EQ(g.upper(0, 2) - g.lower(0, 2), Rational(1, Integer(1) << 64));
  EXPECT_TRUE(g.balls().contains(0, 1)) << "the ball is closed, and 3, 4, 5 is exact";
}

TEST(Rationalise, ReadsDecimalsAsTheyAreMeant) {
  EXPECT_EQ(decimal(0.1), Rational(1, 10));
  EXPECT_EQ(decimal(-2.5e-3), Rational(-1, 400));
  EXPECT_EQ(decimal(1.0 / 4096), Rational(1, 4096));
}

TEST(Rationalise, CoarseModelsHaveShortNumbersAndRowsThatSumToOne) {
  Stream rng(5, 0);
  const Model<double> coarse = coarsen(draw_family_member(family_named("broad"), {}, rng).model);
  const Model<Rational> model = rationalise(coarse);
  for (State s = 0; s < model.mdp.states(); ++s) {
    for (Action a = 0; a < model.mdp.actions(); ++a) {
      EXPECT_EQ(1000 % denominator(model.mdp.reward(s, a)), 0);
      Rational sum(0);
      for (const auto& next : model.mdp.successors(s, a)) {
        EXPECT_EQ(4096 % denominator(next.probability), 0);
        sum += next.probability;
      }
      EXPECT_EQ(sum, 1);
    }
  }
}

}  // namespace
}  // namespace maximin
