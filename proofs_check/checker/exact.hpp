#pragma once

#include <gmpxx.h>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maximin::checker {

using Integer = mpz_class;
using Rational = mpq_class;

/// The number that a text stands for: "-12", or "1/3" in lowest terms. Nothing for any other text.
std::optional<Rational> parse_number(std::string_view text);

/// A number for messages: about, where it is long.
std::string shown(const Rational& x);

/// The largest multiple of 2^-64 that is not above the root of q >= 0, and whether it is the root.
struct Root {
  Rational low;
  bool exact;
};
Root root(const Rational& q);

/// Numbers over one denominator, so that nothing needs reducing while they are added and compared.
struct Table {
  std::vector<Integer> top;
  Integer bottom{1};

  std::size_t size() const { return top.size(); }
  Rational operator[](std::size_t i) const;
};

/// How many bits a table of so many entries over a denominator takes, about.
std::size_t bits(std::size_t entries, const Integer& bottom);

/// Nothing where the table would take more than so many bits.
std::optional<Table> over_one_denominator(const std::vector<Rational>& numbers, std::size_t most_bits);

/// The sign of x[i] - y[j].
int compare(const Table& x, std::size_t i, const Table& y, std::size_t j);

/// x - y, and x + y, entry by entry.
Table difference(const Table& x, const Table& y);
Table total(const Table& x, const Table& y);

/// Writes both over one denominator.
void align(Table& x, Table& y);

/// Where the largest entry stands.
std::size_t largest(const Table& x);

/// The table of absolute values.
Table absolute(Table x);

}  // namespace maximin::checker
