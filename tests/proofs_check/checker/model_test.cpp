#include <maximin/proofs_check/checker/sections.hpp>

#include <gtest/gtest.h>

namespace maximin::checker {
namespace {

using nlohmann::json;

/// Three states at (0,0), (3,4) and (6,8), which never move.
json points(const char* norm, const char* eps) {
  json model = json::parse(R"({"format": "maximin-mdp", "version": 1, "states": 3, "actions": 1, "discount": "1/2",
                               "points": [["0", "0"], ["3", "4"], ["6", "8"]], "rewards": [["1"], ["2"], ["1/3"]],
                               "transitions": [[0, 0, 0, "1"], [1, 0, 1, "1"], [2, 0, 2, "1"]]})");
  model["norm"] = norm;
  model["eps"] = eps;
  return model;
}

json matrix(const char* distances) {
  json model = points("l1", "1");
  model.erase("points");
  model.erase("norm");
  model["distances"] = json::parse(distances);
  return model;
}

Model read(const json& model) {
  static const Limits limits;
  const json parsed = json::parse(model.dump());
  return read_model(Node(parsed, "$.model", limits), limits.states);
}

std::string refusal(const json& model) {
  try {
    read(model);
    return {};
  } catch (const Refused& refused) {
    return refused.what();
  }
}

TEST(Balls, AreClosedAndDecidedExactly) {
  using Balls = std::vector<Indices>;
  const Balls alone{{0}, {1}, {2}}, neighbours{{0, 1}, {0, 1, 2}, {1, 2}};
  EXPECT_EQ(read(points("l1", "7")).balls, neighbours);
  EXPECT_EQ(read(points("l1", "699999999999999999/100000000000000000")).balls, alone);
  EXPECT_EQ(read(points("linf", "4")).balls, neighbours);
  EXPECT_EQ(read(points("linf", "39/10")).balls, alone);
  EXPECT_EQ(read(points("l2", "5")).balls, neighbours);
  EXPECT_EQ(read(points("l2", "49999999999999999999999999/10000000000000000000000000")).balls, alone);
  EXPECT_EQ(read(points("l2", "0")).balls, alone);
}

TEST(Balls, UnderL2AreDecidedOnSquaresNearerThanTheEnclosure) {
  json model = points("l2", "1");
  const std::string square = "1" + std::string(80, '0'), above = "1" + std::string(79, '0') + "1";
  model["points"][1] = json::parse("[\"" + above + "/" + square + "\", \"0\"]");  // 10^-80 beyond eps
  EXPECT_EQ(read(model).balls[0], Indices{0});
  model["points"][1][0] = "1";
  EXPECT_EQ(read(model).balls[0], (Indices{0, 1}));
}

TEST(Distances, UnderL2AreEnclosed) {
  json model = points("l2", "1");
  model["points"] = json::parse(R"([["0", "0"], ["1", "1"], ["3", "4"]])");
  const Model m = read(model);
  const Rational near = m.metric.near(m.length(0, 1)), far = m.metric.far(m.length(0, 1));
  EXPECT_LT(near * near, 2);
  EXPECT_GT(far * far, 2);
  EXPECT_EQ(far - near, Rational(1, Integer(1) << 64));
  EXPECT_EQ(m.metric.near(m.length(0, 2)), 5);
  EXPECT_EQ(m.metric.far(m.length(0, 2)), 5);
}

TEST(Distances, NullIsInfinite) {
  const Model m = read(matrix(R"([["0", "1", null], ["1", "0", null], [null, null, "0"]])"));
  EXPECT_EQ(m.balls, (std::vector<Indices>{{0, 1}, {0, 1}, {2}}));
  EXPECT_EQ(m.length(0, 2), -1);
  EXPECT_EQ(m.length(0, 1), m.metric.unit);
}

TEST(Distances, AreAMetric) {
  EXPECT_EQ(refusal(matrix(R"([["0", "1", "2"], ["1", "0", "1"], ["2", "1", "0"]])")), "");
  const auto expect_refused = [](const char* distances, const std::string& start) {
    const std::string line = refusal(matrix(distances));
    EXPECT_EQ(line.substr(0, start.size()), start) << line;
  };
  expect_refused(R"([["0", "1", "3"], ["1", "0", "1"], ["3", "1", "0"]])",
                 "$.model.distances[0][2]: more than by way of state 1");
  expect_refused(R"([["0", "1", null], ["1", "0", "1"], [null, "1", "0"]])", "$.model.distances[0][2]: more than");
  expect_refused(R"([["0", "1", "1"], ["1", "0", "1"], ["2", "1", "0"]])", "$.model.distances[0][2]: not the distance");
  expect_refused(R"([["0", "1", "1"], ["1", "1/2", "1"], ["1", "1", "0"]])", "$.model.distances[1][1]: not 0");
  expect_refused(R"([["0", "1", "1"], ["1", "0", "-1"], ["1", "-1", "0"]])", "$.model.distances[1][2]: negative");
  expect_refused(R"([["0", "1"], ["1", "0", "1"], ["1", "1", "0"]])", "$.model.distances[0]: 2 items, expected 3");
}

/// 0 leads to 1 and 1 to 2, and 3 to itself alone.
TEST(Distances, HopsAreStepsEitherWay) {
  json model = points("l1", "1");
  model.erase("points");
  model.erase("norm");
  model["states"] = 4;
  model["rewards"] = json::parse(R"([["0"], ["0"], ["0"], ["0"]])");
  model["transitions"] = json::parse(R"([[0, 0, 1, "1"], [1, 0, 1, "1/2"], [1, 0, 2, "1/2"], [2, 0, 2, "1"],
                                         [3, 0, 3, "1"]])");
  model["metric"] = "hops";
  const Model hops = read(model);
  EXPECT_EQ(hops.balls, (std::vector<Indices>{{0, 1}, {0, 1, 2}, {1, 2}, {3}}));
  EXPECT_EQ(hops.length(2, 0), 2);
  EXPECT_EQ(hops.length(2, 3), -1);
  EXPECT_TRUE(hops.has_pairs);
  model["metric"] = "discrete";
  const Model discrete = read(model);
  EXPECT_EQ(discrete.balls[2], (Indices{0, 1, 2, 3}));
  EXPECT_EQ(discrete.length(2, 2), 0);
  EXPECT_EQ(discrete.length(2, 3), 1);
  model["eps"] = "99/100";
  EXPECT_EQ(read(model).balls[2], Indices{2});
  model["distances"] = json::array();
  EXPECT_EQ(refusal(model), "$.model: \"distances\" is no member of it, expected none but those of the format");
}

