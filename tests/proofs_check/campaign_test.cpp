#include <maximin/proofs_check/campaign.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include <maximin/proofs_check/campaign_summary.hpp>

#include "small_records.hpp"

namespace maximin {
namespace {

/// Runs the campaign and returns its lines; fails the test if a record comes out of order.
std::vector<std::string> run_all(const Campaign& campaign, const ModelSource& source = small_source) {
  std::vector<TrialRecord> records;
  const std::atomic<bool> stop{false};
  const long seen = run_campaign(
      campaign, source,
      [&](TrialRecord&& record) {
        EXPECT_EQ(record.trial, campaign.first + static_cast<long>(records.size()));
        records.push_back(std::move(record));
      },
      stop);
  EXPECT_EQ(seen, static_cast<long>(records.size()));
  return lines_of(records);
}

TEST(Campaign, TheThreadsDoNotChangeAByte) {
  Campaign campaign{.seed = 5, .trials = 60};
  const auto alone = run_all(campaign);
  ASSERT_EQ(alone.size(), 60u);
  for (const int threads : {2, 4}) {
    campaign.threads = threads;
    EXPECT_EQ(run_all(campaign), alone) << threads;
  }
}

TEST(Campaign, ComesInOrderHoweverLongATrialTakes) {
  Campaign campaign{.trials = 24, .threads = 4};
  const ModelSource uneven = [](Stream& rng) {
    std::this_thread::sleep_for(std::chrono::milliseconds(rng.below(8)));
    return small_source(rng);
  };
  EXPECT_EQ(run_all(campaign, uneven).size(), 24u);
}

TEST(Campaign, ATrialIsAFunctionOfSeedAndNumber) {
  const Campaign campaign{.seed = 5, .trials = 20};
  const auto all = run_all(campaign);
  EXPECT_EQ(to_json(run_trial(campaign, draw_trial(campaign, small_source, 13), 13)).dump(), all[13])
      << "replayed by itself";
  Campaign rest = campaign;
  rest.first = 12;
  const auto resumed = run_all(rest);
  EXPECT_EQ(resumed, (std::vector<std::string>(all.begin() + 12, all.end())));
  const Campaign other{.seed = 6, .trials = 20};
  EXPECT_NE(run_all(other), all);
  EXPECT_NE(all[0].substr(all[0].find("family")), all[1].substr(all[1].find("family"))) << "trials differ";
}

TEST(Campaign, OfNoTrialsIsOver) {
  EXPECT_TRUE(run_all({.trials = 0}).empty());
  EXPECT_TRUE(run_all({.trials = 5, .first = 5, .threads = 3}).empty());
}

TEST(Campaign, StopsWhenAskedWithNoHolesInWhatWasSeen) {
  for (const int threads : {1, 4}) {
    std::atomic<bool> stop{false};
    long next = 0;
    const Campaign campaign{.trials = 100'000, .threads = threads};
    const long seen = run_campaign(
        campaign, small_source,
        [&](TrialRecord&& record) {
          EXPECT_EQ(record.trial, next++);
          if (next == 10) stop = true;
        },
        stop);
    EXPECT_EQ(seen, next);
    EXPECT_GE(seen, 10);
    EXPECT_LE(seen, 10 + 1000) << "trials under way are finished, no more begun";
  }
}

TEST(Campaign, AFailingSourceEndsItAndSaysWhy) {
  for (const int threads : {1, 4}) {
    const ModelSource breaks = [](Stream& rng) -> DrawnModel {
      if (rng.below(10) == 0) throw InputError("family: out of models");
      return small_source(rng);
    };
    const std::atomic<bool> stop{false};
    long next = 0;
    try {
      run_campaign(
          {.trials = 1000, .threads = threads}, breaks, [&](TrialRecord&& record) { EXPECT_EQ(record.trial, next++); },
          stop);
      FAIL() << "expected the source's exception";
    } catch (const InputError& e) {
      EXPECT_STREQ(e.what(), "family: out of models");
    }
    EXPECT_LT(next, 1000);
  }
}

/// A disk that is full: the sink must not be called again, least of all with a record it has had already.
TEST(Campaign, AFailingSinkEndsItAndIsLeftAlone) {
  for (const int threads : {1, 4}) {
    const std::atomic<bool> stop{false};
    long calls = 0;
    EXPECT_THROW(run_campaign(
                     {.trials = 200, .threads = threads}, small_source,
                     [&](TrialRecord&& record) {
                       EXPECT_EQ(record.trial, calls++);
                       if (record.trial == 7) throw std::runtime_error("disk full");
                     },
                     stop),
                 std::runtime_error);
    EXPECT_EQ(calls, 8) << threads << " threads";
  }
}

/// Two states that stay what they are, with rewards 0 and 1, in one ball: no bound can say anything.
DrawnModel hopeless(Stream&) {
  FiniteMdpBuilder<double> b(2, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(1, 0, 1);
  Model<double> model{std::move(b).build()};
  model.geometry.kind = Geometry<double>::Kind::discrete;
  model.geometry.eps = 1;
  return {"hopeless", std::move(model)};
}

TEST(Campaign, ATrialThatRunsOutOfItsBudgetIsUndeterminedNotLost) {
  Campaign campaign{.trials = 30};
  campaign.examination.max_iterations = 2;
  campaign.examination.max_belief_positions = 1;
  std::vector<TrialRecord> records;
  const std::atomic<bool> stop{false};
  run_campaign(
      campaign, small_source, [&](TrialRecord&& record) { records.push_back(std::move(record)); }, stop);
  ASSERT_EQ(records.size(), 30u);
  const CampaignSummary summary = summarise(records);
  EXPECT_EQ(summary.violations, 0);
  EXPECT_GT(summary.undetermined, 20);
}

TEST(Campaign, OfVacuousBoundsSaysSo) {
  std::vector<TrialRecord> records;
  const std::atomic<bool> stop{false};
  run_campaign(
      {.trials = 5}, hopeless, [&](TrialRecord&& record) { records.push_back(std::move(record)); }, stop);
  const CampaignSummary summary = summarise(records);
  EXPECT_EQ(summary.violations, 0);
  EXPECT_EQ(summary.any_informative, 0);
  EXPECT_TRUE(summary.vacuous());
}

}  // namespace
}  // namespace maximin
