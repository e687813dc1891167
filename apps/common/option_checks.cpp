#include <maximin/apps/common/option_checks.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>

#include <maximin/apps/common/program.hpp>

namespace maximin::apps {

namespace {

/// The whole text as a number of type T, if it is one.
template <class T>
bool parse(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

std::string describe(const RealRange& range) {
  std::string text;
  if (std::isfinite(range.low)) text = fmt::format(" {} {}", range.above ? ">" : ">=", range.low);
  if (std::isfinite(range.high)) {
    text += fmt::format("{} {} {}", text.empty() ? "" : " and", range.below ? "<" : "<=", range.high);
  }
  return text;
}

}  // namespace

CLI::Validator real_number(const RealRange& range) {
  const auto check = [range](std::string& text) -> std::string {
    double x = 0;
    const bool inside = parse(text, x) && std::isfinite(x) && (range.above ? x > range.low : x >= range.low) &&
                        (range.below ? x < range.high : x <= range.high);
    return inside ? std::string() : fmt::format("{}, expected a finite number{}", text, describe(range));
  };
  return CLI::Validator(check, "");
}

CLI::Validator whole_number(long low, long high) {
  const auto check = [low, high](std::string& text) -> std::string {
    long n = 0;
    if (parse(text, n) && n >= low && n <= high) return {};
    if (high == std::numeric_limits<long>::max()) return fmt::format("{}, expected a whole number >= {}", text, low);
    return fmt::format("{}, expected a whole number from {} to {}", text, low, high);
  };
  return CLI::Validator(check, "");
}

CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto check = [words](std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    const std::string near = nearest_name(text, words);
    return fmt::format("{}, expected one of {}{}", text, fmt::join(words, ", "),
                       near.empty() ? "" : fmt::format("; did you mean {}?", near));
  };
  return CLI::Validator(check, "");
}

}  // namespace maximin::apps
