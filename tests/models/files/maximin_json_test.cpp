#include <maximin/models/files/maximin_json.hpp>

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include <maximin/theory/rational.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

/// The minimal form, with room for more members.
std::string minimal(const std::string& more = "") {
  return R"({"format":"maximin-mdp","version":1,"states":3,"actions":2,"discount":0.5,)" + more +
         R"("rewards":[[0,0],[-1,-1],[-20,-20]],
         "transitions":[[0,0,0,1],[0,1,2,1],[1,1,1,1],[1,0,2,1],[2,0,2,1],[2,1,2,1]]})";
}

Model<double> read(const std::string& text, const ReadOptions& options = {}) {
  return read_maximin_json<double>(text, "m.json", options);
}

TEST(MaximinJson, ReadsTheMinimalForm) {
  const Model<double> model = read(minimal(R"("norm":"l1","eps":1,"points":[[0],[1],[20]],)"));
  EXPECT_EQ(model.mdp.states(), 3);
  EXPECT_EQ(model.mdp.actions(), 2);
  EXPECT_EQ(model.mdp.discount(), 0.5);
  EXPECT_EQ(model.mdp.reward(2, 1), -20);
  ASSERT_EQ(model.mdp.successors(1, 0).size(), 1U);
  EXPECT_EQ(model.mdp.successors(1, 0)[0], (Successor<double>{2, 1.0}));
  EXPECT_EQ(model.geometry.kind, Geometry<double>::Kind::points);
  EXPECT_EQ(model.geometry.norm, Norm::l1);
  EXPECT_EQ(model.geometry.points(2, 0), 20);
  EXPECT_EQ(model.geometry.eps, 1);
  EXPECT_TRUE(model.notes.empty());
}

TEST(MaximinJson, ReadsNamesStartAndNotes) {
  const Model<double> model = read(minimal(
      R"("name":"m","notes":["n"],"state_names":["a","b","c"],"action_names":["x","y"],"start":["1/4",0.75,0],)"));
  EXPECT_EQ(model.name, "m");
  EXPECT_EQ(model.notes, std::vector<std::string>{"n"});
  EXPECT_EQ(model.state_name(1), "b");
  EXPECT_EQ(model.action_name(1), "y");
  EXPECT_EQ(model.start, (std::vector<double>{0.25, 0.75, 0}));
  EXPECT_EQ(read(minimal(R"("start":2,)")).start, (std::vector<double>{0, 0, 1}));
  EXPECT_EQ(read(minimal(R"("state_names":["a","b","c"],"start":"b",)")).start, (std::vector<double>{0, 1, 0}));
}

TEST(MaximinJson, ReadsEveryGeometry) {
  using Kind = Geometry<double>::Kind;
  EXPECT_EQ(read(minimal()).geometry.kind, Kind::none);
  EXPECT_EQ(read(minimal(R"("metric":"hops",)")).geometry.kind, Kind::hops);
  EXPECT_EQ(read(minimal(R"("metric":"discrete","eps":0.5,)")).geometry.eps, 0.5);
  const auto distances = read(minimal(R"("distances":[[0,1,2],[1,0,1],[2,1,0]],)")).geometry;
  EXPECT_EQ(distances.kind, Kind::distances);
  EXPECT_EQ(distances.distances(0, 2), 2);
  const auto balls = read(minimal(R"("neighbourhoods":[[0,1],[0,1],[2]],)")).geometry;
  EXPECT_EQ(balls.kind, Kind::neighbourhoods);
  EXPECT_EQ(balls.neighbourhoods[0], (std::vector<State>{0, 1}));
  const Model<double> no_norm = read(minimal(R"("points":[[0],[1],[20]],)"));
  EXPECT_EQ(no_norm.geometry.norm, Norm::l2);
  EXPECT_EQ(no_norm.notes, std::vector<std::string>{"norm: the file gives none, l2 assumed"});
}

TEST(MaximinJson, TakesFractionsInQuotes) {
  const Model<double> model = read(
      R"({"format":"maximin-mdp","version":1,"states":2,"actions":1,"discount":"1/3","rewards":[["2/7"],[0]],
          "transitions":[[0,0,0,"1/3"],[0,0,1,"2/3"],[1,0,1,1]]})");
  EXPECT_EQ(model.mdp.discount(), 1.0 / 3.0);
  EXPECT_EQ(model.mdp.reward(0, 0), 2.0 / 7.0);
  EXPECT_EQ(model.mdp.successors(0, 0)[1].probability, 2.0 / 3.0);
}

