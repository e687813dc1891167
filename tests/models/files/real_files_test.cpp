// Every real file that there is, read: sizes, names, discounts and some values, as counted in the files by hand.
#include <gtest/gtest.h>

#include <cctype>

#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/model_file.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

const std::filesystem::path folder = MAXIMIN_SHARED_MODELS;

/// How a file has to be read where it leaves something open.
ReadOptions options_for(const std::string& file) {
  ReadOptions options;
  if (file == "cassandra/concert.POMDP") options.discount = 0.95;
  if (file.starts_with("storm-drn/tiny") || file == "umb/robot.umb") options.intervals = IntervalRows::nominal;
  return options;
}

Model<double> load(const std::string& file) {
  return load_model<double>(folder / file, options_for(file));
}

struct Expected {
  std::string file;
  State states;
  Action actions;
  double discount;
  std::size_t transitions;
};

class RealFile : public ::testing::TestWithParam<Expected> {};

TEST_P(RealFile, HasTheSizeOfTheFile) {
  const Model<double> model = load(GetParam().file);
  EXPECT_EQ(model.mdp.states(), GetParam().states);
  EXPECT_EQ(model.mdp.actions(), GetParam().actions);
  EXPECT_EQ(model.mdp.discount(), GetParam().discount);
  EXPECT_EQ(model.mdp.transition_count(), GetParam().transitions);
}

TEST_P(RealFile, RoundTripsThroughOwnJson) {
  const Model<double> model = load(GetParam().file);
  std::ostringstream out;
  write_maximin_json(model, out);
  EXPECT_TRUE(testing::same_model(read_maximin_json<double>(out.str(), "m.json"), model));
}

INSTANTIATE_TEST_SUITE_P(
    All, RealFile,
    ::testing::Values(
        Expected{"gymnasium/FrozenLake-v1_4x4_slippery.json", 17, 4, 0.95, 150},
        Expected{"gymnasium/FrozenLake-v1_8x8_slippery.json", 65, 4, 0.95, 660},
        Expected{"gymnasium/CliffWalking-v1.json", 49, 4, 0.95, 196},
        Expected{"gymnasium/Taxi-v4.json", 501, 6, 0.95, 3006}, Expected{"cassandra/1d.POMDP", 4, 2, 0.75, 12},
        Expected{"cassandra/4x3.95.POMDP", 11, 4, 0.95, 168}, Expected{"cassandra/cheese.95.POMDP", 11, 4, 0.95, 80},
        Expected{"cassandra/concert.POMDP", 2, 3, 0.95, 12}, Expected{"cassandra/corner.MDP", 4, 4, 0.95, 20},
        Expected{"cassandra/ejs4.POMDP", 3, 2, 0.95, 17}, Expected{"cassandra/parr95.95.POMDP", 7, 3, 0.95, 24},
        Expected{"cassandra/tiger.95.POMDP", 2, 3, 0.95, 10}, Expected{"cassandra/tiger.aaai.POMDP", 2, 3, 0.75, 10},
        Expected{"prism-explicit/maze.prism.tra", 12, 5, 0.95, 105},
        Expected{"prism-explicit/mdp_simple.tra", 10, 2, 0.95, 25},
        Expected{"prism-explicit/robot.prism.tra", 6, 5, 0.95, 51},
        Expected{"prism-explicit/robot.prism.exact.tra", 6, 5, 0.95, 39},
        Expected{"prism-explicit/robot.prism.rows.tra", 6, 5, 0.95, 51},
        Expected{"storm-drn/two_dice.drn", 169, 2, 0.95, 604}, Expected{"storm-drn/two_dice.tra", 169, 2, 0.95, 604},
        Expected{"storm-drn/tiny-01.drn", 3, 1, 0.95, 4}, Expected{"storm-drn/tiny-02.drn", 3, 1, 0.95, 5},
        Expected{"umb/mdp.umb", 4, 2, 0.95, 12}, Expected{"umb/robot.umb", 6, 2, 0.95, 19}),
    [](const auto& tested) {
      std::string name = tested.param.file;
      for (char& c : name) {
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
      }
      return name;
    });

// A file that this test does not know must be added to it.
TEST(RealFiles, AreAllListed) {
  const std::set<std::string> companions = {".lab", ".obs", ".srew", ".sta", ".trew", ".md"};
  std::size_t models = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && companions.count(entry.path().extension().string()) == 0) ++models;
  }
  EXPECT_EQ(models, 24U);
}

