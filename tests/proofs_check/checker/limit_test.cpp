#include <gtest/gtest.h>

#include <maximin/proofs_check/checker/sections.hpp>

namespace maximin::checker {
namespace {

using nlohmann::json;

/// A limit of period 1 in a model of discount 0, where Q^0 is R, and so is Q_N: states on a line, 1 apart, eps 1, that
/// never move. Every entry is a class of its own unless classes are given.
class OneShot {
 public:
  OneShot(const char* rewards, const char* orbit, const char* classes = nullptr)
      : rewards_(json::parse(rewards)), orbit_(json::parse(orbit)) {
    std::size_t next = 0;
    for (const json& row : rewards_) {
      classes_.push_back(json::array());
      for (std::size_t a = 0; a < row.size(); ++a) classes_.back().push_back(next++);
    }
    if (classes != nullptr) classes_ = json::parse(classes);
  }

  /// The line that it is refused with at that radius; empty where it is not.
  std::string refusal(const char* radius, const Rational& q_n_above = 0, bool highest = false) const {
    static const Limits limits;
    const json parsed = json::parse(model_text());
    const Model model = read_model(Node(parsed, "$.model", limits), limits.states);
    Table last = model.rewards;
    for (Integer& top : last.top) top *= 100;
    last.bottom *= 100;
    last.top[0] += q_n_above * last.bottom;
    json limit = json::parse(R"({"period": 1})");
    limit["radius"] = radius;
    limit["classes"] = classes_;
    for (const char* name : {"orbit", "low", "fixed"}) limit[name] = json::array({orbit_});
    limit = json::parse(limit.dump());
    try {
      check_limit(Node(limit, "$.limit", limits), model, last, highest);
      return {};
    } catch (const Refused& refused) {
      return refused.what();
    }
  }

 private:
  std::string model_text() const {
    json model = json::parse(R"({"format": "maximin-mdp", "version": 1, "discount": "0", "eps": "1", "norm": "l1"})");
    model["states"] = rewards_.size();
    model["actions"] = rewards_[0].size();
    model["rewards"] = rewards_;
    for (std::size_t s = 0; s < rewards_.size(); ++s) {
      model["points"].push_back(json::array({std::to_string(s)}));
      for (std::size_t a = 0; a < rewards_[s].size(); ++a) {
        model["transitions"].push_back(json::array({s, a, s, "1"}));
      }
    }
    return model.dump();
  }

  json rewards_, orbit_, classes_;
};

void expect_start(const std::string& line, const std::string& start) {
  EXPECT_EQ(line.substr(0, start.size()), start) << line;
}

/// Both actions are worth 0 in the worst case, which is state 1, but not the same at state 0.
TEST(Limit, Condition1CandidatesHaveOneBackup) {
  const OneShot apart(R"([["0", "5"], ["0", "0"]])", R"(["0", "0"])");
  const OneShot same(R"([["0", "0"], ["0", "0"]])", R"(["0", "0"])");
  EXPECT_EQ(same.refusal("1"), "");
  expect_start(apart.refusal("1"),
               "$.limit.orbit[0][0]: 0, expected 5, the least over the ball of the greatest candidate");
  const OneShot wrong_values(R"([["0", "0"], ["0", "0"]])", R"(["0", "1"])");
  expect_start(wrong_values.refusal("1"), "$.limit.orbit[0][1]: 1, expected 0");
}

/// At state 1 the attacker shows 0 for action 0, worth 0; showing 2 would make action 1, worth 1.
TEST(Limit, Condition2NoOtherActionIsNear) {
  const OneShot limit(R"([["0", "-90"], ["0", "1"], ["-100", "1"]])", R"(["-90", "0", "1"])");
  EXPECT_EQ(limit.refusal("49/100"), "");
  expect_start(limit.refusal("1/2"), "$.limit.orbit[0][1]: action 1, shown state 1, is above it by 2 radius or less");
}

TEST(Limit, Condition3TheRoundsReachTheOrbit) {
  const OneShot limit(R"([["0", "-90"], ["0", "1"], ["-100", "1"]])", R"(["-90", "0", "1"])");
  EXPECT_EQ(limit.refusal("1/4", Rational(1, 4)), "");
  EXPECT_EQ(limit.refusal("1/4", Rational(-1, 4)), "");
  expect_start(limit.refusal("1/4", Rational(26, 100)), "$.limit.radius: 1/4, expected at least 13/50");
  expect_start(limit.refusal("1/4", Rational(-26, 100)), "$.limit.radius: 1/4, expected at least 13/50");
  expect_start(limit.refusal("0"), "$.limit.radius: 0, expected a number above 0");
}

/// Action 0 is the best everywhere, and worth the same, so that the two states are as one.
TEST(Limit, Condition4EntriesOfAClassAreAlike) {
  const OneShot alike(R"([["0", "-1"], ["0", "-9"]])", R"(["0", "0"])", "[[0, 1], [0, 2]]");
  EXPECT_EQ(alike.refusal("1/4"), "");
  expect_start(alike.refusal("1/4", Rational(1, 100)), "$.limit.classes[1][0]: unlike the first of its class");
  const OneShot other_rewards(R"([["0", "-1"], ["0", "-9"]])", R"(["0", "0"])", "[[0, 1], [0, 1]]");
  expect_start(other_rewards.refusal("1/4"), "$.limit.classes[1][1]: unlike the first of its class");
  const OneShot other_successors(R"([["0", "-5"], ["1", "-5"]])", R"(["0", "1"])", "[[0, 1], [2, 1]]");
  expect_start(other_successors.refusal("1/4"), "$.limit.classes[1][1]: an entry that moves unlike the first");
  const OneShot numbers(R"([["0", "-1"], ["0", "-9"]])", R"(["0", "0"])", "[[0, 2], [0, 1]]");
  expect_start(numbers.refusal("1/4"), "$.limit.classes[0][1]: 2, expected an integer from 0 to 1");
}

/// Both actions are worth 0, and action 1 never less than action 0, for the entries at state 1 are of one class.
TEST(Limit, ATieGoesToTheFirstWhereItIsNeverWorse) {
  const char* rewards = R"([["0", "5"], ["0", "0"]])";
  const OneShot limit(rewards, R"(["5", "0"])", "[[0, 1], [2, 2]]");
  EXPECT_EQ(limit.refusal("1", 0, true), "");
  expect_start(limit.refusal("1", 0, false), "$.limit.orbit[0][0]: 5, expected 0");
  const OneShot without(rewards, R"(["5", "0"])");
  expect_start(without.refusal("1", 0, true), "$.limit.orbit[0][0]: 5, expected 0");
}

}  // namespace
}  // namespace maximin::checker
