#include <maximin/deep/report/estimate.hpp>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/theory/random.hpp>

namespace maximin::deep {
namespace {

SeedRun run(std::uint64_t seed, std::uint64_t evaluation, std::vector<double> returns) {
  return {seed, evaluation, std::move(returns), 0};
}

double squares(const std::vector<double>& values) {
  double mean = 0, sum = 0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum;
}

TEST(Estimate, NestedIsStudentOverTheSeedMeans) {
  // Seed means 10, 20, 60: mean 30, variance 700, error sqrt(700/3); t(2) = 4.302653.
  const std::vector<SeedRun> runs{run(1, 1, {9, 11}), run(2, 2, {20, 20, 20}), run(3, 3, {50, 70})};
  const Estimate e = estimate(runs);
  EXPECT_EQ(e.design, EpisodeDesign::nested);
  EXPECT_DOUBLE_EQ(e.mean, 30) << "a seed counts once, however many episodes it has";
  EXPECT_EQ(e.episodes, 7);
  EXPECT_NEAR(e.across_seeds->half_width, 4.3026527297 * std::sqrt(700.0 / 3), 1e-6);
  // Variances of the means 1, 0, 100 over 9; Welch: (101/9)^2 / ((1/81 + 10000/81)/1).
  EXPECT_NEAR(e.these_agents->degrees, 101.0 * 101 / 10001, 1e-12);
}

TEST(Estimate, CrossedAddsTheLuckOfTheEpisodes) {
  // y = 10 s + 5 e without rest: MS_seeds = 3 * 100, MS_episodes = 3 * 25, MS_rest = 0.
  const std::vector<SeedRun> runs{run(1, 7, {0, 5, 10}), run(2, 7, {10, 15, 20}), run(3, 7, {20, 25, 30})};
  const Estimate e = estimate(runs);
  EXPECT_EQ(e.design, EpisodeDesign::crossed);
  EXPECT_DOUBLE_EQ(e.mean, 15);
  const double degrees = 375.0 * 375 / (300.0 * 300 / 2 + 75.0 * 75 / 2);
  EXPECT_NEAR(e.across_seeds->degrees, degrees, 1e-9);
  EXPECT_NEAR(e.across_seeds->half_width / std::sqrt(375.0 / 9), 3.57, 0.4) << "t of nearly 3 degrees";
  EXPECT_NEAR(e.these_agents->half_width, 4.3026527297 * std::sqrt(75.0 / 9), 1e-6);
  EXPECT_GT(e.across_seeds->half_width, e.these_agents->half_width);
}

TEST(Estimate, OneSeedSaysNothingOfOthers) {
  const Estimate e = estimate(std::vector{run(1, 1, {1, 2, 3})});
  EXPECT_FALSE(e.across_seeds);
  ASSERT_TRUE(e.these_agents);
  EXPECT_NEAR(e.shown()->half_width, 4.3026527297 / std::sqrt(3), 1e-6);
  const Estimate single = estimate(std::vector{run(1, 1, {5})});
  EXPECT_FALSE(single.shown()) << "one episode of one seed has no interval at all";
  EXPECT_EQ(single.mean, 5);
  const Estimate pair = estimate(std::vector{run(1, 1, {5}), run(2, 1, {7})});
  EXPECT_FALSE(pair.across_seeds) << "one shared episode: its luck cannot be seen";
  EXPECT_TRUE(estimate(std::vector{run(1, 1, {5}), run(2, 2, {7})}).across_seeds);
}

TEST(Estimate, EqualReturnsHaveNoSpread) {
  for (const std::uint64_t other : {1u, 2u}) {
    const Estimate e = estimate(std::vector{run(1, 1, {4, 4}), run(2, other, {4, 4})});
    EXPECT_EQ(e.mean, 4);
    EXPECT_EQ(e.across_seeds->half_width, 0);
  }
}

TEST(Estimate, SharedEpisodesInPartAreTakenAsTheWorst) {
  // Seed means 4, 7, 3 and variances of them 16/3, 4, 13/9.
  std::vector<SeedRun> runs{run(1, 1, {0, 8, 4}), run(2, 1, {3, 9, 9}), run(3, 3, {5, 1, 3})};
  const Estimate e = estimate(runs);
  EXPECT_EQ(e.design, EpisodeDesign::mixed);
  const double between = (squares({4, 7, 3}) / 2) / 3, within = (16.0 / 3 + 4 + 4.0 / 3) / 3;
  const double sum = between + within;
  EXPECT_NEAR(e.across_seeds->degrees, sum * sum / (between * between / 2 + within * within / 2), 1e-9);
  EXPECT_NEAR(e.these_agents->half_width, 4.3026527297 * std::sqrt(within), 1e-6);
  runs[2].evaluation_seed = 1;
  EXPECT_EQ(estimate(runs).design, EpisodeDesign::crossed);
  runs[2].returns.push_back(3);
  EXPECT_EQ(estimate(runs).design, EpisodeDesign::mixed) << "not equally many";
}

TEST(Estimate, RefusesWhatIsNoNumber) {
  EXPECT_THROW(estimate({}), std::invalid_argument);
  EXPECT_THROW(estimate(std::vector{run(1, 1, {})}), std::invalid_argument);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(estimate(std::vector{run(1, 1, {1, bad})}), std::invalid_argument);
  }
}

RC_GTEST_PROP(Estimate, IsEquivariant, (std::uint64_t seed)) {
  // Shifting and scaling the returns does the same to the mean and scales the intervals.
  Stream rng(seed);
  const int seeds = 2 + rng.below(4), episodes = 2 + rng.below(6), design = rng.below(3);
  std::vector<SeedRun> runs, moved;
  for (int s = 0; s < seeds; ++s) {
    const auto evaluation = static_cast<std::uint64_t>(design == 0 ? s : design == 1 ? 0 : s / 2);
    runs.push_back(run(static_cast<std::uint64_t>(s), evaluation, {}));
    moved.push_back(runs.back());
    for (int e = 0; e < episodes; ++e) {
      runs.back().returns.push_back(rng.uniform(-100, 200));
      moved.back().returns.push_back(7 - 3 * runs.back().returns.back());
    }
  }
  const Estimate a = estimate(runs), b = estimate(moved);
  RC_ASSERT(std::abs(b.mean - (7 - 3 * a.mean)) < 1e-9);
  RC_ASSERT(std::abs(b.across_seeds->half_width - 3 * a.across_seeds->half_width) < 1e-6);
  RC_ASSERT(std::abs(b.these_agents->half_width - 3 * a.these_agents->half_width) < 1e-6);
}

/// Effects of seed, episode and rest, uniform with these standard deviations; the true mean is 0.
struct World {
  double seed = 0, episode = 0, rest = 0;
  int sharing = 0;  ///< how many seeds play the episodes of seed 0
};

double effect(Stream& rng, double deviation) {
  return deviation * (rng.uniform() + rng.uniform() + rng.uniform() + rng.uniform() - 2) * std::sqrt(3.0);
}

std::vector<SeedRun> drawn(const World& w, int seeds, int episodes, Stream& rng) {
  std::vector<SeedRun> runs;
  std::vector<double> luck(static_cast<std::size_t>(episodes));
  for (int s = 0; s < seeds; ++s) {
    runs.push_back(run(static_cast<std::uint64_t>(s), s < w.sharing ? 0u : static_cast<std::uint64_t>(s), {}));
    const double a = effect(rng, w.seed);
    for (double& b : luck) {
      if (s >= w.sharing || s == 0) b = effect(rng, w.episode);
    }
    for (const double b : luck) runs.back().returns.push_back(a + b + effect(rng, w.rest));
  }
  return runs;
}

/// Share of 3,000 repetitions in which the interval holds the true mean.
double coverage(const World& w, const std::function<double(const std::vector<SeedRun>&)>& half_width) {
  int held = 0;
  for (std::uint64_t k = 0; k < 3000; ++k) {
    Stream rng(11, k);
    const auto runs = drawn(w, 3, 20, rng);
    held += std::abs(estimate(runs).mean) <= half_width(runs) ? 1 : 0;
  }
  return held / 3000.0;
}

double across(const std::vector<SeedRun>& runs) {
  return estimate(runs).across_seeds->half_width;
}
double agents(const std::vector<SeedRun>& runs) {
  return estimate(runs).these_agents->half_width;
}
/// What is wrong: evaluation seeds forgotten.
double as_if_nested(std::vector<SeedRun> runs) {
  for (SeedRun& r : runs) r.evaluation_seed = r.training_seed;
  return across(runs);
}

TEST(EstimateCoverage, HoldsTheTruthAsOftenAsItClaims) {
  for (const World& w : {World{1, 0, 3, 0}, World{0, 1, 1, 0}, World{3, 1, 1, 3}, World{0.3, 2, 1, 3},
                         World{0, 3, 0.5, 3}, World{1, 0, 2, 3}, World{1, 2, 1, 2}, World{0, 3, 0.5, 2}}) {
    const double c = coverage(w, across);
    EXPECT_GT(c, 0.925) << w.seed << ' ' << w.episode << ' ' << w.rest << ' ' << w.sharing;
    EXPECT_LE(c, 1.0);
  }
  EXPECT_NEAR(coverage({1, 0, 3, 0}, across), 0.95, 0.015) << "nested: exactly Student's t";
  EXPECT_NEAR(coverage({0, 1, 1, 0}, agents), 0.95, 0.015) << "seeds without luck of their own";
}

TEST(EstimateCoverage, WhatIsWrongIsSeenToBeWrong) {
  EXPECT_LT(coverage({1, 0, 1, 0}, agents), 0.6) << "the spread within seeds says nothing of training";
  EXPECT_LT(coverage({0.1, 2, 0.5, 3}, as_if_nested), 0.7) << "shared episodes shift all seeds alike";
}

}  // namespace
}  // namespace maximin::deep
