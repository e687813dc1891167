#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <bit>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>

#include <maximin/models/files/internal/number.hpp>

namespace maximin::internal {
namespace {

using Exact = boost::multiprecision::cpp_rational;

double value_of(std::string_view token) {
  double value = -1;
  EXPECT_EQ(parse_number(token, value), NumberFault::none) << token;
  return value;
}

Exact exact_value_of(std::string_view token) {
  Exact value = -1;
  EXPECT_EQ(parse_number(token, value), NumberFault::none) << token;
  return value;
}

TEST(Number, ReadsIntegersDecimalsExponentsAndFractions) {
  EXPECT_EQ(value_of("0"), 0);
  EXPECT_EQ(value_of("-12"), -12);
  EXPECT_EQ(value_of("+3"), 3);
  EXPECT_EQ(value_of("0.1"), 0.1);
  EXPECT_EQ(value_of(".5"), 0.5);
  EXPECT_EQ(value_of("5."), 5);
  EXPECT_EQ(value_of("1e-3"), 0.001);
  EXPECT_EQ(value_of("-1.5E+2"), -150);
  EXPECT_EQ(value_of("1/3"), 1.0 / 3.0);
  EXPECT_EQ(value_of("-2/5"), -0.4);
}

TEST(Number, HugeIsAnErrorAndTinyIsZero) {
  double value = -1;
  EXPECT_EQ(parse_number("1e999", value), NumberFault::out_of_range);
  EXPECT_EQ(parse_number("1" + std::string(400, '0'), value), NumberFault::out_of_range);
  EXPECT_EQ(parse_number("1e99999999999999999999999", value), NumberFault::out_of_range);
  EXPECT_EQ(value_of("1e-999"), 0);
  EXPECT_EQ(value_of("0." + std::string(400, '0') + "1"), 0);
  EXPECT_EQ(value_of("1e-99999999999999999999999"), 0);
  EXPECT_EQ(value_of("0e99999"), 0);
  EXPECT_EQ(value_of("5e-324"), std::numeric_limits<double>::denorm_min());
}

TEST(Number, RefusesWhatIsNotANumber) {
  for (const std::string_view token :
       {"",   "-",  ".",     "nan",   "inf",   "-inf", "NaN", "Infinity", "0x10", "1e", "1e+", "1.2.3",
        "1/", "/3", "1/3/5", "1/3.0", "1.0/3", "1/-3", "--1", "+-1",      "1 ",   " 1", "1,5"}) {
    double value = 0;
    EXPECT_EQ(parse_number(token, value), NumberFault::syntax) << token;
  }
  double value = 0;
  EXPECT_EQ(parse_number("1/0", value), NumberFault::zero_denominator);
}

// The same text means the exact value for an exact scalar.
TEST(Number, IsExactForAnExactScalar) {
  EXPECT_EQ(exact_value_of("1/3"), Exact(1, 3));
  EXPECT_EQ(exact_value_of("0.1"), Exact(1, 10));
  EXPECT_EQ(exact_value_of("-12.50e1"), Exact(-125));
  EXPECT_EQ(exact_value_of("3e-2"), Exact(3, 100));
  Exact value = 0;
  EXPECT_EQ(parse_number("1e1000000000", value), NumberFault::out_of_range);
}

TEST(Number, CountsHoldAtTheLargest) {
  EXPECT_EQ(parse_count("0"), 0U);
  EXPECT_EQ(parse_count("18446744073709551615"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(parse_count("99999999999999999999999"), std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(parse_count("-1"));
  EXPECT_FALSE(parse_count("1.0"));
  EXPECT_FALSE(parse_count(""));
}

RC_GTEST_PROP(Number, EveryDoubleReadsBackFromItsText, (std::uint64_t bits)) {
  const double value = std::bit_cast<double>(bits);
  RC_PRE(std::isfinite(value));
  RC_ASSERT(std::bit_cast<std::uint64_t>(value_of(number_text(value))) == bits);
}

TEST(Quotes, EscapeAndCut) {
  EXPECT_EQ(in_quotes("a\nb"), "'a\\x0ab'");
  EXPECT_EQ(in_quotes("\xff"), "'\\xff'");
  EXPECT_EQ(in_quotes("é"), "'é'");
  EXPECT_EQ(in_quotes(std::string(100, 'x')), "'" + std::string(40, 'x') + "...'");
}

TEST(Utf8, RefusesOverlongFormsSurrogatesAndCutSequences) {
  EXPECT_EQ(utf8_length("a"), 1U);
  EXPECT_EQ(utf8_length("é"), 2U);
  EXPECT_EQ(utf8_length("→"), 3U);
  EXPECT_EQ(utf8_length("\xF0\x9F\x98\x80"), 4U);
  for (const std::string_view bad : {"\xC0\x80", "\xE0\x80\x80", "\xED\xA0\x80", "\xF0\x80\x80\x80", "\xF4\x90\x80\x80",
                                     "\xF5\x80\x80\x80", "\xE2\x82", "\x80", "\xC3("}) {
    EXPECT_EQ(utf8_length(bad), 0U);
  }
}

}  // namespace
}  // namespace maximin::internal
