#include "discount.hpp"

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include <maximin/apps/common/program.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {
namespace {

[[noreturn]] void refuse(const std::string& text) {
  throw InputError(
      fmt::format("--gamma: \"{}\", expected a decimal or a fraction with 0 <= gamma < 1, e.g. 0.95 or 10/11 "
                  "(at most 15 digits)",
                  printable(text)));
}

bool is_digits(std::string_view text) {
  return !text.empty() && text.size() <= 15 &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

std::int64_t whole(std::string_view digits) {
  std::int64_t value = 0;
  for (const char c : digits) value = 10 * value + (c - '0');
  return value;
}

std::int64_t power_of_ten(std::size_t exponent) {
  std::int64_t value = 1;
  for (std::size_t k = 0; k < exponent; ++k) value *= 10;
  return value;
}

}  // namespace

non_contraction::Fraction parse_discount(const std::string& text) {
  const std::string_view all = text;
  const auto mark = all.find_first_of("./");
  const std::string_view left = all.substr(0, mark);
  const std::string_view right = mark == std::string_view::npos ? "1" : all.substr(mark + 1);
  const bool decimal = mark != std::string_view::npos && all[mark] == '.';
  if (!is_digits(right) || !(is_digits(left) || (decimal && left.empty()))) refuse(text);
  if (decimal && whole(left) != 0) refuse(text);
  const std::int64_t denominator = decimal ? power_of_ten(right.size()) : whole(right);
  if (denominator == 0) refuse(text);
  const non_contraction::Fraction gamma(decimal ? whole(right) : whole(left), denominator);
  if (!(gamma < non_contraction::Fraction(1))) refuse(text);
  return gamma;
}

std::string fraction_text(const non_contraction::Fraction& value) {
  if (value.denominator() == 1) return std::to_string(value.numerator());
  return fmt::format("{}/{}", value.numerator(), value.denominator());
}

}  // namespace maximin::apps
