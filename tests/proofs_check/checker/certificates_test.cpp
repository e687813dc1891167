#include <gtest/gtest.h>

#include <tuple>
#include <vector>

#include "naive_certificate.hpp"
#include "sample_certificates.hpp"

namespace maximin::testing {
namespace {

using nlohmann::json;

class Certificate : public ::testing::TestWithParam<std::string> {};

TEST_P(Certificate, IsAccepted) {
  EXPECT_EQ(refusal(sample_certificates().at(GetParam()).dump()), "");
}

TEST_P(Certificate, IsTrueByDefinitionToo) {
  EXPECT_EQ(NaiveCertificate::untruth(sample_certificates().at(GetParam())), "");
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& entry : sample_certificates()) all.push_back(entry.first);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Samples, Certificate, ::testing::ValuesIn(names()),
                         [](const auto& sample) { return sample.param; });

TEST(Report, SaysWhatIsProved) {
  const auto report = checker::check(sample_certificates().at("one_sided_paper").dump());
  EXPECT_EQ(report.states, 3U);
  EXPECT_EQ(report.actions, 2U);
  EXPECT_EQ(report.rounds, 8U);
  EXPECT_EQ(report.period, 1U);
  ASSERT_EQ(report.claims.size(), 11U);
  EXPECT_EQ(report.claims[4].claim, "theorem-1");
  EXPECT_EQ(report.claims[4].verdict, "violated");
  EXPECT_EQ(report.claims[4].left, "10");
  EXPECT_EQ(report.claims[4].right, "6");
}

/// A certificate with one place changed, and how the line begins that refuses it.
struct Untruth {
  const char* certificate;
  const char* place;
  json value;
  const char* line;
};

void PrintTo(const Untruth& untruth, std::ostream* out) {
  *out << untruth.certificate << untruth.place << " = " << untruth.value;
}

class OneUntruth : public ::testing::TestWithParam<Untruth> {};

TEST_P(OneUntruth, IsRefusedAtItsPlace) {
  json certificate = sample_certificates().at(GetParam().certificate);
  certificate.at(json::json_pointer(GetParam().place)) = GetParam().value;
  const std::string line = refusal(certificate.dump()), start = GetParam().line;
  EXPECT_EQ(line.substr(0, start.size()), start) << line;
}

const char* const paper = "one_sided_paper";

INSTANTIATE_TEST_SUITE_P(
    Model, OneUntruth,
    ::testing::Values(
        Untruth{paper, "/format", "maximin-mdp",
                "$.format: \"maximin-mdp\", expected \"maximin-certificate\" or \"maximin-bounds\""},
        Untruth{paper, "/version", 2, "$.version: 2, expected an integer from 1 to 1"},
        Untruth{paper, "/model/discount", "1", "$.model.discount: 1, expected a number from 0 to below 1"},
        Untruth{paper, "/model/discount", "-1/2", "$.model.discount: -1/2"},
        Untruth{paper, "/model/eps", "-1", "$.model.eps: -1"},
        Untruth{paper, "/model/norm", "l3", "$.model.norm: \"l3\""},
        Untruth{paper, "/model/transitions/0/3", "1/2",
                "$.model.transitions: those of state 0, action 0 sum to 1/2, expected 1"},
        Untruth{paper, "/model/transitions/0/3", "0", "$.model.transitions[0][3]: 0, expected a number above 0"},
        Untruth{paper, "/model/transitions/1/1", 0, "$.model.transitions: those of state 0, action 0 sum to 2"},
        Untruth{paper, "/model/transitions/1", {0, 0, 0, "1"}, "$.model.transitions[1]: not above the one before it"},
        Untruth{paper, "/model/transitions/0/2", 3, "$.model.transitions[0][2]: 3, expected an integer from 0 to 2"},
        Untruth{paper, "/model/points/1", {"1", "0"}, "$.model.points[1]: 2 items, expected 1"},
        Untruth{paper, "/model/points/1", {"0"}, "$.constants.l_r: states 0 and 1 differ at distance 0"}));

INSTANTIATE_TEST_SUITE_P(
    Constants, OneUntruth,
    ::testing::Values(
        Untruth{paper, "/constants/l_r/value", "2", "$.constants.l_r.value: 2, expected 1"},
        Untruth{paper, "/constants/l_r/at", {0, 1}, "$.constants.l_r.at: 2 items, expected 3"},
        Untruth{paper, "/constants/l_r/at", {0, 1, 0, 0}, "$.constants.l_r.at: 4 items, expected 3"},
        Untruth{paper, "/constants/l_r/at", nullptr, "$.constants.l_r.at: expected null where the value is 0"},
        Untruth{paper, "/constants/l_r/at", {1, 0, 0}, "$.constants.l_r.at: expected states s < t"},
        Untruth{paper, "/constants/l_p/at", {0, 2, 0, 0}, "$.constants.l_p.at: expected a place that attains 1"},
        Untruth{paper, "/constants/l_p/at", {0, 1, 0, 1}, "$.constants.l_p.at: expected a place that attains 1"},
        Untruth{paper, "/constants/k/value", "1/2", "$.constants.k.value: 1/2, expected 1"},
        Untruth{paper, "/constants/l_star/at", {0, 1, 1}, "$.constants.l_star.at: expected a place that attains 21"},
        Untruth{paper, "/constants/r_min", "-19", "$.constants.r_min: -19, expected -20"},
        Untruth{paper, "/constants/r_max", "1", "$.constants.r_max: 1, expected 0"}));

INSTANTIATE_TEST_SUITE_P(
    Values, OneUntruth,
    ::testing::Values(
        Untruth{paper, "/optimal/1", "-1", "$.optimal[1]: -1, expected -3/2"},
        Untruth{paper, "/pairs/0/policy/1", 1, "$.pairs[0].robust[0]: 0, expected -20"},
        Untruth{paper, "/pairs/0/attack/2", 1, "$.pairs[0].attack[2]: 1, expected 2 of the policies of round 0"},
        Untruth{paper, "/pairs/1/fixed/0", "-19", "$.pairs[1].fixed[0]: -19"},
        Untruth{paper, "/pairs/1/robust/1", "-1", "$.pairs[1].robust[1]: -1, expected -3/2"},
        Untruth{paper, "/rounds/2", 0, "$.pairs[0].policy[0]: 0, expected 1 of the policies of round 2"},
        Untruth{paper, "/rounds/0", 1, "$.rounds[0]: a pair that skips pair 0"},
        Untruth{paper, "/rounds", json::array(), "$.rounds: no round"},
        Untruth{paper, "/tie", "highest", "$.pairs[0].policy[0]: 0, expected 1 of the policies of round 0"},
        Untruth{paper, "/test_time/policy/0", 0, "$.test_time.policy[0]: 0, expected 1"},
        Untruth{paper, "/test_time/robust/0", "-21", "$.test_time.robust[0]: -21"}));

INSTANTIATE_TEST_SUITE_P(
    Limit, OneUntruth,
    ::testing::Values(Untruth{paper, "/limit/period", 2, "$.limit.period: 2, expected an integer from 1 to 1"},
                      Untruth{paper, "/limit/orbit/0/2", "-41", "$.limit.radius: 1/3, expected at least"},
                      Untruth{paper, "/limit/low/0/0", "-19", "$.limit.low[0][0]: -19"},
                      Untruth{paper, "/limit/fixed/0/0", "-19", "$.limit.fixed[0][0]: -19"},
                      Untruth{paper, "/limit/fixed/0", nullptr, "$.limit.fixed[0]: null, expected the values"},
                      Untruth{paper, "/limit", nullptr, "$.claims[1].at.n: 8, expected an integer from 0 to 7"}));

INSTANTIATE_TEST_SUITE_P(
    Beliefs, OneUntruth,
    ::testing::Values(Untruth{paper, "/belief_game/positions/2/1/0", 0, "$.belief_game.positions[2]: not above"},
                      Untruth{paper,
                              "/belief_game/positions/3",
                              {2, {1, 2}},
                              "$.belief_game.positions: none of state 2 and belief {2}"},
                      Untruth{paper, "/belief_game/values/0", "-19", "$.belief_game.values[0]: -19"},
                      Untruth{paper, "/belief_game/reach", "2", "$.belief_game.reach: 2, expected 1"},
                      Untruth{paper, "/belief_game/exact", 1, "$.belief_game.exact: 1, expected true or false"},
                      Untruth{paper, "/belief_game", nullptr,
                              "$.claims[10].verdict: holds, expected undetermined: the belief game is null"}));

INSTANTIATE_TEST_SUITE_P(
    Claims, OneUntruth,
    ::testing::Values(
        Untruth{paper, "/reading", "corrected", "$.claims[0].verdict: violated, but the least right - left is 100"},
        Untruth{paper, "/claims/4/verdict", "holds", "$.claims[4].verdict: holds, but the least right - left is -4"},
        Untruth{paper, "/claims/4/left", "9", "$.claims[4].left: 9 against right 6"},
        Untruth{paper, "/claims/4/at/action", 1, "$.claims[4].at: no instance with these sides"},
        Untruth{paper, "/claims/4/at/n", 7, "$.claims[4].at: no instance with these sides"},
        Untruth{paper, "/claims/4/at/n", 9, "$.claims[4].at.n: 9, expected an integer from 0 to 8"},
        Untruth{paper, "/claims/4/at", json::object(), "$.claims[4].at.n: missing"},
        Untruth{paper, "/claims/4/claim", "A", "$.claims[5].claim: not after the one before it"},
        Untruth{paper, "/claims/4/claim", "G", "$.claims[4].claim: \"G\", expected \"lemma-1\" or"},
        Untruth{paper, "/claims/4/verdict", "undetermined", "$.claims[4]: \"at\" is no member of it"},
        Untruth{"plane_l2", "/claims/0/verdict", "violated",
                "$.claims[0].verdict: violated, expected it never under l2"}));

TEST(Claims, AreLeftOutOrUndeterminedFreely) {
  json certificate = sample_certificates().at(paper);
  certificate["claims"].erase(4);
  certificate["claims"][0] = {{"claim", "lemma-1"}, {"verdict", "undetermined"}};
  EXPECT_EQ(refusal(certificate.dump()), "");
  certificate["claims"] = json::array();
  EXPECT_EQ(refusal(certificate.dump()), "$.claims: empty, expected a claim at least");
}

TEST(Claims, ThatNeedTheLimitAreUndeterminedWithoutIt) {
  for (const std::size_t claim : {0, 1, 2, 4, 5, 6, 7, 8}) {
    json certificate = sample_certificates().at(paper);
    certificate["limit"] = nullptr;
    certificate["claims"] = json::array({certificate["claims"][claim]});
    certificate["claims"][0]["at"]["n"] = 0;
    const std::string line = refusal(certificate.dump());
    EXPECT_NE(line.find("$.claims[0].verdict: "), line.npos) << line;
    EXPECT_NE(line.find("expected undetermined: the limit is null"), line.npos) << line;
  }
}

/// Its sides are right, and its verdict too, but others are nearer to each other.
TEST(Claims, AnInstanceThatIsNotTheTightestIsRefused) {
  json certificate = sample_certificates().at(paper);
  json& a = certificate["claims"][5];
  EXPECT_EQ(a["claim"], "A");
  a["left"] = "0";
  a["at"]["states"] = json::array({1});
  a["at"]["action"] = 1;
  const std::string line = refusal(certificate.dump());
  EXPECT_EQ(line, "$.claims[5].left: 0 against right 726, expected the instance of least right - left, which is 716");
}

/// Any number low enough is a lower bound of the belief game, and then the loss is large; that violates nothing.
TEST(Claims, ABoundOfAValueProvesNoViolation) {
  json certificate = sample_certificates().at(paper);
  json &game = certificate["belief_game"], &f = certificate["claims"][10];
  game["exact"] = false;
  game["values"] = json::array({"-1000", "-1000", "-1000", "-1000"});
  f["verdict"] = "violated";
  f["left"] = "1000";
  EXPECT_EQ(refusal(certificate.dump()),
            "$.claims[10].verdict: violated, expected undetermined: no instance decides it");
  f = {{"claim", "F"}, {"verdict", "undetermined"}};
  EXPECT_EQ(refusal(certificate.dump()), "");
}

TEST(BeliefGame, HasNoPositionThatIsNotReached) {
  json certificate = sample_certificates().at(paper);
  json& game = certificate["belief_game"];
  game["positions"].insert(game["positions"].begin() + 3, json::array({2, json::array({1, 2})}));
  game["values"].push_back("-40");
  EXPECT_EQ(refusal(certificate.dump()), "$.belief_game.positions[3]: not reached, expected only positions that are");
}

TEST(Claims, SidesThatAreMovedTogetherAreRefused) {
  json certificate = sample_certificates().at(paper);
  certificate["claims"][4]["left"] = "11";
  certificate["claims"][4]["right"] = "7";
  EXPECT_EQ(refusal(certificate.dump()).substr(0, 14), "$.claims[4].at");
}

}  // namespace
}  // namespace maximin::testing