TEST(MaximinJson, KeepsRowsThatMissOneByRounding) {
  const Model<double> model = read(
      R"({"format":"maximin-mdp","version":1,"states":2,"actions":1,"discount":0,"rewards":[[0],[0]],
          "transitions":[[0,0,0,0.33333333333333331],[0,0,1,0.66666666666666674],[1,0,1,1]]})");
  EXPECT_EQ(model.mdp.successors(0, 0)[1].probability, 0.66666666666666674);
  EXPECT_TRUE(model.notes.empty());
}

TEST(MaximinJson, ScalesRowsThatMissOneBySomethingSmallAndSaysSo) {
  const Model<double> model = read(
      R"({"format":"maximin-mdp","version":1,"states":2,"actions":1,"discount":0,"rewards":[[0],[0]],
          "transitions":[[0,0,0,0.3333333333],[0,0,1,0.6666666666],[1,0,1,1]]})");
  EXPECT_NEAR(model.mdp.successors(0, 0)[1].probability, 2.0 / 3.0, 1e-15);
  EXPECT_EQ(model.notes,
            std::vector<std::string>{"1 of 2 rows summed to 1 only within 1e-10; they were scaled to sum to 1"});
}

TEST(MaximinJson, ScalesEveryRowThatMissesOneExactlyInExactArithmetic) {
  const auto read_row = [](const std::string& p, const std::string& q) {
    return read_maximin_json<Rational>(
        R"({"format":"maximin-mdp","version":1,"states":2,"actions":1,"discount":0,"rewards":[[0],[0]],
            "transitions":[[0,0,0,")" +
            p + R"("],[0,0,1,")" + q + R"("],[1,0,1,1]]})",
        "m.json");
  };
  EXPECT_TRUE(read_row("1/3", "2/3").notes.empty());
  const Model<Rational> near = read_row("0.3333333333333333", "0.6666666666666666");
  EXPECT_EQ(near.mdp.successors(0, 0)[0].probability, Rational(1, 3));
  EXPECT_EQ(near.notes,
            std::vector<std::string>{"1 of 2 rows summed to 1 only within 1e-16; they were scaled to sum to 1"});
  EXPECT_EQ(read_row("1", "1e-400").notes,
            std::vector<std::string>{"1 of 2 rows missed a sum of 1 by less than any double shows; they were scaled to "
                                     "sum to 1"});
}

TEST(MaximinJson, LetsTheCallerChooseTheDiscount) {
  ReadOptions options;
  options.discount = 0.9;
  const Model<double> model = read(minimal(), options);
  EXPECT_EQ(model.mdp.discount(), 0.9);
  EXPECT_EQ(model.notes, std::vector<std::string>{"discount: 0.9 as asked for, instead of 0.5 in the file"});
  options.discount = 1;
  EXPECT_EQ(testing::error_of([&] { read(minimal(), options); }),
            "discount 1: outside the range, expected 0 <= discount < 1");
}

TEST(MaximinJson, RefusesMoreThanTheLimits) {
  ReadOptions options;
  options.limits.pairs = 5;
  EXPECT_EQ(testing::error_of([&] { read(minimal(), options); }),
            "m.json: $.states: 3 states and 2 actions are too many, expected at most 5 (state, action) pairs");
  options = {};
  options.limits.transitions = 5;
  EXPECT_EQ(testing::error_of([&] { read(minimal(), options); }),
            "m.json: $.transitions: 6 transitions, expected at most 5");
}

TEST(MaximinJson, WritesSeventeenDigitsWhereItTakesThem) {
  Model<double> model = read(minimal());
  model.start = {0.1, 1.0 / 3.0, 1 - 0.1 - 1.0 / 3.0};
  std::ostringstream out;
  write_maximin_json(model, out);
  EXPECT_NE(out.str().find("[0.1, 0.3333333333333333, "), std::string::npos) << out.str();
  EXPECT_TRUE(testing::same_model(read(out.str()), model));
}

}  // namespace
}  // namespace maximin
