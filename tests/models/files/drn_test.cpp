#include <maximin/models/files/drn.hpp>

#include <gtest/gtest.h>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

Model<double> read(const std::string& text, const ReadOptions& options = {}) {
  return read_drn<double>(text, "m.drn", options);
}

std::string drn(const std::string& rewards, const std::string& states, const std::string& model) {
  return "// made by hand\n@type: MDP\n@parameters\n\n@reward_models\n" + rewards + "\n@nr_states\n" + states +
         "\n@model\n" + model;
}

TEST(Drn, AddsStateRewardsToEveryAction) {
  const Model<double> model = read(drn("r", "2",
                                       "state 0 [1] init\n\taction a [10]\n\t\t0 : 1/3\n\t\t1 : 2/3\n"
                                       "\taction b [0.5]\n\t\t1 : 1\nstate 1 [2] goal \"two words\"\n"
                                       "\taction a [0]\n\t\t1 : 1\n\taction b [4]\n\t\t0 : 1\n"));
  EXPECT_EQ(model.mdp.reward(0, 0), 11);
  EXPECT_EQ(model.mdp.reward(0, 1), 1.5);
  EXPECT_EQ(model.mdp.reward(1, 0), 2);
  EXPECT_EQ(model.mdp.reward(1, 1), 6);
  EXPECT_EQ(model.mdp.successors(0, 0)[1].probability, 2.0 / 3.0);
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(model.start, (std::vector<double>{1, 0}));
}

TEST(Drn, ActionsAreTheLabelsOfAllStates) {
  const Model<double> model = read(drn("", "2",
                                       "state 0\n\taction a\n\t\t0 : 1\n\taction b\n\t\t1 : 1\n"
                                       "state 1\n\taction c\n\t\t1 : 1\n\taction a\n\t\t0 : 1\n"));
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(model.mdp.successors(0, 2)[0].target, 0);  // state 0 lacks c: its first choice
  EXPECT_EQ(model.mdp.successors(1, 1)[0].target, 1);  // state 1 lacks b: its first choice, c
  EXPECT_EQ(model.mdp.successors(1, 0)[0].target, 0);
}

TEST(Drn, UnlabelledChoicesTakeFreeLabelsAndRepeatedOnesNewActions) {
  const Model<double> model = read(drn("", "2",
                                       "state 0\n\taction a\n\t\t0 : 1\n\taction a\n\t\t1 : 1\n"
                                       "state 1\n\taction __NOLABEL__\n\t\t0 : 1\n"));
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"a", "1"}));
  EXPECT_EQ(model.mdp.successors(0, 1)[0].target, 1);
  EXPECT_EQ(model.mdp.successors(1, 0)[0].target, 0);
}

TEST(Drn, NumbersAreNoNames) {
  const Model<double> model = read(drn("", "1", "state 0\n\taction 1\n\t\t0 : 1\n\taction 0\n\t\t0 : 1\n"));
  EXPECT_TRUE(model.action_names.empty());
}

TEST(Drn, TakesTheFirstOrTheNamedRewardModel) {
  const std::string text = drn("cost gain", "1", "state 0 [1, 2]\n\taction 0 [10, 20]\n\t\t0 : 1\n");
  EXPECT_EQ(read(text).mdp.reward(0, 0), 11);
  EXPECT_EQ(read(text).notes[0], "rewards: reward models cost, gain; the first taken, choose one with --reward-model");
  ReadOptions options;
  options.reward_model = "gain";
  EXPECT_EQ(read(text, options).mdp.reward(0, 0), 22);
}

TEST(Drn, ReplacesPlaceholdersAndSkipsObservations) {
  const Model<double> model = read(
      "@type: POMDP\n@parameters\n\n@placeholders\n$half : "
      "1/2\n@reward_models\n\n@nr_states\n2\n@nr_choices\n2\n@model\n"
      "state 0 {0} init\n\taction 0\n\t\t0 : $half\n\t\t1 : $half\nstate 1 {7}\n\taction 0\n\t\t1 : 1");
  EXPECT_EQ(model.mdp.successors(0, 0)[0].probability, 0.5);
}

TEST(Drn, ResolvesIntervalsOnlyWhenAsked) {
  const std::string text = drn("", "2",
                               "state 0\n\taction 0\n\t\t0 : [0.1, 0.2]\n\t\t1 : [0.5, 1]\n"
                               "state 1\n\taction 0\n\t\t1 : [1, 1]\n");
  EXPECT_EQ(testing::error_of([&] { read(text); }),
            "m.drn:11: probabilities are intervals, expected numbers; --intervals nominal takes from every row the "
            "member lo + t (hi - lo) that sums to 1");
  ReadOptions options;
  options.intervals = IntervalRows::nominal;
  const Model<double> model = read(text, options);
  const double t = 0.4 / 0.6;
  EXPECT_NEAR(model.mdp.successors(0, 0)[0].probability, 0.1 + t * 0.1, 1e-15);
  EXPECT_NEAR(model.mdp.successors(0, 0)[1].probability, 0.5 + t * 0.5, 1e-15);
}

TEST(Drn, IntervalsOfNoWidthAreNumbers) {
  EXPECT_EQ(read(drn("", "1", "state 0\n\taction 0\n\t\t0 : [1, 1]\n")).mdp.successors(0, 0)[0].probability, 1);
}

}  // namespace
}  // namespace maximin
