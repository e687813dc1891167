#include <maximin/models/files/gymnasium_json.hpp>

#include <gtest/gtest.h>

#include <maximin/tabular/value_iteration.hpp>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

Model<double> read(std::string_view text) {
  return read_gymnasium_json<double>(text, "g.json");
}

TEST(GymnasiumJson, AddsUpEntriesWithEqualTargets) {
  const Model<double> model = read(R"({"name":"corner","nS":2,"nA":1,"initial_distribution":[1,0],"P":[
      [[[0.33333333333333337,0,0.0,false],[0.3333333333333333,0,0.0,false],[0.33333333333333337,1,3.0,false]]],
      [[[1.0,1,0.0,false]]]]})");
  EXPECT_EQ(model.name, "corner");
  EXPECT_EQ(model.mdp.states(), 2);  // nothing terminates, so nothing is added
  ASSERT_EQ(model.mdp.successors(0, 0).size(), 2U);
  EXPECT_EQ(model.mdp.successors(0, 0)[0].probability, 0.33333333333333337 + 0.3333333333333333);
  EXPECT_NEAR(model.mdp.reward(0, 0), 1.0, 1e-15);
  EXPECT_EQ(model.start, (std::vector<double>{1, 0}));
  EXPECT_TRUE(model.state_names.empty());
}

// As in CliffWalking and Taxi: the row of a terminal state goes on, but an episode that ends there does not.
TEST(GymnasiumJson, TerminatedMeansNoBootstrap) {
  const Model<double> model = read(R"({"nS":2,"nA":1,"P":[
      [[[1.0,1,-1.0,true]]],
      [[[1.0,0,-100.0,false]]]]})");
  ASSERT_EQ(model.mdp.states(), 3);
  EXPECT_EQ(model.state_names, (std::vector<std::string>{"0", "1", "terminal"}));
  const auto solution = value_iteration(model.mdp);
  EXPECT_NEAR(solution.v[0], -1, 1e-12);
  EXPECT_NEAR(solution.v[1], -100 - 0.95, 1e-10);
  EXPECT_NEAR(solution.v[2], 0, 1e-12);
}

TEST(GymnasiumJson, TerminatedAndGoingOnToOneStateAreTwoThings) {
  const Model<double> model = read(R"({"nS":1,"nA":1,"P":[[[[0.5,0,0,true],[0.5,0,2,false]]]]})");
  EXPECT_EQ(model.mdp.successors(0, 0)[0], (Successor<double>{0, 0.5}));
  EXPECT_EQ(model.mdp.successors(0, 0)[1], (Successor<double>{1, 0.5}));
  EXPECT_EQ(model.mdp.reward(0, 0), 1);
}

TEST(GymnasiumJson, ReadsPythonDictionaries) {
  const Model<double> model = read(R"({"nS":2,"nA":1,"P":{"0":{"0":[[1,1,2,false]]},"1":{"0":[[1,1,0,false]]}}})");
  EXPECT_EQ(model.mdp.reward(0, 0), 2);
  EXPECT_EQ(model.mdp.successors(0, 0)[0].target, 1);
}

TEST(GymnasiumJson, SaysWhatItAssumed) {
  const Model<double> model = read(R"({"nS":1,"nA":1,"P":[[[[1,0,1,true]]]]})");
  EXPECT_EQ(model.mdp.discount(), 0.95);
  EXPECT_EQ(model.notes,
            (std::vector<std::string>{"discount: the file gives none, 0.95 assumed; choose one with --discount",
                                      "terminated: entries that end the episode lead to the added state 1, 'terminal', "
                                      "which absorbs at reward 0"}));
}

}  // namespace
}  // namespace maximin