TEST(RealFiles, CassandraValues) {
  const Model<double> tiger = load("cassandra/tiger.95.POMDP");
  EXPECT_EQ(tiger.action_names, (std::vector<std::string>{"listen", "open-left", "open-right"}));
  EXPECT_EQ(tiger.mdp.reward(0, 1), -100);
  EXPECT_EQ(tiger.mdp.reward(1, 1), 10);
  EXPECT_EQ(tiger.mdp.successors(0, 1)[1].probability, 0.5);
  EXPECT_EQ(tiger.start, (std::vector<double>{0.5, 0.5}));
  const Model<double> one_d = load("cassandra/1d.POMDP");
  EXPECT_EQ(one_d.state_name(3), "goal");
  EXPECT_EQ(one_d.mdp.reward(2, 0), 1);
  EXPECT_EQ(one_d.notes[0], "2 of 8 rows summed to 1 only within 1e-06; they were scaled to sum to 1");
  const Model<double> corner = load("cassandra/corner.MDP");
  EXPECT_EQ(corner.mdp.reward(1, 0), -1);             // bumps into the wall for sure
  EXPECT_NEAR(corner.mdp.reward(2, 0), -0.8, 1e-15);  // R: 0 : 2 : 0 pays on arrival in 0
  const Model<double> concert = load("cassandra/concert.POMDP");
  EXPECT_EQ(concert.mdp.reward(1, 1), -4);
  EXPECT_EQ(concert.mdp.reward(0, 1), 0);
}

TEST(RealFiles, PrismValues) {
  const Model<double> maze = load("prism-explicit/maze.prism.tra");
  EXPECT_EQ(maze.state_name(0), "(-1)");
  EXPECT_EQ(maze.action_names, (std::vector<std::string>{"east", "south", "west", "north", "done"}));
  EXPECT_EQ(maze.mdp.reward(0, 0), 0);
  EXPECT_EQ(maze.mdp.reward(1, 0), 1);
  EXPECT_EQ(maze.mdp.reward(11, 4), 0);
  const Model<double> simple = load("prism-explicit/mdp_simple.tra");
  EXPECT_EQ(simple.mdp.reward(6, 1), 1);
  EXPECT_EQ(simple.mdp.reward(3, 0), 0);
  const Model<double> robot = load("prism-explicit/robot.prism.tra");
  EXPECT_EQ(robot.mdp.rewards(), (QTable<double>::Constant(6, 5, 1.0)));  // robot.prism1.srew, found beside it
  const Model<double> exact = load("prism-explicit/robot.prism.exact.tra");
  EXPECT_EQ(exact.mdp.successors(0, 0)[0].probability, 0.4);
}

TEST(RealFiles, StormValues) {
  const Model<double> drn = load("storm-drn/two_dice.drn");
  EXPECT_EQ(drn.mdp.reward(0, 1), 1);
  EXPECT_EQ(drn.start[0], 1);
  EXPECT_EQ(load("storm-drn/two_dice.tra").start, drn.start);
  const Model<double> tiny = load("storm-drn/tiny-01.drn");
  EXPECT_NEAR(tiny.mdp.successors(0, 0)[0].probability, 0.4 + 0.125 * 0.5, 1e-15);
  EXPECT_NEAR(tiny.mdp.successors(0, 0)[1].probability, 0.5 + 0.125 * 0.3, 1e-15);
  const Model<double> umb = load("umb/mdp.umb");
  EXPECT_EQ(umb.action_names, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(umb.mdp.reward(0, 0), 1);
  EXPECT_EQ(umb.mdp.successors(1, 0)[0].probability, 0.9);
}

TEST(RealFiles, WhatIsLeftOpenIsAskedFor) {
  const auto error = [](const std::string& file) {
    const std::string message = testing::error_of([&] { load_model<double>(folder / file); });
    return message.substr(std::min(message.size(), (folder / file).string().size()));
  };
  EXPECT_EQ(error("cassandra/concert.POMDP"),
            ":4: discount 1: outside the range, expected 0 <= discount < 1; choose one with --discount, e.g. "
            "--discount 0.95");
  EXPECT_EQ(error("storm-drn/tiny-01.drn"),
            ":13: probabilities are intervals, expected numbers; --intervals nominal takes from every row the member "
            "lo + t (hi - lo) that sums to 1");
}

}  // namespace
}  // namespace maximin
