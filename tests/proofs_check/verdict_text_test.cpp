#include <maximin/proofs_check/verdict_text.hpp>

#include <gtest/gtest.h>

#include <string>

#include "../theory/small_models.hpp"
#include "small_records.hpp"
#include "trap_model.hpp"

namespace maximin {
namespace {

/// Whether the text has the line, from its start to its end.
testing::AssertionResult has_line(const std::string& text, const std::string& line) {
  if (('\n' + text + '\n').find('\n' + line + '\n') != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no line\n" << line << "\nin\n" << text;
}

testing::AssertionResult has(const std::string& text, const std::string& part) {
  if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << "no \"" << part << "\" in\n" << text;
}

TrialRecord of_e(long trial, double left, double right, double trivial) {
  TrialRecord record{trial, "made up", {}};
  record.found.check(ClaimId::e_test_time).observe(left, right, 0);
  record.found.trivial = trivial;
  record.found.fate = Fate::settled;
  return record;
}

Model<double> unnamed(FiniteMdp<double> mdp) {
  return {std::move(mdp)};
}

TEST(Outcome, OfACampaign) {
  const auto holds = summarise({of_e(0, 1, 2, 10)}), vacuous = summarise({of_e(0, 1, 2, 1)});
  const auto violated = summarise({of_e(0, 3, 2, 1)});
  EXPECT_EQ(outcome(holds, true), Outcome::holds);
  EXPECT_EQ(outcome(holds, false), Outcome::undetermined) << "interrupted";
  EXPECT_EQ(outcome(vacuous, true), Outcome::undetermined) << "nothing was verified";
  EXPECT_EQ(outcome(summarise({}), true), Outcome::undetermined);
  EXPECT_EQ(outcome(violated, true), Outcome::violated) << "even where the bound is vacuous";
  EXPECT_EQ(outcome(violated, false), Outcome::violated) << "even when interrupted";
  auto assumption = of_e(1, 1, 2, 10);
  assumption.found.failed_assumption = "Assumption 1";
  EXPECT_EQ(outcome(summarise({of_e(0, 1, 2, 10), assumption}), true), Outcome::assumption_fails);
}

TEST(Outcome, OfOneModel) {
  auto record = of_e(0, 1, 2, 1);
  EXPECT_EQ(outcome(record.found), Outcome::holds) << "a vacuous bound that holds, holds";
  record.found.check(ClaimId::f_belief).verdict = Verdict::undetermined;
  EXPECT_EQ(outcome(record.found), Outcome::undetermined);
  record.found.check(ClaimId::lemma_1).verdict = Verdict::violated;
  EXPECT_EQ(outcome(record.found), Outcome::violated);
}

TEST(VerdictText, ACampaignThatHolds) {
  std::vector<TrialRecord> records;
  for (long k = 0; k < 2000; ++k) records.push_back(of_e(k, 1, k == 40 ? 2 : 4, k < 500 ? 10 : 1));
  const std::string text = verdict_text(summarise(records), {}, "--seed 7", true);
  EXPECT_TRUE(has_line(text, "2000 models (--seed 7), reading corrected: R_max = max |R|"));
  EXPECT_TRUE(has_line(text,
                       "  E                pessimism at test time              2000        0        0       25.0%"
                       "    0.2500   0.2500   0.5000       40"));
  EXPECT_TRUE(has_line(text, "At least one bound informative on 500 (25.0%)"));
  EXPECT_TRUE(has(text,
                  "HOLDS: no violation in 2000 models. At most 0.150 percent of such models violate a claim (95 "
                  "percent upper limit)."));
  EXPECT_TRUE(has_line(text, "Seen in floating point, with certified numerical error; not a proof."));
  EXPECT_FALSE(has(text, "Theorem 1")) << "what was not asked is not listed";
}

TEST(VerdictText, ACampaignOfVacuousBoundsSaysThatItVerifiesNothing) {
  const std::string text = verdict_text(summarise({of_e(0, 1, 2, 1), of_e(1, 1, 2, 2)}), {}, "--seed 1", true);
  EXPECT_TRUE(has(text, "UNDETERMINED: every bound was vacuous on every model"));
  EXPECT_TRUE(has(text, "this campaign verifies nothing"));
  EXPECT_FALSE(has(text, "HOLDS"));
}

TEST(VerdictText, AViolatedCampaignNamesTheClaimAndTheTrialToReplay) {
  const auto summary = summarise({of_e(0, 1, 2, 10), of_e(1, 3, 2, 10)});
  const std::string text = verdict_text(summary, {.reading = Reading::paper}, "--seed 9 --family costs", true);
  EXPECT_TRUE(
      has_line(text, "2 models (--seed 9 --family costs), reading as the paper prints it: R_max = max(0, max R)"));
  EXPECT_TRUE(has(text, "VIOLATED"));
  EXPECT_TRUE(has(text, "on 1 model, the first: verify_bound --seed 9 --family costs --replay 1\n"));
  EXPECT_FALSE(has(text, "HOLDS"));
}

/// Nothing was seen of a claim that was asked for: no zero exit, and a limit from the models that were decided alone.
TEST(VerdictText, ACampaignThatNeverDecidedAClaimIsUndetermined) {
  std::vector<TrialRecord> records{of_e(0, 1, 2, 10), of_e(1, 1, 2, 10)};
  for (TrialRecord& record : records) record.found.check(ClaimId::theorem_1).undecided();
  const auto summary = summarise(records);
  EXPECT_TRUE(summary.some_claim_never_decided());
  EXPECT_EQ(outcome(summary, true), Outcome::undetermined);
  EXPECT_TRUE(has(verdict_text(summary, {}, "--seed 1", true), "UNDETERMINED: no violation in 2 models"));
  EXPECT_FALSE(summarise({of_e(0, 1, 2, 10)}).some_claim_never_decided());
}

TEST(VerdictText, AnInterruptedCampaignSaysHowToGoOn) {
  const std::string text = verdict_text(summarise({of_e(0, 1, 2, 10)}), {}, "--seed 1", false);
  EXPECT_TRUE(has(text, "UNDETERMINED: 1 model and no violation. The run was interrupted; --resume completes it."));
}

TEST(VerdictText, OneModelWithItsWitnesses) {
  const Model<double> model = unnamed(one_sided<double>());
  const Examination found = examine(model.mdp, one_sided_balls<double>(), {.reading = Reading::paper});
  const std::string text = verdict_text("the one-sided model", model, found, {.reading = Reading::paper});
  EXPECT_TRUE(has_line(text, "the one-sided model: 3 states, 2 actions, gamma 0.5, eps 1, largest ball 2 states"));
  EXPECT_TRUE(has_line(text, "  l_r            1   attained by states 0 and 1, action 0"));
  EXPECT_TRUE(has_line(text, "  l_p            1   attained by states 0 and 1, action 0, successor 0"));
  EXPECT_TRUE(has_line(text, "  span(R)        20   (R from -20 to 0)"));
  EXPECT_TRUE(has(text, "  theorem-1        Theorem 1                        violated             10 <= 6   "));
  EXPECT_TRUE(has(text, "VIOLATED: a claim above fails on this model."));
}

TEST(VerdictText, OneModelByItsNames) {
  Model<double> model = unnamed(one_sided<double>());
  model.state_names = {"near", "far", "out"};
  model.action_names = {"stay", "leave"};
  const Examination found = examine(model.mdp, one_sided_balls<double>(), {.reading = Reading::paper});
  const std::string text = verdict_text("named", model, found, {.reading = Reading::paper});
  EXPECT_TRUE(has_line(text, "  l_p            1   attained by states near and far, action stay, successor near"));
  EXPECT_TRUE(has(text, "1.6667 informative  at n = 40, state near, action stay\n"));
}

TEST(VerdictText, OneModelThatHolds) {
  const Model<double> model = unnamed(trap());
  const std::string text = verdict_text("the trap", model, examine(model.mdp, trap_balls()), {});
  EXPECT_TRUE(has_line(text, "  l_p            0"));
  EXPECT_TRUE(has(text, "  E                pessimism at test time           holds             0.625 <= 0.666667"));
  EXPECT_TRUE(has(text, "HOLDS on this model, in floating point with certified error."));
}

TEST(VerdictText, OneModelThatFailsAnAssumption) {
  FiniteMdpBuilder<double> b(2, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(1, 0, 1);
  const Model<double> model = unnamed(std::move(b).build());
  const Examination found = examine(model.mdp, on_line<double>({1, 1}, 1));
  const std::string text = verdict_text("twins", model, found, {});
  EXPECT_TRUE(has_line(text, "  l_r            infinite: states 0 and 1 at distance 0 differ"));
  EXPECT_TRUE(
      has_line(text,
               "ASSUMPTION FAILS: Assumption 1: states 0 and 1 are at distance 0, or as good as, but their rewards for "
               "action 0 differ, so no Lipschitz constant exists"));
}

TEST(VerdictText, EveryClaimIsExplained) {
  const std::string text = claims_text();
  for (const Claim& c : claims()) {
    EXPECT_TRUE(has(text, std::string(c.name) + ": " + std::string(c.title)));
    EXPECT_TRUE(has_line(text, "    " + std::string(c.statement)));
  }
}

}  // namespace
}  // namespace maximin
