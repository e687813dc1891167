#include <maximin/proofs_check/examination.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>

#include "../tabular/random_model.hpp"
#include "../theory/small_models.hpp"
#include "trap_model.hpp"

namespace maximin {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

Check observed(double left, double right, double slack) {
  Check check;
  check.observe(left, right, slack);
  return check;
}

TEST(Check, NotANumberAndInfinityAreViolations) {
  for (const double bad : {nan, inf, -inf}) {
    EXPECT_EQ(observed(bad, 1, 0).verdict, Verdict::violated);
    EXPECT_EQ(observed(0, bad, 0).verdict, Verdict::violated);
    EXPECT_EQ(observed(0, 1, bad).verdict, Verdict::violated);
    EXPECT_EQ(observed(bad, bad, bad).verdict, Verdict::violated);
    EXPECT_EQ(observed(bad, 1, 0).tightness(), inf);
  }
}

TEST(Check, HoldsUpToTheSlackAndNoFurther) {
  EXPECT_EQ(observed(1, 2, 0).verdict, Verdict::holds);
  EXPECT_EQ(observed(2, 2, 0).verdict, Verdict::holds);
  EXPECT_EQ(observed(2.25, 2, 0.25).verdict, Verdict::holds);
  EXPECT_EQ(observed(2.5, 2, 0.25).verdict, Verdict::violated);
  EXPECT_EQ(observed(std::nextafter(2.0, 3.0), 2, 0).verdict, Verdict::violated);
  EXPECT_EQ(observed(0, 0, 0).verdict, Verdict::holds);
  EXPECT_EQ(observed(0.5, 0, 0.5).verdict, Verdict::holds);
  EXPECT_EQ(observed(0.75, 0, 0.5).verdict, Verdict::violated);
  EXPECT_EQ(observed(-1, 0, 0).verdict, Verdict::holds);
  EXPECT_EQ(observed(-1, -2, 0).verdict, Verdict::violated);
  EXPECT_EQ(observed(0, -1, 0.5).verdict, Verdict::violated);
}

TEST(Check, TightnessIsWhatIsCertainOfTheRatio) {
  EXPECT_EQ(observed(1, 4, 0).tightness(), 0.25);
  EXPECT_EQ(observed(1, 4, 0.5).tightness(), 0.125);
  EXPECT_EQ(observed(1, 4, 2).tightness(), 0);
  EXPECT_EQ(observed(1, 0, 0).tightness(), inf);
}

TEST(Check, KeepsTheTightestInstanceAndTheLeastRightSide) {
  Check check;
  EXPECT_EQ(check.verdict, Verdict::not_asked);
  check.observe(1, 4, 0, 10);
  check.observe(3, 6, 0, 11);
  check.observe(0, 2, 0, 12);
  EXPECT_EQ(check.verdict, Verdict::holds);
  EXPECT_EQ(check.instances, 3);
  EXPECT_EQ(check.left, 3);
  EXPECT_EQ(check.right, 6);
  EXPECT_EQ(check.n, 11);
  EXPECT_EQ(check.least_right, 2);
}

TEST(Check, AViolationIsNotForgotten) {
  Check check;
  check.observe(5, 4, 0, 1);
  check.observe(1, 4, 0, 2);
  EXPECT_EQ(check.verdict, Verdict::violated);
  EXPECT_EQ(check.n, 1);
  Check broken;
  broken.observe(1, 4, 0, 1);
  broken.observe(nan, 4, 0, 2);
  broken.observe(1, 4, 0, 3);
  EXPECT_EQ(broken.verdict, Verdict::violated);
  EXPECT_EQ(broken.n, 2);
}

TEST(Check, WhatIsUndecidedIsNotMadeGoodByWhatHolds) {
  Check check;
  check.observe(1, 4, 0);
  check.undecided();
  EXPECT_EQ(check.verdict, Verdict::undetermined);
  check.observe(1, 4, 0);
  EXPECT_EQ(check.verdict, Verdict::undetermined);
  check.observe(5, 4, 0);
  EXPECT_EQ(check.verdict, Verdict::violated);
  check.undecided();
  EXPECT_EQ(check.verdict, Verdict::violated);
}

/// With one state there are no two to compare: Lemma 1 was asked and holds, it was not left out.
TEST(Examine, EveryClaimIsDecidedOnASingleState) {
  FiniteMdpBuilder<double> b(1, 2, 0.5);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).reward(0, 1, 1);
  const auto found = examine(std::move(b).build(), on_line<double>({0}, 1));
  for (const Claim& c : claims()) EXPECT_EQ(found.check(c.id).verdict, Verdict::holds) << c.name;
}

