#pragma once

#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include <maximin/models/files/internal/source.hpp>
#include <maximin/theory/types.hpp>

/// The one place where text becomes a number and a number becomes text.
namespace maximin::internal {

/// What is wrong with the text of a number.
enum class NumberFault { none, syntax, zero_denominator, out_of_range };

/// "NAME 'TOKEN': what is wrong, expected ...".
std::string describe_fault(NumberFault fault, std::string_view name, std::string_view token);

/// The parts of `[+-] digits [. digits] [e [+-] digits]` or `[+-] digits / digits`.
struct NumberText {
  bool negative = false;
  std::string_view whole;        ///< digits before the point
  std::string_view fraction;     ///< digits after the point
  std::string_view denominator;  ///< digits after the slash; empty when there is none
  std::int64_t exponent = 0;     ///< held within +-10^12
  std::string_view unsigned_text;
};

/// Splits a number into its parts; nothing when it is not one. "nan", "inf" and hexadecimal are not numbers.
std::optional<NumberText> split_number(std::string_view token);

/// Reads a non-negative integer of plain digits; values beyond 2^64 - 1 are held there. Nothing for other text.
std::optional<std::uint64_t> parse_count(std::string_view token);

/// The nearest double of a decimal; values too small become 0.
NumberFault parse_decimal(const NumberText& number, double& out);

/// The value of a decimal for an exact scalar. Exponents beyond +-4096 are out of range: they would cost memory.
template <class Scalar>
NumberFault parse_decimal(const NumberText& number, Scalar& out) {
  constexpr std::int64_t widest = 4096;
  const std::int64_t exponent = number.exponent - static_cast<std::int64_t>(number.fraction.size());
  if (exponent > widest || exponent < -widest) return NumberFault::out_of_range;
  out = Scalar(0);
  for (const std::string_view digits : {number.whole, number.fraction}) {
    for (const char c : digits) out = Scalar(out * Scalar(10)) + Scalar(c - '0');
  }
  Scalar scale(1);
  for (std::int64_t i = 0; i < std::abs(exponent); ++i) scale *= Scalar(10);
  out = exponent < 0 ? Scalar(out / scale) : Scalar(out * scale);
  return NumberFault::none;
}

/// Reads an integer, a decimal with or without exponent, or a fraction of integers such as 1/3.
template <class Scalar>
NumberFault parse_number(std::string_view token, Scalar& out) {
  const std::optional<NumberText> number = split_number(token);
  if (!number) return NumberFault::syntax;
  if (number->denominator.empty()) {
    if (const NumberFault fault = parse_decimal(*number, out); fault != NumberFault::none) return fault;
  } else {
    Scalar denominator(0);
    const NumberText below{false, number->denominator, {}, {}, 0, number->denominator};
    const NumberText above{false, number->whole, {}, {}, 0, number->whole};
    if (const NumberFault fault = parse_decimal(above, out); fault != NumberFault::none) return fault;
    if (const NumberFault fault = parse_decimal(below, denominator); fault != NumberFault::none) return fault;
    if (denominator == Scalar(0)) return NumberFault::zero_denominator;
    out = Scalar(out / denominator);
  }
  if (number->negative) out = Scalar(-out);
  return NumberFault::none;
}

/// Reads a number or fails at that place of the source; `name` says what the number is, e.g. "reward".
template <class Scalar>
Scalar read_number(const Source& source, std::size_t at, std::string_view name, std::string_view token) {
  Scalar value(0);
  const NumberFault fault = parse_number(token, value);
  if (fault != NumberFault::none) source.fail(at, describe_fault(fault, name, token));
  return value;
}

/// The shortest text that reads back as the same value: at most 17 significant digits, or a fraction for an exact
/// scalar.
template <class Scalar>
std::string number_text(const Scalar& value) {
  if constexpr (is_exact_v<Scalar>) {
    std::ostringstream out;
    out << value;
    return out.str();
  } else {
    return fmt::format("{}", value);
  }
}

}  // namespace maximin::internal
