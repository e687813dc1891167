// Certificates by bounds, against exact ones and against the checker, which shares no code with what writes them.

#include <gtest/gtest.h>

#include <map>

#include <maximin/models/builtin_models.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/proofs_check/certificate/bounds_certificate.hpp>
#include <maximin/proofs_check/certificate/exact_examination.hpp>
#include <maximin/proofs_check/checker/checker.hpp>
#include <maximin/proofs_check/trial_record.hpp>

namespace maximin {
namespace {

Model<Rational> random_model(std::uint64_t trial) {
  FamilyOptions small;
  small.states = Range<State>{3, 10};
  Stream rng(31, trial);
  return rationalise(coarsen(draw_family_member(family_named("mixed"), small, rng).model));
}

CertifyOptions some_options(std::uint64_t trial) {
  return {.reading = trial % 3 == 0 ? Reading::paper : Reading::corrected,
          .tie = trial % 2 == 0 ? TieBreak::lowest_index : TieBreak::highest_index,
          .max_positions = 500};
}

/// What holds by bounds holds; the sides of claims that have one place of least slack are on the safe side of it.
TEST(CertifyByBounds, SaysNothingThatExactArithmeticDenies) {
  int decided = 0, claims = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    const Model<Rational> model = random_model(trial);
    std::map<ClaimId, CertifiedClaim> exact;
    for (const CertifiedClaim& c : certify(model, {}, some_options(trial)).claims) exact[c.id] = c;
    const BoundsCertificate by_bounds = certify_by_bounds(model, {}, some_options(trial));
    EXPECT_FALSE(by_bounds.any(Verdict::violated));
    for (const CertifiedClaim& c : by_bounds.claims) {
      ++claims;
      if (c.verdict == Verdict::undetermined) continue;
      ++decided;
      const CertifiedClaim& truth = exact.at(c.id);
      EXPECT_EQ(truth.verdict, Verdict::holds) << claim(c.id).name;
      if (c.id == ClaimId::e_test_time || c.id == ClaimId::theorem_1 || c.id == ClaimId::a_optimal_attacker) {
        EXPECT_GE(c.left, truth.left) << claim(c.id).name;
      }
      if (c.id != ClaimId::lemma_1 && c.id != ClaimId::lemma_1_iterates && c.n < 0) {
        EXPECT_LE(c.right, truth.right);
      }
    }
  }
  EXPECT_GE(decided, claims * 95 / 100);
}

TEST(CertifyByBounds, IsAcceptedByTheChecker) {
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    const BoundsCertificate made = certify_by_bounds(random_model(trial), {}, some_options(trial));
    const checker::Report report = checker::check(certificate_json(made));
    EXPECT_TRUE(report.bounds);
    ASSERT_EQ(report.claims.size(), made.claims.size());
    for (std::size_t i = 0; i < made.claims.size(); ++i) {
      EXPECT_EQ(report.claims[i].verdict, to_string(made.claims[i].verdict));
    }
  }
}

/// Boxes in the place of an orbit, in exact certificates.
TEST(CertifyByBounds, BoxesOfExactCertificatesAreAcceptedByTheChecker) {
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    SCOPED_TRACE(testing::Message() << "trial " << trial);
    CertifyOptions options = some_options(trial);
    options.max_rounds = 1 + static_cast<long>(trial % 7);
    options.max_positions = 40;
    const Certificate made = certify(random_model(trial), {}, options);
    const checker::Report report = checker::check(certificate_json(made));
    EXPECT_EQ(report.boxes, made.boxes.has_value());
    for (std::size_t i = 0; i < made.claims.size(); ++i) {
      EXPECT_EQ(report.claims[i].verdict, to_string(made.claims[i].verdict));
    }
  }
}

TEST(CertifyByBounds, LeavesAFalseClaimOpen) {
  const BoundsCertificate c =
      certify_by_bounds(rationalise(builtin_model("one-sided")), {}, {.reading = Reading::paper});
  for (const CertifiedClaim& claim : c.claims) {
    const bool is_false =
        claim.id == ClaimId::theorem_1 || claim.id == ClaimId::lemma_1 || claim.id == ClaimId::lemma_2;
    EXPECT_EQ(claim.verdict, is_false ? Verdict::undetermined : Verdict::holds) << static_cast<int>(claim.id);
  }
}

/// Distances and quotients that floating point takes for 0 and infinity are neither.
TEST(CertifyByBounds, TakesNoConstantForInfiniteThatIsNot) {
  FiniteMdpBuilder<Rational> b(2, 1, Rational(1, 2));
  b.reward(0, 0, 1).transition(0, 0, 0, 1).transition(1, 0, 1, 1);
  Model<Rational> model{std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::points;
  model.geometry.points.resize(2, 1);
  model.geometry.points << Rational(0), 1 / Rational(Integer(1) << 1400);
  model.geometry.norm = Norm::l1;
  model.geometry.eps = 1;
  const BoundsCertificate c = certify_by_bounds(model);
  EXPECT_EQ(c.constants.l_r.value, Rational(Integer(1) << 1400));
  model.geometry.points(1, 0) = 0;
  EXPECT_THROW(certify_by_bounds(model), AssumptionFails);
}

/// Lemma 1 looks at pairs of states: of many states nothing is said of it, unless it is asked for.
TEST(CertifyByBounds, OfManyStatesLemma1IsLeftOut) {
  CertifyOptions options{.max_positions = 500, .max_pair_states = 5};
  const BoundsCertificate c = certify_by_bounds(rationalise(builtin_model("garnet")), {}, options);
  EXPECT_FALSE(c.any(Verdict::undetermined));
  EXPECT_EQ(c.claims.front().id, ClaimId::lemma_2);
  options.only = std::set{ClaimId::lemma_1};
  EXPECT_TRUE(certify_by_bounds(rationalise(builtin_model("garnet")), {}, options).any(Verdict::undetermined));
}

TEST(CertifyByBounds, IsAnExaminationWithoutLemma3) {
  const Examination e = examine_exactly(rationalise(builtin_model("garnet")), {}, {.exact = true, .by_bounds = true});
  EXPECT_EQ(e.check(ClaimId::lemma_3).verdict, Verdict::not_asked);
  EXPECT_EQ(e.check(ClaimId::theorem_1).verdict, Verdict::holds);
  EXPECT_EQ(e.fate, Fate::undetermined);
  EXPECT_GT(e.enclosed_from, 0);
  EXPECT_TRUE(e.attack_changes_action);
  EXPECT_TRUE(e.pessimism_changes_action);
}

}  // namespace
}  // namespace maximin