/// States that no path joins: nothing is claimed of them either.
TEST(Examine, EveryClaimIsDecidedOnIslands) {
  FiniteMdpBuilder<double> b(2, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(1, 0, 1);
  const auto found = examine(std::move(b).build(), Perturbation<double>::from_neighbourhoods({{0}, {1}}));
  for (const Claim& c : claims()) EXPECT_EQ(found.check(c.id).verdict, Verdict::holds) << c.name;
}

TEST(Examine, TwinsThatDifferFailAnAssumption) {
  FiniteMdpBuilder<double> b(3, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).transition(2, 0, 2, 1);
  const auto mdp = std::move(b).build();
  const auto found = examine(mdp, on_line<double>({0, 1, 1}, 1));
  EXPECT_EQ(
      found.failed_assumption,
      "Assumption 1: states 1 and 2 are at distance 0, or as good as, but their transitions for action 0 differ, so "
      "no Lipschitz constant exists");
  for (const Check& check : found.checks) EXPECT_EQ(check.verdict, Verdict::assumption_fails);
  EXPECT_FALSE(found.any(Verdict::violated));
}

TEST(Examine, ChecksOnlyWhatIsWanted) {
  ExaminationOptions options;
  options.only = {ClaimId::b_one_sided, ClaimId::f_belief};
  const auto found = examine(trap(), trap_balls(), options);
  for (const Claim& c : claims()) {
    EXPECT_EQ(found.check(c.id).verdict, options.only->contains(c.id) ? Verdict::holds : Verdict::not_asked) << c.name;
  }
}

TEST(Examine, IsUndeterminedWhereABudgetRunsOut) {
  Stream rng(1);
  const auto mdp = random_model(10, 3, 0.9, rng);
  ExaminationOptions options;
  options.max_iterations = 3;
  options.max_belief_positions = 2;
  const auto found = examine(mdp, line_balls(10, 1), options);
  EXPECT_EQ(found.fate, Fate::undetermined);
  for (const ClaimId id : {ClaimId::theorem_1, ClaimId::a_optimal_attacker, ClaimId::b_one_sided, ClaimId::f_belief}) {
    EXPECT_EQ(found.check(id).verdict, Verdict::undetermined);
    EXPECT_FALSE(found.informative(id));
  }
  EXPECT_EQ(found.check(ClaimId::c_finite_n).verdict, Verdict::holds) << "what holds at every n needs no limit";
  EXPECT_EQ(found.check(ClaimId::c_finite_n).instances, 3);
}

TEST(Examine, TheLimitIsTheWorstOfAWholeCycle) {
  // The restless model: period 3, and the three policies lose differently.
  FiniteMdpBuilder<double> b(2, 2, 0.9);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 0, 1).transition(1, 1, 1, 1);
  b.reward(0, 1, 2).reward(1, 0, 3);
  const auto mdp = std::move(b).build();
  const auto balls = Perturbation<double>::from_neighbourhoods({{0, 1}, {0, 1}});
  const auto found = examine(mdp, balls);
  EXPECT_EQ(found.fate, Fate::cycles);
  EXPECT_EQ(found.period, 3);
  double worst = 0;
  const auto run = pessimistic_q_iteration(mdp, balls);
  std::vector<double> gaps;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto pair = static_cast<std::size_t>(run.pair_of[run.pair_of.size() - 1 - k]);
    const double gap =
        (policy_iteration(mdp).q - evaluate_against_optimal_attack(mdp, balls, run.pairs[pair].policy).q).maxCoeff();
    gaps.push_back(gap);
    worst = std::max(worst, gap);
  }
  EXPECT_GT(worst, *std::min_element(gaps.begin(), gaps.end()) + 0.1);
  EXPECT_NEAR(found.gap, worst, 1e-9);
  EXPECT_NEAR(found.check(ClaimId::a_optimal_attacker).left, worst, 1e-9);
}

/// Two loops: Lemma 1 is attained, so that the certified slack is all there is between holds and violated.
TEST(Examine, AnAttainedClaimHoldsHoweverPatientTheAgent) {
  for (const double discount : {0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 1 - 1e-6}) {
    FiniteMdpBuilder<double> b(2, 1, discount);
    b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(0, 0, -1).reward(1, 0, 1);
    const auto found = examine(std::move(b).build(), on_line<double>({0, 1}, 1));
    EXPECT_FALSE(found.any(Verdict::violated)) << discount;
    EXPECT_EQ(found.check(ClaimId::lemma_1_iterates).verdict, Verdict::holds) << discount;
  }
}

TEST(Examine, RefusesBallsOfAnotherModel) {
  EXPECT_EQ(complaint([] { examine(trap(), line_balls(3, 1)); }), "perturbation: of 3 states, expected the model's 4");
}

TEST(Claims, AreListedInTheirOrderAndFoundByName) {
  std::size_t index = 0;
  for (const Claim& c : claims()) {
    EXPECT_EQ(static_cast<std::size_t>(c.id), index++);
    EXPECT_EQ(find_claim(c.name), c.id);
    EXPECT_EQ(&claim(c.id), &c);
    EXPECT_FALSE(c.title.empty() || c.reference.empty() || c.statement.empty());
  }
  EXPECT_EQ(index, claim_count);
  EXPECT_EQ(find_claim("G"), std::nullopt);
  EXPECT_EQ(find_claim(""), std::nullopt);
}

}  // namespace
}  // namespace maximin
