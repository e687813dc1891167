#include <maximin/models/files/cassandra.hpp>

#include <gtest/gtest.h>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

Model<double> read(const std::string& text, const ReadOptions& options = {}) {
  return read_cassandra<double>(text, "m.pomdp", options);
}

/// A preamble of two states, two actions and, perhaps, observations.
std::string two_by_two(const std::string& rest) {
  return "discount: 0.5\nvalues: reward\nstates: s0 s1\nactions: a b\n" + rest;
}

double p(const Model<double>& model, State s, Action a, State t) {
  for (const auto& next : model.mdp.successors(s, a)) {
    if (next.target == t) return next.probability;
  }
  return 0;
}

TEST(Cassandra, ReadsEveryFormOfTransitions) {
  const Model<double> model = read(two_by_two(R"(
      T: a identity
      T: b
      0.25 0.75
      1 0
      T: b : s1 uniform
      T : 0 : s1 : s0 1.0     # an entry, by index and name
      T : 0 : 1 : 1 0)"));
  EXPECT_EQ(p(model, 0, 0, 0), 1);
  EXPECT_EQ(p(model, 1, 0, 0), 1);
  EXPECT_EQ(p(model, 0, 1, 1), 0.75);
  EXPECT_EQ(p(model, 1, 1, 0), 0.5);
  EXPECT_EQ(model.state_names, (std::vector<std::string>{"s0", "s1"}));
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"a", "b"}));
}

