#include <maximin/proofs_check/checker/exact.hpp>

#include <gtest/gtest.h>

namespace maximin::checker {
namespace {

TEST(ParseNumber, TakesIntegersAndFractionsInLowestTerms) {
  for (const char* text : {"0", "-1", "12", "1/3", "-7/2", "123456789012345678901234567890/7919"}) {
    const auto value = parse_number(text);
    ASSERT_TRUE(value) << text;
    EXPECT_EQ(value->get_str(), text);
  }
  EXPECT_EQ(*parse_number("-12/5"), Rational(-12, 5));
}

TEST(ParseNumber, TakesNoOtherForm) {
  for (const char* text : {"",    "-",   "+1",   "-0",    "00",   "01",  "1.0",  "1e3",  " 1",      "1 ",
                           "1/",  "/2",  "1/1",  "2/4",   "0/2",  "1/0", "1/-2", "1//2", "1/02",    "--1",
                           "0x1", "1_0", "-0/3", "1/2/3", "1/ 2", "\t1", "1\n",  "inf",  "\xd9\xa1"}) {
    EXPECT_FALSE(parse_number(text)) << '"' << text << '"';
  }
  EXPECT_FALSE(parse_number(std::string_view("1\0002", 3)));
}

/// What the page says of d- and d+, put to a root.
void expect_enclosed(const Rational& q) {
  const Rational step(1, Integer(1) << 64);
  const Root r = root(q);
  const Rational next = r.low + step;
  EXPECT_EQ(Integer(r.low / step).get_str(), Rational(r.low / step).get_str()) << "no multiple of 2^-64: " << q;
  EXPECT_LE(r.low * r.low, q);
  EXPECT_GT(next * next, q);
  EXPECT_EQ(r.exact, r.low * r.low == q) << q;
}

TEST(Root, EnclosesToAMultipleOfTwoToTheMinus64) {
  for (const auto& q :
       {Rational(0), Rational(1), Rational(2), Rational(25), Rational(1, 4), Rational(9, 16), Rational(1, 9),
        Rational(1, 3), Rational(Integer("1" + std::string(60, '0'))), Rational(1, Integer(1) << 128),
        Rational(1, Integer(1) << 130), Rational(3, Integer(1) << 129)}) {
    expect_enclosed(q);
    expect_enclosed(q + Rational(1, Integer(1) << 200));
  }
}

TEST(Root, KnowsExactSquares) {
  EXPECT_TRUE(root(25).exact);
  EXPECT_EQ(root(Rational(9, 16)).low, Rational(3, 4));
  EXPECT_FALSE(root(Rational(1, 9)).exact) << "1/3 is no multiple of 2^-64";
  EXPECT_FALSE(root(2).exact);
  const Root least = root(Rational(1, Integer(1) << 128));
  EXPECT_TRUE(least.exact);
  EXPECT_EQ(least.low, Rational(1, Integer(1) << 64));
  EXPECT_EQ(root(Rational(1, Integer(1) << 129)).low, 0) << "what is nearer than 2^-64 has d- = 0";
}

TEST(Tables, StandOverOneDenominator) {
  const Table x = *over_one_denominator({Rational(1, 6), Rational(-3, 4), 0}, 1000);
  EXPECT_EQ(x.bottom, 12);
  EXPECT_EQ(x[0], Rational(1, 6));
  EXPECT_EQ(x[1], Rational(-3, 4));
  const Table y = *over_one_denominator({Rational(1, 5), Rational(-3, 4), -1}, 1000);
  EXPECT_LT(compare(x, 0, y, 0), 0);
  EXPECT_EQ(compare(x, 1, y, 1), 0);
  EXPECT_GT(compare(x, 2, y, 2), 0);
  const Table z = difference(x, y);
  EXPECT_EQ(z[0], Rational(-1, 30));
  EXPECT_EQ(z[1], 0);
  EXPECT_EQ(largest(z), 2U);
  EXPECT_EQ(largest(absolute(difference(y, x))), 2U);
}

TEST(Tables, TooLargeAreNotMade) {
  const Rational fine(1, Integer(1) << 100);
  EXPECT_TRUE(over_one_denominator({fine, fine}, 202));
  EXPECT_FALSE(over_one_denominator({fine, fine}, 201));
}

TEST(Shown, IsShort) {
  EXPECT_EQ(shown(Rational(-1, 3)), "-1/3");
  EXPECT_LT(shown(Rational(1, Integer("1" + std::string(5000, '0')))).size(), 80U);
}

}  // namespace
}  // namespace maximin::checker
