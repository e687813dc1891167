#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <vector>

/// Checks of option values, so that every program refuses a bad number in the same words: "--eps: -1, expected a finite
/// number >= 0".
namespace maximin::apps {

/// A finite number from `low` to `high`; `below` leaves `high` itself out, `above` leaves `low` itself out.
struct RealRange {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool above = false;
  bool below = false;
};

/// Accepts a decimal number in the range.
CLI::Validator real_number(const RealRange& range = {});

/// Accepts a whole number from `low` to `high`, in digits.
CLI::Validator whole_number(long low, long high = std::numeric_limits<long>::max());

/// Accepts one of the words; refuses all others, naming the nearest.
CLI::Validator one_of(const std::vector<std::string>& words);

}  // namespace maximin::apps
