#include <gtest/gtest.h>

#include <sstream>

#include "sample_certificates.hpp"

namespace maximin::testing {
namespace {

/// The certificate of the one-sided counterexample as text, with one piece of it replaced.
std::string edited(const std::string& from, const std::string& to) {
  std::string text = sample_certificates().at("one_sided_paper").dump();
  const std::size_t at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

void expect_refused(const std::string& text, const std::string& start, const checker::Limits& limits = {}) {
  const std::string line = refusal(text, limits);
  EXPECT_EQ(line.substr(0, start.size()), start) << line;
  EXPECT_EQ(line.find('\n'), line.npos);
  EXPECT_LT(line.size(), 300U);
}

TEST(StrictJson, WhatIsNoJsonIsRefused) {
  for (const char* text : {"", "{", "[1,", "nul", "\"\xff\"", "{\"a\": 1e999}", "{} {}", "{'a': 1}", "// no\n{}"}) {
    EXPECT_NE(refusal(text), "") << text;
  }
  expect_refused("[]", "$: an array, expected an object");
  expect_refused("7", "$: 7, expected an object");
}

TEST(StrictJson, NothingButWhiteSpaceIsAroundIt) {
  const std::string text = sample_certificates().at("one_sided_paper").dump();
  EXPECT_EQ(refusal(" \t\r\n" + text + " \t\r\n"), "");
  expect_refused("\xef\xbb\xbf" + text, "$: a byte-order mark, expected one JSON object");
  expect_refused(text + '\0', "$: no JSON at byte " + std::to_string(text.size() + 1) + ", expected one JSON object");
  expect_refused(text + " \n" + '\0' + "more", "$: no JSON at byte " + std::to_string(text.size() + 3));
  expect_refused('\0' + text, "$: no JSON at byte 1,");
  for (const char* more : {"x", "\f", "\v", "\xc2\xa0", "\xef\xbb\xbf", "\x1a"}) {
    EXPECT_NE(refusal(text + more), "") << more;
    EXPECT_NE(refusal(more + text), "") << more;
  }
}

TEST(StrictJson, RepeatedNamesAreRefused) {
  expect_refused(edited("\"version\":1", "\"version\":1,\"version\":1"), "$.model.version: given twice");
  expect_refused(edited("\"radius\":", "\"radius\":\"1\",\"radius\":"), "$.limit.radius: given twice");
}

TEST(StrictJson, FractionsOfJsonAreRefused) {
  expect_refused(edited("\"states\":3", "\"states\":3.0"), "$.model.states: neither an integer nor a string");
  expect_refused(edited("\"discount\":\"1/2\"", "\"discount\":0.5"), "$.model.discount: neither an integer");
  expect_refused(edited("[0,0,0,\"1\"]", "[0,0,0.0,\"1\"]"), "$.model.transitions[0][2]: neither an integer");
  expect_refused(edited("\"discount\":\"1/2\"", "\"discount\":0"),
                 "$.model.discount: 0, expected an integer or a fraction");
}

TEST(StrictJson, DepthIsBounded) {
  expect_refused(std::string(1'000'000, '['), "$[0][0][0][0][0][0][0][0]: too deep");
  std::string objects;
  for (int i = 0; i < 100'000; ++i) objects += "{\"a\":";
  expect_refused(objects, "$.a.a.a.a.a.a.a.a: too deep");
}

TEST(StrictJson, SizesAreBoundedBeforeAnythingIsMade) {
  expect_refused(edited("\"states\":3", "\"states\":1000000000000000000"), "$.model.states: 1000000000000000000");
  expect_refused(edited("\"states\":3", "\"states\":99999999999999999999999"), "$.model.states: neither");
  expect_refused(edited("\"states\":3", "\"states\":-3"), "$.model.states: -3");
  expect_refused(edited("\"states\":3", "\"states\":0"), "$.model.states: 0");
  expect_refused(edited("\"actions\":2", "\"actions\":200000000"), "$.model.rewards[0]: 2 items, expected 200000000");
  expect_refused(edited("\"eps\":\"1\"", "\"eps\":\"" + std::string(1'000'001, '1') + "\""),
                 "$.model.eps: 1000001 characters, expected at most 1000000");
  EXPECT_NE(refusal(edited("\"eps\":\"1\"", "\"eps\":\"" + std::string(1'000'000, '1') + "\"")), "");
  checker::Limits small;
  small.bytes = 100;
  EXPECT_EQ(refusal(edited("\"states\":3", "\"states\":3"), small).substr(0, 3), "$: ");
  std::istringstream endless(std::string(1 << 20, ' '));
  EXPECT_THROW(checker::check(endless, small), checker::Refused);
  small = {};
  small.table_bits = 319;  // there are 5 members of balls
  expect_refused(edited("\"states\":3", "\"states\":3"), "$.model.eps: balls that take too much memory", small);
  small.table_bits = 400;
  const std::string fine = edited("\"discount\":\"1/2\"", "\"discount\":\"1/1" + std::string(29, '0') + "\"");
  EXPECT_NE(refusal(fine, small).find("bits each, expected less"), std::string::npos);
  small = {};
  small.work = 100;
  expect_refused(edited("\"states\":3", "\"states\":3"), "$.rounds: more work than this checker takes on", small);
}

TEST(StrictJson, MembersAreThoseOfTheFormat) {
  expect_refused(edited("\"tie\":\"lowest\",", ""), "$.tie: missing");
  expect_refused(edited("\"tie\":", "\"tie \":"), "$.tie: missing");
  expect_refused(edited("\"tie\":", "\"more\":1,\"tie\":"), "$: \"more\" is no member");
  expect_refused(edited("\"eps\":\"1\",", ""), "$.model.eps: missing");
  expect_refused(edited("\"tie\":\"lowest\"", "\"tie\":\"low\\nest\""),
                 "$.tie: \"low?est\", expected \"lowest\" or \"highest\"");
}

}  // namespace
}  // namespace maximin::testing
