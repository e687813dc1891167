#include <maximin/models/files/internal/number.hpp>

#include <algorithm>

namespace maximin::internal {

namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view take_digits(std::string_view& text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  const std::string_view digits = text.substr(0, static_cast<std::size_t>(end - text.begin()));
  text.remove_prefix(digits.size());
  return digits;
}

bool take(std::string_view& text, std::string_view any_of) {
  if (text.empty() || any_of.find(text.front()) == std::string_view::npos) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

std::string describe_fault(NumberFault fault, std::string_view name, std::string_view token) {
  switch (fault) {
    case NumberFault::zero_denominator:
      return fmt::format("{} {}: denominator 0, expected a fraction such as 1/3", name, in_quotes(token));
    case NumberFault::out_of_range:
      return fmt::format("{} {}: out of range, expected a finite number", name, in_quotes(token));
    default:
      return fmt::format("{} {}: not a number, expected an integer, a decimal or a fraction such as 1/3", name,
                         in_quotes(token));
  }
}

std::optional<NumberText> split_number(std::string_view token) {
  NumberText number;
  if (!token.empty() && token.front() == '-') number.negative = true;
  take(token, "+-");
  number.unsigned_text = token;
  number.whole = take_digits(token);
  if (take(token, "/")) {
    number.denominator = take_digits(token);
    if (number.whole.empty() || number.denominator.empty() || !token.empty()) return std::nullopt;
    return number;
  }
  if (take(token, ".")) number.fraction = take_digits(token);
  if (number.whole.empty() && number.fraction.empty()) return std::nullopt;
  if (take(token, "eE")) {
    const bool negative = !token.empty() && token.front() == '-';
    take(token, "+-");
    const std::string_view digits = take_digits(token);
    if (digits.empty()) return std::nullopt;
    constexpr std::int64_t widest = 1'000'000'000'000;
    for (const char c : digits) number.exponent = std::min(widest, number.exponent * 10 + (c - '0'));
    if (negative) number.exponent = -number.exponent;
  }
  if (!token.empty()) return std::nullopt;
  return number;
}

std::optional<std::uint64_t> parse_count(std::string_view token) {
  if (token.empty() || !std::all_of(token.begin(), token.end(), is_digit)) return std::nullopt;
  std::uint64_t value = 0;
  const auto result = std::from_chars(token.data(), token.data() + token.size(), value);
  return result.ec == std::errc::result_out_of_range ? std::numeric_limits<std::uint64_t>::max() : value;
}

NumberFault parse_decimal(const NumberText& number, double& out) {
  const char* const end = number.unsigned_text.data() + number.unsigned_text.size();
  const auto result = std::from_chars(number.unsigned_text.data(), end, out);
  if (result.ec != std::errc::result_out_of_range) return NumberFault::none;
  // Too large or too small: the place of the first non-zero digit tells.
  const std::size_t zeros = std::min(number.whole.find_first_not_of('0'), number.whole.size());
  std::int64_t magnitude = static_cast<std::int64_t>(number.whole.size() - zeros) + number.exponent;
  if (zeros == number.whole.size()) {
    magnitude -= static_cast<std::int64_t>(std::min(number.fraction.find_first_not_of('0'), number.fraction.size()));
  }
  if (magnitude > 0) return NumberFault::out_of_range;
  out = 0;
  return NumberFault::none;
}

}  // namespace maximin::internal
