#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace maximin::deep {

/// What one trained network came to: the returns of its evaluation episodes.
struct SeedRun {
  std::uint64_t training_seed = 0;
  std::uint64_t evaluation_seed = 0;  ///< episode k is drawn from Stream(evaluation_seed, k)
  std::vector<double> returns;        ///< per episode, in order of its number; finite
  double wall_seconds = 0;            ///< of training, if it was trained for this, and of evaluating

  friend bool operator==(const SeedRun&, const SeedRun&) = default;
};

/// A 95 percent interval: value +- half_width.
struct ConfidenceInterval {
  double half_width = 0;
  double degrees = 0;  ///< degrees of freedom of the t quantile
};

/// How episodes of different training seeds are related, which decides what their mean's error is made of.
enum class EpisodeDesign {
  nested,   ///< every seed has episodes of its own: no two evaluation seeds are equal
  crossed,  ///< all seeds play the same episodes (one evaluation seed, equally many)
  mixed,    ///< neither: some share episodes
};

/// The mean return of a training procedure, and how sure it is. The value is the mean over training seeds of the mean
/// over episodes: a seed counts once, however many episodes it has.
///
/// Two different questions have two different intervals, and a table must say which it shows:
///
/// - `across_seeds`: what would another training run come to, on other episodes? Model: y_se = mu + a_s + b_e + r_se,
///   a_s the luck of training, b_e that of the episode's start. Nested episodes: Student's t over the S seed means,
///   S-1 degrees of freedom, which holds the spread of episodes already. Crossed episodes: the seed means share the
///   b_e, which no spread between them shows; Var = (MS_seeds + max(0, MS_episodes - MS_rest))/(S n), the two-way
///   analysis of variance, with Satterthwaite's degrees of freedom. Mixed: the nested variance plus the mean of the
///   variances of the seed means within a seed, which bounds what is shared from above. Not estimable from one seed:
///   then absent.
/// - `these_agents`: what would these very networks come to on other episodes? Variance within the seeds only (crossed:
///   of the episodes' means over the seeds). Absent where a seed has a single episode.
///
/// The second is no substitute for the first: it says nothing of training, and shrinks with every episode played.
/// The first has the coverage it claims for normal effects; with three seeds it is wide (t = 4.30) because three seeds
/// say little. Neither knows that a return has a largest value.
struct Estimate {
  double mean = 0;
  std::vector<double> seed_means;  ///< in the order of the runs
  long episodes = 0;               ///< over all seeds
  EpisodeDesign design = EpisodeDesign::nested;
  std::optional<ConfidenceInterval> across_seeds;
  std::optional<ConfidenceInterval> these_agents;

  /// The interval that a table shows: across seeds where it can be estimated, else that of these agents.
  std::optional<ConfidenceInterval> shown() const { return across_seeds ? across_seeds : these_agents; }
};

/// Throws std::invalid_argument when there is no run, a run without episodes, or a return that is not finite.
Estimate estimate(std::span<const SeedRun> runs);

}  // namespace maximin::deep
