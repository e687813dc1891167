#include <gmpxx.h>
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
  EXPECT_EQ(report.worst(), "violated");
  EXPECT_TRUE(report.left_out.empty());
}

TEST(Report, TellsTheWorstVerdictAndWhatIsLeftOut) {
  EXPECT_EQ(checker::check(sample_certificates().at("cycle").dump()).worst(), "holds");
  EXPECT_EQ(checker::check(sample_certificates().at("undecided").dump()).worst(), "undetermined");
  json some = sample_certificates().at("one_sided_paper");
  some["claims"] = json::array({some["claims"][4], some["claims"][9]});
  EXPECT_EQ(checker::check(some.dump()).left_out,
            (std::vector<std::string>{"lemma-1", "lemma-1-iterates", "lemma-2", "lemma-3", "A", "B", "C", "D", "F"}));
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
  certificate[json::json_pointer(GetParam().place)] = GetParam().value;
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

const char* const bounds = "bounds_one_sided";
const char* const ties = "bounds_ties";  // where a box leaves several actions to choose from

INSTANTIATE_TEST_SUITE_P(
    ConstantsByBounds, OneUntruth,
    ::testing::Values(
        Untruth{bounds, "/constants/l_r/value", "2", "$.constants.l_r.value: 2, expected at most 1,"},
        Untruth{bounds, "/constants/l_p/value", "2", "$.constants.l_p.value: 2, expected at most 1,"},
        Untruth{bounds, "/constants/k/value", "2", "$.constants.k.value: 2, expected at most 1,"},
        Untruth{bounds, "/constants/l_star/value", "22", "$.constants.l_star.value: 22, expected at most 21,"},
        Untruth{ties, "/constants/l_star/value", "8195/4096", "$.constants.l_star.value: 8195/4096, expected at most"},
        Untruth{bounds, "/constants/l_star/at", {1, 0, 0}, "$.constants.l_star.value: 21, expected at most -21,"},
        Untruth{bounds, "/constants/l_r/value", "-1", "$.constants.l_r.value: -1, expected a number from 0 on"},
        Untruth{bounds, "/constants/l_r/value", "0", "$.constants.l_r.at: expected null where the value is 0"},
        Untruth{bounds, "/constants/l_r/at", nullptr, "$.constants.l_r.at: expected null where the value is 0"},
        Untruth{bounds, "/constants/l_r/at", {1, 1, 0}, "$.constants.l_r.at: expected states that differ"},
        Untruth{bounds, "/model/points/1", {"0"}, "$.constants.l_r.at: expected a finite distance above 0"},
        Untruth{"bounds_islands",
                "/constants/l_r",
                {{"value", "1"}, {"at", {0, 1, 0}}},
                "$.constants.l_r.at: expected a finite distance above 0"},
        Untruth{bounds, "/constants/r_min", "-19", "$.constants.r_min: -19, expected -20"},
        Untruth{bounds, "/constants/r_max", "1", "$.constants.r_max: 1, expected 0"}));

INSTANTIATE_TEST_SUITE_P(
    ValuesByBounds, OneUntruth,
    ::testing::Values(
        Untruth{bounds, "/optimal/low/0", "1", "$.optimal.low[0]: 1, expected at most 1/2"},
        Untruth{bounds, "/optimal/high/0", "-1", "$.optimal.high[0]: -1, expected at least -1/2"},
        Untruth{bounds, "/bits", 100'001, "$.bits: 100001, expected an integer from 0 to 100000"},
        Untruth{bounds, "/bits", 2, "$.limit.boxes[0].high[1]: -7925/4096, expected at least -7/4"},
        Untruth{bounds, "/pairs", json::array(), "$.pairs: empty"},
        Untruth{bounds, "/pairs/0/choices/0", {1}, "$.pairs[0].choices[0]: not the actions of round 0, expected {0}"},
        Untruth{bounds, "/pairs/0/choices/0", json::array(), "$.pairs[0].choices[0]: not the actions of round 0"},
        Untruth{
            bounds, "/pairs/1/provoked/1", {0, 1}, "$.pairs[1].provoked[1]: not the actions of round 2, expected {1}"},
        Untruth{
            ties, "/pairs/1/provoked/2", {1}, "$.pairs[1].provoked[2]: not the actions of round 2, expected {0, 1}"},
        Untruth{bounds, "/pairs/0/below/1", "-20", "$.pairs[0].below[1]: -20, expected at most -21"},
        Untruth{bounds, "/pairs/0/above/1", "-22", "$.pairs[0].above[1]: -22, expected at least -21"},
        Untruth{bounds, "/rounds/0", 1, "$.rounds[0]: a pair that skips pair 0"},
        Untruth{bounds, "/rounds/2", 0, "$.pairs[0].choices[0]: not the actions of round 2, expected {1}"},
        Untruth{bounds, "/rounds", {0, 0}, "$.claims[1].at.n: 6, expected an integer from 0 to 2"},
        Untruth{bounds, "/test_time/below/0", "-19", "$.test_time.below[0]: -19, expected at most -20"},
        Untruth{ties, "/test_time/below/0", "1/1024", "$.test_time.below[0]: 1/1024, expected at most 1/2048"},
        Untruth{bounds, "/belief_game/values/0", "-19", "$.belief_game.values[0]: -19, expected at most -20"},
        Untruth{ties, "/belief_game/values/0", "1/1024", "$.belief_game.values[0]: 1/1024, expected at most 0"},
        Untruth{bounds, "/belief_game/reach", "2", "$.belief_game.reach: 2, expected 1"},
        Untruth{ties,
                "/belief_game/positions/0/1",
                {0},
                "$.belief_game.positions[0]: not reached, expected only positions that are"},
        Untruth{ties, "/model/metric", "discrete", "$.rounds[2]: the second pair of the same actions"},
        Untruth{ties, "/model/metric", "steps", "$.model.metric: \"steps\", expected \"hops\" or \"discrete\""}));

/// The values of a box that are near to those of round N-1 are held by it, the others by the backup of the box itself.
INSTANTIATE_TEST_SUITE_P(
    Boxes, OneUntruth,
    ::testing::Values(
        Untruth{bounds, "/limit/boxes/0/low/0", "-18", "$.limit.boxes[0].low[0]: -18, expected at most -75/4"},
        Untruth{bounds, "/limit/boxes/0/high/0", "-20", "$.limit.boxes[0].high[0]: -20, expected at least -75/4"},
        Untruth{bounds, "/limit/boxes/0/low/0", "-19", "$.limit.boxes[0].low[0]: -19, expected at most -20"},
        Untruth{"boxes_random_six", "/limit/boxes/0/high/0", "-6", "$.limit.boxes[0].high[0]: -6, expected at least"},
        Untruth{bounds, "/limit/boxes/0/below/1", "-1", "$.limit.boxes[0].below[1]: -1, expected at most -3/2"},
        Untruth{bounds, "/limit/boxes/0/above/1", "-3", "$.limit.boxes[0].above[1]: -3, expected at least -5/2"},
        Untruth{ties, "/limit/boxes/0/below/0", "1/1024", "$.limit.boxes[0].below[0]: 1/1024, expected at most 1/2048"},
        Untruth{ties, "/limit/boxes/0/above/0", "1", "$.limit.boxes[0].above[0]: 1, expected at least"},
        Untruth{bounds, "/limit", {{"orbit", {1}}}, "$.limit.boxes: missing"},
        Untruth{bounds, "/limit/boxes/0/fixed", nullptr, "$.limit.boxes[0]: \"fixed\" is no member"},
        Untruth{"boxes_random_six", "/limit/boxes/1/low/0", "6", "$.limit.boxes[1].low[0]: 6, expected at most"},
        Untruth{"boxes_random_six", "/limit/boxes/0/low/0", "6", "$.limit.boxes[0].low[0]: 6, expected at most"},
        Untruth{"boxes_one_sided_paper", "/limit/boxes/0/low/0", "-19",
                "$.limit.boxes[0].low[0]: -19, expected at most -315/16"}));

INSTANTIATE_TEST_SUITE_P(
    ClaimsByBounds, OneUntruth,
    ::testing::Values(
        Untruth{bounds, "/claims/2/claim", "lemma-3", "$.claims[2].claim: \"lemma-3\", expected no entry of it"},
        Untruth{bounds, "/claims/0/verdict", "violated", "$.claims[0].verdict: violated, expected it never by bounds"},
        Untruth{bounds, "/claims/1/at/n", 0, "$.claims[1].at: no instance with these sides"},
        Untruth{bounds, "/reading", "paper", "$.claims[0].verdict: holds, but the least right - left is -20"}));

/// Each claim with both sides moved, so that it is the instance that is wrong.
TEST(ClaimsByBounds, HaveTheSidesOfTheFormat) {
  for (const char* name : {"bounds_one_sided", "bounds_ties", "bounds_plane_l2", "boxes_random_six"}) {
    const json& original = sample_certificates().at(name);
    for (std::size_t i = 0; i < original["claims"].size(); ++i) {
      json certificate = original;
      for (const char* side : {"left", "right"}) {
        std::string& text = certificate["claims"][i][side].get_ref<std::string&>();
        text = mpq_class(mpq_class(text) - 1).get_str();
      }
      const std::string line = refusal(certificate.dump()),
                        start = "$.claims[" + std::to_string(i) + "].at: no instance";
      EXPECT_EQ(line.substr(0, start.size()), start) << name << ": " << line;
    }
  }
}

TEST(PairsByBounds, AreGivenOnceAndInOrder) {
  json certificate = sample_certificates().at(bounds);
  certificate["pairs"].push_back(certificate["pairs"][1]);
  EXPECT_EQ(refusal(certificate.dump()), "$.pairs[2]: in no round, expected only pairs that occur");
  certificate["rounds"][3] = 2;
  EXPECT_EQ(refusal(certificate.dump()), "$.rounds[3]: the second pair of the same actions, expected 1");
}

/// By hand: states at 0, 1 and 10 that all lead to the first, at a discount of 0; what the last pays is its value.
json by_hand(const std::string& pay) {
  json c = json::parse(R"({"format": "maximin-bounds", "version": 1, "reading": "corrected", "tie": "lowest", "bits": 0,
    "model": {"format": "maximin-mdp", "version": 1, "states": 3, "actions": 1, "discount": "0", "eps": "0",
              "points": [["0"], ["1"], ["10"]], "norm": "l1",
              "transitions": [[0, 0, 0, "1"], [1, 0, 0, "1"], [2, 0, 0, "1"]]},
    "rounds": [0, 0], "pairs": [{"choices": [[0], [0], [0]], "provoked": [[0], [0], [0]]}], "belief_game": null,
    "constants": {"l_p": {"value": "0", "at": null}, "k": {"value": "0", "at": null}, "r_min": "0",
                  "l_star": {"value": "0", "at": null}}})");
  const json values{"0", "0", pay}, zero{{"value", "0"}, {"at", nullptr}};
  c["model"]["rewards"] = {{"0"}, {"0"}, {pay}};
  c["constants"]["r_max"] = pay;
  c["constants"]["l_r"] = pay == "0" ? zero : json{{"value", "1/1000"}, {"at", {0, 2, 0}}};
  c["optimal"] = {{"low", values}, {"high", values}};
  c["test_time"]["below"] = c["pairs"][0]["below"] = c["pairs"][0]["above"] = values;
  c["limit"]["boxes"] = json::array({{{"low", values}, {"high", values}, {"below", values}, {"above", values}}});
  return c;
}

std::string refusal_of(json certificate, const char* claim, const char* left, const char* right, int n, int t) {
  certificate["claims"] = json::array({{{"claim", claim}, {"verdict", "holds"}, {"left", left}, {"right", right}}});
  certificate["claims"][0]["at"] = {{"n", n}, {"states", {0, t}}, {"action", 0}};
  return refusal(certificate.dump());
}

TEST(PairsOfStates, ThatAreFarApartMayBeTheTightest) {
  EXPECT_EQ(refusal_of(by_hand("5"), "lemma-1", "5", "5", 0, 2), "");
  EXPECT_EQ(refusal_of(by_hand("5"), "lemma-1", "0", "1/1000", 0, 1),
            "$.claims[0].left: 0 against right 1/1000, expected the instance of least right - left, which is 0");
}

TEST(PairsOfStates, AreThoseOfFirstRoundsAndOfIteratesAfterThe0th) {
  const char* none = "$.claims[0].at: no instance with these sides, expected the one that they are the sides of";
  EXPECT_EQ(refusal_of(by_hand("5"), "lemma-1", "5", "5", 1, 2), none);
  EXPECT_EQ(refusal_of(by_hand("5"), "lemma-1", "5", "5", 2, 2), "");
  EXPECT_EQ(refusal_of(by_hand("0"), "lemma-1-iterates", "0", "0", 1, 2), "");
  EXPECT_EQ(refusal_of(by_hand("0"), "lemma-1-iterates", "0", "0", 0, 2), none);
}

/// Of an exact certificate with boxes, its rounds prove violations, and its boxes never.
TEST(Boxes, ProveNoViolation) {
  json certificate = sample_certificates().at("boxes_one_sided_paper");
  const json& violated = sample_certificates().at(paper)["claims"];
  certificate["claims"] = json::array({violated[0]});
  EXPECT_EQ(violated[0]["verdict"], "violated");
  EXPECT_EQ(refusal(certificate.dump()), "");
  for (const std::size_t claim : {5, 6}) {
    certificate["claims"] = json::array({sample_certificates().at("boxes_one_sided_paper")["claims"][claim]});
    certificate["claims"][0]["verdict"] = "violated";
    EXPECT_NE(refusal(certificate.dump()).find("no instance decides it"), std::string::npos);
  }
  certificate["claims"] = json::array({violated[4]});
  EXPECT_EQ(refusal(certificate.dump()),
            "$.claims[0].verdict: violated, expected undetermined: no instance decides it");
}

/// Any constants are safe where there are none: states that differ at distance 0.
TEST(ConstantsByBounds, MayBe0) {
  json certificate = sample_certificates().at(bounds);
  certificate["model"]["points"][1][0] = "0";
  for (const char* name : {"l_r", "l_p", "k", "l_star"})
    certificate["constants"][name] = {{"value", "0"}, {"at", nullptr}};
  certificate["belief_game"]["reach"] = "0";
  certificate["claims"] = json::array({{{"claim", "A"}, {"verdict", "undetermined"}}});
  EXPECT_EQ(refusal(certificate.dump()), "");
}

TEST(ClaimsByBounds, NeedTheLimitAndTheBeliefGame) {
  for (const std::size_t claim : {0, 1, 2, 3, 4, 5, 6, 7, 9}) {
    json certificate = sample_certificates().at(bounds);
    certificate["limit"] = certificate["belief_game"] = nullptr;
    certificate["claims"] = json::array({certificate["claims"][claim]});
    if (claim < 9) certificate["claims"][0]["at"]["n"] = 0;
    EXPECT_NE(refusal(certificate.dump()).find("$.claims[0].verdict: holds, expected undetermined: the "),
              std::string::npos);
  }
}

TEST(Limits, AreOfTheFormat) {
  const std::string exact = sample_certificates().at(paper).dump(), enclosed = sample_certificates().at(bounds).dump();
  checker::Limits limits;
  limits.states = 2;
  EXPECT_EQ(refusal(exact, limits), "$.model.states: 3, expected an integer from 1 to 2");
  EXPECT_EQ(refusal(enclosed, limits), "");
  limits = {};
  limits.states_by_bounds = 2;
  EXPECT_EQ(refusal(exact, limits), "");
  EXPECT_EQ(refusal(enclosed, limits), "$.model.states: 3, expected an integer from 1 to 2");
}

TEST(Report, SaysWhatKindItIs) {
  const auto report = [](const char* name) { return checker::check(sample_certificates().at(name).dump()); };
  EXPECT_FALSE(report(paper).bounds || report(paper).boxes);
  EXPECT_TRUE(report(bounds).bounds && report(bounds).boxes);
  EXPECT_EQ(report("boxes_random_six").period, 2U);
  EXPECT_TRUE(report("boxes_random_six").boxes && !report("boxes_random_six").bounds);
  EXPECT_TRUE(report("bounds_undecided").bounds && !report("bounds_undecided").boxes);
}

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

/// State 3 is left with actions that lead to 1 and 3: without such positions, r_min/(1-g) = 0 stands for theirs.
TEST(BeliefGame, OfALowerBoundMayLackPositionsThatAreNoStarts) {
  json certificate = sample_certificates().at(ties);
  json& game = certificate["belief_game"];
  for (std::size_t i = game["positions"].size(); i-- > 0;) {
    const std::size_t members = game["positions"][i][1].size();
    game["values"][i] = i < 6 || members == 3 ? "0" : game["values"][i];
    if (members == 3) continue;
    game["positions"].erase(i);
    game["values"].erase(i);
  }
  certificate["claims"] = json::array({{{"claim", "F"}, {"verdict", "undetermined"}}});
  EXPECT_EQ(refusal(certificate.dump()), "");
  game["values"][2] = "5";
  EXPECT_EQ(refusal(certificate.dump()).substr(0, 26), "$.belief_game.values[2]: 5");
  game["positions"].erase(0);
  game["values"].erase(0);
  EXPECT_EQ(refusal(certificate.dump()),
            "$.belief_game.positions: none of state 0 and belief {0, 1, 2}, expected all that are reached");
}

TEST(Claims, SidesThatAreMovedTogetherAreRefused) {
  json certificate = sample_certificates().at(paper);
  certificate["claims"][4]["left"] = "11";
  certificate["claims"][4]["right"] = "7";
  EXPECT_EQ(refusal(certificate.dump()).substr(0, 14), "$.claims[4].at");
}

}  // namespace
}  // namespace maximin::testing
