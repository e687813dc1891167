#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>

namespace maximin {

/// The largest model a reader accepts. Counts are compared with these before anything is allocated, so that a file that
/// claims 10^18 states is refused at once.
struct ReadLimits {
  std::size_t bytes = std::size_t{256} << 20;  ///< size of a file, unpacked
  std::size_t pairs = 5'000'000;               ///< |S||A|
  std::size_t transitions = 10'000'000;        ///< stored transitions, all rows together
  std::size_t expansions = 100'000'000;        ///< Cassandra: entries written by wildcards; terms in rewards by o
};

/// What to do with a model whose probabilities are intervals.
enum class IntervalRows {
  refuse,   ///< throw InputError
  nominal,  ///< take from every row the member lo + t (hi - lo) that sums to 1
};

/// What a file may leave open.
struct ReadOptions {
  /// gamma, instead of the one in the file; needed where the file says 1. Formats without a discount get
  /// `default_discount` and a note.
  std::optional<double> discount;
  /// Which of several reward models (Storm, UMB) or reward structures (PRISM) to read, by name or, for PRISM, number.
  /// Empty: the only one, or the first with a note.
  std::string reward_model;
  IntervalRows intervals = IntervalRows::refuse;
  /// PRISM: reward files to read instead of those found beside the .tra file.
  std::filesystem::path state_rewards;
  std::filesystem::path transition_rewards;
  ReadLimits limits;

  static constexpr double default_discount = 0.95;
};

}  // namespace maximin
