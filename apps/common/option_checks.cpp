#include <maximin/apps/common/option_checks.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <filesystem>

#include <maximin/apps/common/program.hpp>
#include <maximin/models/files/internal/number.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

/// The whole text as a number of type T, if it is one.
template <class T>
bool parse(const std::string& text, T& value) {
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  return error == std::errc() && stop == end;
}

/// The whole text as a number in decimal digits, if it is one. A leading zero is none: CLI11 reads it as octal.
template <class T>
bool parse_whole(const std::string& text, T& value) {
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  return parse(text, value) && (text.size() == sign + 1 || text[sign] != '0');
}

/// What to add to a refusal of a number that only its leading zero spoils.
std::string leading_zero(const std::string& text) {
  return text.size() > 1 && text[0] == '0' && text.find_first_not_of("0123456789") == std::string::npos
             ? " without leading zeros"
             : "";
}

bool contains(const RealRange& range, double x) {
  return std::isfinite(x) && (range.above ? x > range.low : x >= range.low) &&
         (range.below ? x < range.high : x <= range.high);
}

template <class Scalar>
Scalar number_of(const std::string& text) {
  Scalar x(0);
  const internal::NumberFault fault = internal::parse_number(text, x);
  if (fault != internal::NumberFault::none) throw InputError(internal::describe_fault(fault, "number", text));
  return x;
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
    if (parse(text, x) && contains(range, x)) return {};
    return fmt::format("{}, expected a finite number{}", text, describe(range));
  };
  return CLI::Validator(check, "");
}

CLI::Validator number_or_fraction(const RealRange& range) {
  const auto check = [range](std::string& text) -> std::string {
    double x = 0;
    Rational exact(0);
    const bool readable = internal::parse_number(text, x) == internal::NumberFault::none &&
                          internal::parse_number(text, exact) == internal::NumberFault::none;
    if (readable && contains(range, x)) return {};
    return fmt::format("{}, expected a finite number{} or a fraction such as 1/3", text, describe(range));
  };
  return CLI::Validator(check, "");
}

double nearest_number(const std::string& text) {
  return number_of<double>(text);
}

Rational exact_number(const std::string& text) {
  return number_of<Rational>(text);
}

CLI::Validator whole_number(long low, long high) {
  const auto check = [low, high](std::string& text) -> std::string {
    long n = 0;
    if (parse_whole(text, n) && n >= low && n <= high) return {};
    if (high == std::numeric_limits<long>::max())
      return fmt::format("{}, expected a whole number{} >= {}", text, leading_zero(text), low);
    return fmt::format("{}, expected a whole number{} from {} to {}", text, leading_zero(text), low, high);
  };
  return CLI::Validator(check, "");
}

CLI::Validator seed_number() {
  const auto check = [](std::string& text) -> std::string {
    std::uint64_t n = 0;
    if (parse_whole(text, n)) return {};
    return fmt::format("{}, expected a whole number{} from 0 to 2^64-1", text, leading_zero(text));
  };
  return CLI::Validator(check, "");
}

CLI::Validator existing_folder() {
  const auto check = [](std::string& text) -> std::string {
    std::error_code error;
    if (std::filesystem::is_directory(text, error)) return {};
    return fmt::format("{}: no such folder, expected one that exists", text);
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

void refuse_given(const CLI::App& app, const std::vector<std::string>& options, const std::string& where,
                  const std::string& expected) {
  for (const std::string& option : options) {
    if (app.count(option) == 0) continue;
    throw InputError(fmt::format("{}: has no effect {}, expected {}", option, where, expected));
  }
}

}  // namespace maximin::apps
