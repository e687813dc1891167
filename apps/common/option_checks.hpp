#pragma once

#include <CLI/CLI.hpp>
#include <limits>
#include <string>
#include <vector>

#include <maximin/theory/rational.hpp>

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

/// Accepts a decimal or a fraction such as 1/3 whose nearest double is in the range. Its value must be a string, which
/// `nearest_number` and `exact_number` read.
CLI::Validator number_or_fraction(const RealRange& range = {});

/// The double nearest to such a number. Both throw InputError on any other text.
double nearest_number(const std::string& text);

/// Such a number itself.
Rational exact_number(const std::string& text);

/// Accepts a whole number from `low` to `high`, in decimal digits without leading zeros, which would be read as octal.
CLI::Validator whole_number(long low, long high = std::numeric_limits<long>::max());

/// Accepts a seed: a whole number from 0 to 2^64-1, in decimal digits without leading zeros.
CLI::Validator seed_number();

/// Accepts the name of a folder that exists.
CLI::Validator existing_folder();

/// Accepts one of the words; refuses all others, naming the nearest.
CLI::Validator one_of(const std::vector<std::string>& words);

/// Refuses the options of the list that were given on the command line of `app`: "--seed: has no effect beside --model,
/// expected ...", where `where` is "beside --model". Throws InputError.
void refuse_given(const CLI::App& app, const std::vector<std::string>& options, const std::string& where,
                  const std::string& expected);

}  // namespace maximin::apps
