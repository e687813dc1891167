#include "exact.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace maximin::checker {
namespace {

/// Digits without a leading zero, or "0".
bool is_natural(std::string_view text) {
  return !text.empty() && (text[0] != '0' || text.size() == 1) &&
         std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
}

/// Six significant digits.
std::string digits(const Rational& x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6g", x.get_d());
  return text.data();
}

}  // namespace

std::optional<Rational> parse_number(std::string_view text) {
  const bool negative = text.substr(0, 1) == "-";
  if (negative) text.remove_prefix(1);
  const std::size_t slash = text.find('/');
  const std::string_view above = text.substr(0, slash);
  const std::string_view below = slash == text.npos ? "1" : text.substr(slash + 1);
  if (!is_natural(above) || !is_natural(below) || (negative && above == "0")) return {};
  Rational x(Integer(std::string(above), 10), Integer(std::string(below), 10));
  if (slash != text.npos && (x.get_den() <= 1 || gcd(x.get_num(), x.get_den()) != 1)) return {};
  if (negative) x = -x;
  return x;
}

std::string shown(const Rational& x) {
  constexpr std::size_t room = 40;
  const std::string text = x.get_str();
  return text.size() <= room ? text : "about " + digits(x) + " (" + std::to_string(text.size()) + " characters)";
}

Root root(const Rational& q) {
  const Integer low = sqrt(Integer((q.get_num() << 128U) / q.get_den()));
  Rational result(low, Integer(1) << 64U);
  result.canonicalize();
  return {result, result * result == q};
}

Rational Table::operator[](std::size_t i) const {
  Rational x(top[i], bottom);
  x.canonicalize();
  return x;
}

std::size_t bits(std::size_t entries, const Integer& bottom) {
  return entries * mpz_sizeinbase(bottom.get_mpz_t(), 2);
}

std::optional<Table> over_one_denominator(const std::vector<Rational>& numbers, std::size_t most_bits) {
  Table table;
  for (const Rational& x : numbers) {
    table.bottom = lcm(table.bottom, x.get_den());
    if (bits(numbers.size(), table.bottom) > most_bits) return {};
  }
  table.top.reserve(numbers.size());
  for (const Rational& x : numbers) table.top.emplace_back(table.bottom / x.get_den() * x.get_num());
  return table;
}

int compare(const Table& x, std::size_t i, const Table& y, std::size_t j) {
  return sgn(Integer(x.top[i] * y.bottom - y.top[j] * x.bottom));
}

Table difference(const Table& x, const Table& y) {
  Table result = x, other = y;
  align(result, other);
  for (std::size_t i = 0; i < x.size(); ++i) result.top[i] -= other.top[i];
  return result;
}

Table total(const Table& x, const Table& y) {
  Table result = x, other = y;
  align(result, other);
  for (std::size_t i = 0; i < x.size(); ++i) result.top[i] += other.top[i];
  return result;
}

void align(Table& x, Table& y) {
  const Integer bottom = lcm(x.bottom, y.bottom);
  for (Table* table : {&x, &y}) {
    const Integer factor = bottom / table->bottom;
    if (factor == 1) continue;
    for (Integer& top : table->top) top *= factor;
    table->bottom = bottom;
  }
}

std::size_t largest(const Table& x) {
  return static_cast<std::size_t>(std::max_element(x.top.begin(), x.top.end()) - x.top.begin());
}

Table absolute(Table x) {
  for (Integer& top : x.top) top = abs(top);
  return x;
}

}  // namespace maximin::checker
