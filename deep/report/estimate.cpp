#include <maximin/deep/report/estimate.hpp>

#include <algorithm>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

namespace maximin::deep {
namespace {

double mean_of(std::span<const double> values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

/// Sum of squared distances from the mean.
double squares_of(std::span<const double> values) {
  const double mean = mean_of(values);
  double sum = 0;
  for (const double v : values) sum += (v - mean) * (v - mean);
  return sum;
}

/// 95 percent by Student's t.
ConfidenceInterval student(double variance, double degrees) {
  if (!(variance > 0)) return {0, degrees};
  const boost::math::students_t t(std::max(1.0, degrees));
  return {boost::math::quantile(t, 0.975) * std::sqrt(variance), degrees};
}

/// The mean squares of a two-way table, one observation in each place: seeds by episodes.
struct TwoWay {
  double seeds = 0, episodes = 0, rest = 0;  ///< mean squares
  double n_seeds = 0, n_episodes = 0;
};

TwoWay two_way(std::span<const SeedRun> runs, std::span<const double> seed_means, double mean) {
  TwoWay w;
  w.n_seeds = static_cast<double>(runs.size());
  w.n_episodes = static_cast<double>(runs.front().returns.size());
  for (std::size_t e = 0; e < runs.front().returns.size(); ++e) {
    double episode_mean = 0;
    for (const SeedRun& r : runs) episode_mean += r.returns[e] / w.n_seeds;
    w.episodes += w.n_seeds * (episode_mean - mean) * (episode_mean - mean);
    for (std::size_t s = 0; s < runs.size(); ++s) {
      const double rest = runs[s].returns[e] - seed_means[s] - episode_mean + mean;
      w.rest += rest * rest;
    }
  }
  w.episodes /= w.n_episodes - 1;
  if (runs.size() < 2) return w;
  w.seeds = w.n_episodes * squares_of(seed_means) / (w.n_seeds - 1);
  w.rest /= (w.n_seeds - 1) * (w.n_episodes - 1);
  return w;
}

/// Variance of the mean over both seeds and episodes, with Satterthwaite's degrees of freedom.
ConfidenceInterval crossed_interval(const TwoWay& w) {
  const double shared = std::max(0.0, w.episodes - w.rest);
  const double sum = w.seeds + shared;
  double parts = w.seeds * w.seeds / (w.n_seeds - 1);
  if (shared > 0) {
    parts += w.episodes * w.episodes / (w.n_episodes - 1) + w.rest * w.rest / ((w.n_seeds - 1) * (w.n_episodes - 1));
  }
  return student(sum / (w.n_seeds * w.n_episodes), parts > 0 ? sum * sum / parts : w.n_seeds - 1);
}

EpisodeDesign design_of(std::span<const SeedRun> runs) {
  std::set<std::uint64_t> seeds;
  bool equally_many = true;
  for (const SeedRun& r : runs) {
    seeds.insert(r.evaluation_seed);
    equally_many = equally_many && r.returns.size() == runs.front().returns.size();
  }
  if (seeds.size() == runs.size()) return EpisodeDesign::nested;
  return seeds.size() == 1 && equally_many ? EpisodeDesign::crossed : EpisodeDesign::mixed;
}

/// What the spread within each seed makes of the error of that seed's mean.
struct Within {
  std::vector<double> variances;  ///< of each seed's mean
  std::vector<double> degrees;
  double mean() const { return mean_of(variances); }
};

/// Empty where a seed has a single episode.
std::optional<Within> within_seeds(std::span<const SeedRun> runs) {
  Within w;
  for (const SeedRun& r : runs) {
    const auto n = static_cast<double>(r.returns.size());
    if (n < 2) return std::nullopt;
    w.variances.push_back(squares_of(r.returns) / (n - 1) / n);
    w.degrees.push_back(n - 1);
  }
  return w;
}

/// Independent seeds: the variances of their means add up; Welch's degrees of freedom.
ConfidenceInterval nested_agents(const Within& w) {
  const auto seeds = static_cast<double>(w.variances.size());
  const double variance = w.mean() / seeds;
  double parts = 0;
  for (std::size_t s = 0; s < w.variances.size(); ++s) {
    const double part = w.variances[s] / (seeds * seeds);
    parts += part * part / w.degrees[s];
  }
  return student(variance, parts > 0 ? variance * variance / parts : w.degrees.front());
}

/// Some seeds share episodes: their errors are taken as if they were one and the same.
ConfidenceInterval mixed_agents(const Within& w) {
  return student(w.mean(), *std::min_element(w.degrees.begin(), w.degrees.end()));
}

ConfidenceInterval mixed_across(const Within& w, std::span<const double> seed_means) {
  const auto seeds = static_cast<double>(seed_means.size());
  const double between = squares_of(seed_means) / (seeds - 1) / seeds;
  const double sum = between + w.mean();
  const double least = *std::min_element(w.degrees.begin(), w.degrees.end());
  const double parts = between * between / (seeds - 1) + w.mean() * w.mean() / least;
  return student(sum, parts > 0 ? sum * sum / parts : seeds - 1);
}

void refuse_bad(std::span<const SeedRun> runs) {
  if (runs.empty()) throw std::invalid_argument("estimate: no run, expected at least one");
  for (const SeedRun& r : runs) {
    if (r.returns.empty()) throw std::invalid_argument("estimate: a run without episodes, expected at least one");
    for (const double v : r.returns) {
      if (!std::isfinite(v)) throw std::invalid_argument("estimate: a return is not finite, expected a number");
    }
  }
}

}  // namespace

Estimate estimate(std::span<const SeedRun> runs) {
  refuse_bad(runs);
  Estimate e;
  for (const SeedRun& r : runs) {
    e.seed_means.push_back(mean_of(r.returns));
    e.episodes += static_cast<long>(r.returns.size());
  }
  e.mean = mean_of(e.seed_means);
  e.design = design_of(runs);
  const auto seeds = static_cast<double>(runs.size());
  const std::optional<Within> within = within_seeds(runs);
  if (e.design == EpisodeDesign::nested) {
    if (runs.size() > 1) e.across_seeds = student(squares_of(e.seed_means) / (seeds - 1) / seeds, seeds - 1);
    if (within) e.these_agents = nested_agents(*within);
  } else if (within && e.design == EpisodeDesign::crossed) {
    const TwoWay w = two_way(runs, e.seed_means, e.mean);
    e.across_seeds = crossed_interval(w);
    e.these_agents = student(w.episodes / (w.n_seeds * w.n_episodes), w.n_episodes - 1);
  } else if (within) {
    e.across_seeds = mixed_across(*within, e.seed_means);
    e.these_agents = mixed_agents(*within);
  }
  return e;
}

}  // namespace maximin::deep
