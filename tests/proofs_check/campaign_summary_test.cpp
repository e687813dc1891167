#include <maximin/proofs_check/campaign_summary.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "small_records.hpp"

namespace maximin {
namespace {

/// A record whose only claim is E, with the given sides.
TrialRecord of_e(long trial, double left, double right, double trivial = 10) {
  TrialRecord record{trial, "made up", {}};
  record.found.check(ClaimId::e_test_time).observe(left, right, 0);
  record.found.trivial = trivial;
  record.found.fate = Fate::settled;
  return record;
}

const ClaimSummary& e_of(const CampaignSummary& summary) {
  return summary.claims[static_cast<std::size_t>(ClaimId::e_test_time)];
}

TEST(CampaignSummary, QuantilesByHand) {
  // Ratios 0.01, 0.02, ..., 2.00, in a scrambled order; right sides above the trivial bound from trial 100 on.
  std::vector<TrialRecord> records;
  for (long k = 0; k < 100; ++k) {
    const long rank = (k * 37) % 100 + 1;  // 1 ... 100, each once
    records.push_back(of_e(k, 0.01 * static_cast<double>(rank), 1, k < 30 ? 2 : 0.5));
  }
  const CampaignSummary summary = summarise(records);
  const ClaimSummary& e = e_of(summary);
  EXPECT_EQ(e.holds, 100);
  EXPECT_EQ(e.checked(), 100);
  EXPECT_EQ(e.instances, 100);
  EXPECT_DOUBLE_EQ(e.median, 0.50) << "nearest rank: the 50th of 100";
  EXPECT_DOUBLE_EQ(e.p99, 0.99);
  EXPECT_DOUBLE_EQ(e.max, 1.00);
  EXPECT_EQ((e.max_trial * 37) % 100 + 1, 100);
  EXPECT_EQ(e.tightest.left, 1);
  EXPECT_EQ(e.informative, 30);
  EXPECT_EQ(summary.any_informative, 30);
  EXPECT_FALSE(summary.vacuous());
}

TEST(CampaignSummary, OfOneTwoAndThreeRatios) {
  EXPECT_EQ(e_of(summarise({of_e(0, 1, 2)})).median, 0.5);
  EXPECT_EQ(e_of(summarise({of_e(0, 1, 2)})).p99, 0.5);
  EXPECT_EQ(e_of(summarise({of_e(0, 1, 2), of_e(1, 1, 4)})).median, 0.25) << "the lower of two";
  const auto three = summarise({of_e(0, 1, 2), of_e(1, 1, 4), of_e(2, 1, 8)});
  EXPECT_EQ(e_of(three).median, 0.25);
  EXPECT_EQ(e_of(three).p99, 0.5);
  EXPECT_EQ(e_of(three).max_trial, 0);
}

TEST(CampaignSummary, CountsVerdictsFatesAndRegimes) {
  std::vector<TrialRecord> records{of_e(0, 1, 2), of_e(1, 3, 2), of_e(2, 1, 2), of_e(3, 5, 2)};
  records[2].found.check(ClaimId::e_test_time).verdict = Verdict::undetermined;
  records[3].found.fate = Fate::cycles;
  records[3].found.period = 3;
  records[0].found.fate = Fate::undetermined;
  records[0].found.largest_ball = 2;
  records[1].found.largest_ball = 1;
  records[1].found.attack_changes_action = true;
  records[2].found.pessimism_changes_action = true;
  TrialRecord assumption{4, "other", {}};
  assumption.found.failed_assumption = "Assumption 1";
  assumption.found.check(ClaimId::e_test_time).verdict = Verdict::assumption_fails;
  records.push_back(assumption);
  const CampaignSummary s = summarise(records);
  EXPECT_EQ(s.trials, 5);
  EXPECT_EQ(s.violations, 2);
  EXPECT_EQ(s.first_violation, 1);
  EXPECT_EQ(s.undetermined, 1);
  EXPECT_EQ(s.assumption_failures, 1);
  EXPECT_EQ(s.decided, 3);
  EXPECT_EQ(s.settled, 2);
  EXPECT_EQ(s.cycles, 1);
  EXPECT_EQ(s.fate_undetermined, 2);
  EXPECT_EQ(s.periods, (std::map<long, long>{{3, 1}}));
  EXPECT_EQ(s.balls_of_several, 1);
  EXPECT_EQ(s.attack_changes_action, 1);
  EXPECT_EQ(s.pessimism_changes_action, 1);
  EXPECT_EQ(s.families, (std::map<std::string, long>{{"made up", 4}, {"other", 1}}));
  EXPECT_EQ(e_of(s).holds, 1);
  EXPECT_EQ(e_of(s).violated, 2);
  EXPECT_EQ(e_of(s).undetermined, 1);
  EXPECT_EQ(e_of(s).assumption_fails, 1);
  EXPECT_EQ(e_of(s).max, 2.5);
  EXPECT_EQ(e_of(s).max_trial, 3);
}

TEST(CampaignSummary, AnInfiniteRatioIsTheLargest) {
  const auto s = summarise({of_e(0, 1, 2), of_e(1, std::numeric_limits<double>::quiet_NaN(), 2), of_e(2, 1, 4)});
  EXPECT_EQ(s.violations, 1);
  EXPECT_EQ(e_of(s).max_trial, 1);
  EXPECT_EQ(e_of(s).max, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(to_json(s)["claims"][0]["tightness"]["max"].is_null());
}

TEST(CampaignSummary, UpperLimitOnViolationsByTheirDistribution) {
  CampaignSummary s;
  EXPECT_EQ(s.violation_upper_limit(), 1) << "nothing seen, nothing known";
  for (const long trials : {1L, 10L, 59L, 2000L}) {
    s.trials = s.decided = trials;
    EXPECT_NEAR(s.violation_upper_limit(), 1 - std::pow(0.05, 1 / static_cast<double>(trials)), 1e-12);
  }
  EXPECT_NEAR(s.violation_upper_limit(), 0.00149674, 1e-8) << "0 of 2000: about three in two thousand";
  // k of n: the p at which k or fewer come up with probability 5 percent.
  s.trials = s.decided = 10;
  s.violations = 1;
  const double p = s.violation_upper_limit();
  EXPECT_NEAR(std::pow(1 - p, 10) + 10 * p * std::pow(1 - p, 9), 0.05, 1e-9);
  s.violations = 10;
  EXPECT_EQ(s.violation_upper_limit(), 1);
  // Models on which something stayed open say nothing.
  s.trials = 2000;
  s.violations = 0;
  s.decided = 59;
  EXPECT_NEAR(s.violation_upper_limit(), 1 - std::pow(0.05, 1 / 59.0), 1e-12);
  s.decided = 0;
  EXPECT_EQ(s.violation_upper_limit(), 1);
}

TEST(CampaignSummary, IsVacuousWhereNoBoundBeatsTheTrivialOne) {
  EXPECT_TRUE(summarise({}).vacuous());
  EXPECT_TRUE(summarise({of_e(0, 1, 2, 2)}).vacuous()) << "at the trivial bound is no better";
  EXPECT_FALSE(summarise({of_e(0, 1, 2, 2.001)}).vacuous());
  // A lemma is a step of the argument, not a bound that informs.
  TrialRecord lemma{0, "made up", {}};
  lemma.found.check(ClaimId::lemma_2).observe(0, 1, 0);
  lemma.found.trivial = 10;
  EXPECT_TRUE(summarise({lemma}).vacuous());
}

TEST(CampaignSummary, JsonListsTheClaimsThatWereLookedAt) {
  const auto json = to_json(summarise({of_e(0, 1, 2), of_e(1, 1, 4)}));
  EXPECT_EQ(json["trials"], 2);
  EXPECT_EQ(json["violations"], 0);
  EXPECT_EQ(json["first_violation"], -1);
  EXPECT_EQ(json["vacuous"], false);
  ASSERT_EQ(json["claims"].size(), 1u);
  EXPECT_EQ(json["claims"][0]["name"], "E");
  EXPECT_EQ(json["claims"][0]["informative"], 2);
  EXPECT_EQ(json["claims"][0]["tightness"]["median"], 0.25);
  EXPECT_EQ(json["claims"][0]["tightest"]["trial"], 0);
  const auto all = to_json(summarise(small_records(5)));
  EXPECT_EQ(all["claims"].size(), claim_count);
  EXPECT_FALSE(all["claims"][0].contains("informative")) << "a lemma";
  EXPECT_TRUE(all["claims"][4].contains("informative")) << "Theorem 1";
}

}  // namespace
}  // namespace maximin