TEST(Backup, IsThatOfTheFormat) {
  json model = points("l1", "0");
  model["discount"] = "9/10";
  model["transitions"] = json::parse(R"([[0, 0, 0, "1/3"], [0, 0, 2, "2/3"], [1, 0, 1, "1"], [2, 0, 0, "1"]])");
  const Model m = read(model);
  const Table q = back(m, *over_one_denominator({Rational(1, 7), 2, -3}, 1000));
  EXPECT_EQ(q[0], Rational(1) + Rational(9, 10) * (Rational(1, 21) - 2));
  EXPECT_EQ(q[1], Rational(2) + Rational(9, 5));
  EXPECT_EQ(q[2], Rational(1, 3) + Rational(9, 70));
}

/// Four states in one ball with two actions, so that ties of every kind occur.
TEST(Policies, BreakTiesAsAsked) {
  json model = points("l1", "100");
  model["actions"] = 2;
  model["rewards"] = json::parse(R"([["1", "1"], ["0", "0"], ["0", "5"]])");
  model["transitions"] = json::parse(
      R"([[0, 0, 0, "1"], [0, 1, 0, "1"], [1, 0, 1, "1"], [1, 1, 1, "1"], [2, 0, 2, "1"], [2, 1, 2, "1"]])");
  const Model m = read(model);
  EXPECT_EQ(maximin_policy(m, m.rewards, false), (Indices{0, 0, 0}));
  EXPECT_EQ(maximin_policy(m, m.rewards, true), (Indices{1, 1, 1}));
  const Indices policy{1, 0, 1};
  EXPECT_EQ(best_response(m, m.rewards, policy, 0, false), 0U);
  EXPECT_EQ(best_response(m, m.rewards, policy, 0, true), 2U);
  EXPECT_EQ(best_response(m, m.rewards, policy, 2, false), 1U) << "the one state shown that leads to action 0";
  EXPECT_EQ(best_response(m, m.rewards, policy, 2, true), 1U);
}

}  // namespace
}  // namespace maximin::checker