TEST(Cassandra, LaterLinesOverrideEarlierOnes) {
  const Model<double> model = read(two_by_two(R"(
      T: * : * : s0 1
      T: b : s1 : s0 0
      T: b : s1 : s1 1
      R: * : * : * : * 1
      R: b : * : * : * 2
      R: * : s1 : s0 : * 3)"));
  EXPECT_EQ(p(model, 0, 1, 0), 1);
  EXPECT_EQ(p(model, 1, 1, 1), 1);
  EXPECT_EQ(model.mdp.reward(0, 0), 1);
  EXPECT_EQ(model.mdp.reward(0, 1), 2);
  EXPECT_EQ(model.mdp.reward(1, 0), 3);
  EXPECT_EQ(model.mdp.reward(1, 1), 2);
}

TEST(Cassandra, CommentsMayStandInsideLists) {
  const Model<double> model =
      read("discount: 0.5 values: reward states: x # one\n y # two\n actions: go\nT: go # rows\n0 1 # first\n0 1\n");
  EXPECT_EQ(model.mdp.states(), 2);
  EXPECT_EQ(p(model, 0, 0, 1), 1);
}

TEST(Cassandra, ReadsEveryFormOfRewardsOfAnMdp) {
  const Model<double> model = read(two_by_two(R"(
      T: * uniform
      R: a
      1 2
      3 4
      R: b : s0
      -10 20
      R: b : s1 : s0 : * 8
      R: b : s1 : s1 +16)"));
  EXPECT_EQ(model.mdp.reward(0, 0), 1.5);
  EXPECT_EQ(model.mdp.reward(1, 0), 3.5);
  EXPECT_EQ(model.mdp.reward(0, 1), 5);
  EXPECT_EQ(model.mdp.reward(1, 1), 12);
}

TEST(Cassandra, AveragesRewardsOverObservations) {
  const Model<double> model = read(two_by_two(R"(
      observations: x y z
      T: * : * : s1 1
      O: a : s1 0.5 0.25 0.25
      O: b : s1 uniform
      O: * : s0 : x 1
      R: a : s0 : s1 4 8 16
      R: a : s1
      0 0 0
      1 2 3
      R: b : * : s1 : x 3
      R: b : * : s1 : y 6)"));
  EXPECT_EQ(model.mdp.reward(0, 0), 0.5 * 4 + 0.25 * 8 + 0.25 * 16);
  EXPECT_EQ(model.mdp.reward(1, 0), 0.5 * 1 + 0.25 * 2 + 0.25 * 3);
  EXPECT_NEAR(model.mdp.reward(0, 1), 3, 1e-15);
}

TEST(Cassandra, ObservationsAreIndexedByTheEndState) {
  const Model<double> model = read(two_by_two(R"(
      observations: x y
      T: * : * : s1 1
      O: *
      1 0
      0 1
      R: * : * : * : y 5)"));
  EXPECT_EQ(model.mdp.reward(0, 0), 5);
}

TEST(Cassandra, TheLastRewardLineForAnObservationCounts) {
  const std::string head = "observations: 2\nT: * identity\nO: * uniform\n";
  const auto reward = [&](const std::string& lines) { return read(two_by_two(head + lines)).mdp.reward(0, 0); };
  EXPECT_EQ(reward("R: * : * : * : 0 2\nR: * : * : * : 1 4\nR: * : * : * : 0 6"), 5);
  EXPECT_EQ(reward("R: * : * : * : 0 2\nR: * : * : * : * 4\nR: * : * : * : 1 6"), 5);
  EXPECT_EQ(reward("R: a : s0 : * : 0 2\nR: * : * : * : * 4\nR: a : s0 : * : 1 6"), 5);
}

// Every repeated line was once looked at for every (a, s, s', o): more than a minute.
TEST(Cassandra, RepeatedRewardLinesCostNothing) {
  std::string text =
      "discount: 0.5\nvalues: reward\nstates: 60\nactions: 8\nobservations: 60\nT: * uniform\nO: * uniform\n";
  for (int i = 0; i < 40'000; ++i) text += "R:*:*:*:0 1\n";
  EXPECT_NEAR(read(text).mdp.reward(59, 7), 1.0 / 60, 1e-12);
}

TEST(Cassandra, RewardsThatSeeNoObservationNeedNone) {
  const Model<double> model = read(two_by_two("observations: 2\nT: * identity\nR: * : * : * : * 1"));
  EXPECT_EQ(model.mdp.reward(1, 1), 1);
}

TEST(Cassandra, CostsAreNegativeRewards) {
  const Model<double> model = read("discount: 0.5\nvalues: cost\nstates: 1\nactions: 1\nT: 0 identity\nR: 0 : 0 : 0 7");
  EXPECT_EQ(model.mdp.reward(0, 0), -7);
  EXPECT_EQ(model.notes, std::vector<std::string>{"values: costs, taken as negative rewards"});
}

TEST(Cassandra, ReadsEveryFormOfStart) {
  const std::string rest = "\nT: * identity";
  EXPECT_TRUE(read(two_by_two(rest)).start.empty());
  EXPECT_TRUE(read(two_by_two("start: uniform" + rest)).start.empty());
  EXPECT_EQ(read(two_by_two("start:\n0.25 0.75" + rest)).start, (std::vector<double>{0.25, 0.75}));
  EXPECT_EQ(read(two_by_two("start: s1" + rest)).start, (std::vector<double>{0, 1}));
  EXPECT_EQ(read(two_by_two("start: 1" + rest)).start, (std::vector<double>{0, 1}));
  EXPECT_EQ(read(two_by_two("start include: s0 1" + rest)).start, (std::vector<double>{0.5, 0.5}));
  EXPECT_EQ(read(two_by_two("start exclude: s0" + rest)).start, (std::vector<double>{0, 1}));
}

TEST(Cassandra, ResetGoesToTheStart) {
  const Model<double> model = read(two_by_two("start: 0.25 0.75\nT: * identity\nT: b : s1 reset"));
  EXPECT_EQ(p(model, 1, 1, 0), 0.25);
  EXPECT_EQ(p(model, 1, 1, 1), 0.75);
}

TEST(Cassandra, ScalesRowsAsPomdpSolveAllowsAndSaysSo) {
  const Model<double> model = read(
      "discount: 0.5\nvalues: reward\nstates: 3\nactions: 1\nT: 0\n0.333333 0.333333 0.333333\n1 0 0\n0 1 0\n"
      "R: 0 : 0 : 1 3");
  EXPECT_NEAR(p(model, 0, 0, 2), 1.0 / 3.0, 1e-15);
  EXPECT_NEAR(model.mdp.reward(0, 0), 1, 1e-15);
  EXPECT_EQ(model.notes,
            std::vector<std::string>{"1 of 3 rows summed to 1 only within 1e-06; they were scaled to sum to 1"});
}

TEST(Cassandra, TakesWhatRealFilesWriteAndSaysSo) {
  const Model<double> model = read("values: rewards\nstates: 1\nactions: 1\nT: 0 identity");
  EXPECT_EQ(model.mdp.discount(), 0.95);
  EXPECT_EQ(model.notes,
            (std::vector<std::string>{"values: 'rewards' taken for 'reward'",
                                      "discount: the file gives none, 0.95 assumed; choose one with --discount"}));
}

TEST(Cassandra, WildcardsCannotCostHours) {
  ReadOptions options;
  options.limits.expansions = 1000;
  const std::string text = "discount: 0.5\nvalues: reward\nstates: 40\nactions: 1\nT: * : * : * 0.025";
  EXPECT_EQ(testing::error_of([&] { read(text, options); }),
            "m.pomdp:5: wildcards and matrices write more than 1000 entries, expected fewer");
  const std::string observed =
      "discount: 0.5\nvalues: reward\nstates: 4\nactions: 2\nobservations: 2\nT: * uniform\nO: * uniform\n"
      "R: * : * : * : 0 1";
  options.limits.expansions = 63;
  EXPECT_EQ(testing::error_of([&] { read(observed, options); }),
            "m.pomdp:8: rewards that depend on observations need more than 63 terms, expected fewer");
  options.limits.expansions = 64;
  EXPECT_EQ(read(observed, options).mdp.reward(0, 0), 0.5);
  options = {};
  options.limits.transitions = 1000;
  EXPECT_EQ(testing::error_of([&] { read(text, options); }), "m.pomdp:5: more than 1000 transitions, expected fewer");
}

}  // namespace
}  // namespace maximin
