#include <maximin/proofs_check/trial_record.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <maximin/theory/error.hpp>

#include "small_records.hpp"

namespace maximin {
namespace {

using Json = nlohmann::ordered_json;

TEST(TrialRecord, ReadsBackAsItWasWritten) {
  for (const TrialRecord& record : small_records(40)) {
    const Json json = to_json(record);
    const TrialRecord back = trial_record_from_json(Json::parse(json.dump()));
    EXPECT_EQ(to_json(back).dump(), json.dump());
    EXPECT_EQ(back.trial, record.trial);
    EXPECT_EQ(back.family, record.family);
    EXPECT_EQ(back.found.discount, record.found.discount);
    EXPECT_EQ(back.found.constants.l_p.value, record.found.constants.l_p.value);
    EXPECT_EQ(back.found.fate, record.found.fate);
    for (const Claim& c : claims()) {
      EXPECT_EQ(back.found.check(c.id).verdict, record.found.check(c.id).verdict);
      EXPECT_EQ(back.found.check(c.id).left, record.found.check(c.id).left);
      EXPECT_EQ(back.found.informative(c.id), record.found.informative(c.id));
    }
  }
}

TEST(TrialRecord, WhatIsNotFiniteBecomesNull) {
  TrialRecord record{7, "none", {}};
  record.found.gap = std::numeric_limits<double>::quiet_NaN();
  record.found.trivial = std::numeric_limits<double>::infinity();
  Check& check = record.found.check(ClaimId::e_test_time);
  check.observe(std::numeric_limits<double>::infinity(), 1, 0);
  record.found.check(ClaimId::f_belief).verdict = Verdict::undetermined;
  const Json json = to_json(record);
  EXPECT_TRUE(json["gap"].is_null());
  EXPECT_TRUE(json["trivial"].is_null());
  EXPECT_TRUE(json["claims"]["E"]["left"].is_null());
  EXPECT_TRUE(json["claims"]["F"]["least_right"].is_null()) << "no instance yet";
  EXPECT_FALSE(json["claims"].contains("lemma-1")) << "not asked";
  const TrialRecord back = trial_record_from_json(json);
  EXPECT_TRUE(std::isnan(back.found.gap));
  EXPECT_EQ(back.found.check(ClaimId::e_test_time).verdict, Verdict::violated);
  EXPECT_EQ(back.found.check(ClaimId::e_test_time).tightness(), check.tightness());
  EXPECT_EQ(back.found.check(ClaimId::lemma_1).verdict, Verdict::not_asked);
  EXPECT_FALSE(back.found.informative(ClaimId::f_belief));
  EXPECT_EQ(to_json(back).dump(), json.dump());
}

TEST(TrialRecord, KeysComeInAFixedOrder) {
  const Json json = to_json(small_records(1).front());
  EXPECT_EQ(json.begin().key(), "trial");
  EXPECT_EQ(std::next(json.begin()).key(), "family");
  EXPECT_EQ(json["claims"].begin().key(), "lemma-1");
}

TEST(TrialRecord, RefusesWhatIsNone) {
  const Json good = to_json(small_records(1).front());
  const auto refused = [&](auto spoil) {
    Json bad = good;
    spoil(bad);
    try {
      trial_record_from_json(bad);
    } catch (const std::exception& e) {
      return std::string(e.what()).find('\n') == std::string::npos;
    }
    return false;
  };
  EXPECT_TRUE(refused([](Json& j) { j.erase("trial"); }));
  EXPECT_TRUE(refused([](Json& j) { j.erase("gap"); }));
  EXPECT_TRUE(refused([](Json& j) { j["trial"] = "one"; }));
  EXPECT_TRUE(refused([](Json& j) { j["gap"] = "wide"; }));
  EXPECT_TRUE(refused([](Json& j) { j["fate"] = "sealed"; }));
  EXPECT_TRUE(refused([](Json& j) { j["claims"]["Z"] = j["claims"]["E"]; }));
  EXPECT_TRUE(refused([](Json& j) { j["claims"]["E"]["verdict"] = "maybe"; }));
  EXPECT_TRUE(refused([](Json& j) { j["claims"]["E"].erase("slack"); }));
  EXPECT_TRUE(refused([](Json& j) { j = Json::array(); }));
}

TEST(TrialRecord, VerdictsFatesAndReadingsHaveNames) {
  EXPECT_EQ(to_string(Verdict::holds), "holds");
  EXPECT_EQ(to_string(Verdict::violated), "violated");
  EXPECT_EQ(to_string(Verdict::undetermined), "undetermined");
  EXPECT_EQ(to_string(Verdict::assumption_fails), "assumption fails");
  EXPECT_EQ(to_string(Verdict::not_asked), "not asked");
  EXPECT_EQ(to_string(Fate::settled), "settled");
  EXPECT_EQ(to_string(Fate::cycles), "cycles");
  EXPECT_EQ(to_string(Fate::undetermined), "undetermined");
  EXPECT_EQ(to_string(Reading::paper), "paper");
  EXPECT_EQ(to_string(Reading::corrected), "corrected");
}

}  // namespace
}  // namespace maximin
