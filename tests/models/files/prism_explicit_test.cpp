#include <maximin/models/files/prism_explicit.hpp>

#include <gtest/gtest.h>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

Model<double> read(std::string_view text, const PrismCompanions& companions = {}, const ReadOptions& options = {}) {
  return read_prism_explicit<double>(text, "m.tra", options, companions);
}

TEST(PrismExplicit, EntriesAndRowsAreTheSameModel) {
  const Model<double> entries = read("# Transitions (MDP)\n2 3 4\n0 0 0 0.25 a\n0 0 1 3/4 a\n0 1 1 1 b\n1 0 1 1 a\n");
  const Model<double> rows = read("2 3 4\n0 0.25:0 3/4:1 a\n0 1:1 b\n1 1:1 a\n");
  EXPECT_TRUE(entries.mdp == rows.mdp);
  EXPECT_EQ(entries.action_names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(rows.action_names, entries.action_names);
  EXPECT_EQ(entries.mdp.successors(1, 1)[0].target, 1);  // state 1 lacks b
}

TEST(PrismExplicit, ReadsRewardsLabelsAndStates) {
  PrismCompanions companions;
  companions.state_rewards = {"# Reward structure \"r\"\n# State rewards\n2 1\n1 5\n", "m.srew"};
  companions.transition_rewards = {"2 2 2\n0 0 0 4\n0 0 1 8\n", "m.trew"};
  companions.labels = {"0=\"init\" 1=\"deadlock\"\n1: 0\n", "m.lab"};
  companions.states = {"(x)\n0:(7)\n1:(8)\n", "m.sta"};
  const Model<double> model = read("2 2 3\n0 0 0 0.25\n0 0 1 0.75\n1 0 1 1\n", companions);
  EXPECT_EQ(model.mdp.reward(0, 0), 0.25 * 4 + 0.75 * 8);
  EXPECT_EQ(model.mdp.reward(1, 0), 5);
  EXPECT_EQ(model.start, (std::vector<double>{0, 1}));
  EXPECT_EQ(model.state_names, (std::vector<std::string>{"(7)", "(8)"}));
}

TEST(PrismExplicit, ReadsThePomdpsMdp) {
  const Model<double> model = read("# Transitions (POMDP)\n2 2 2 2\n- - 0 - 0\n0 0 1 1 1 go\n1 0 1 1 1 go\n");
  EXPECT_EQ(model.mdp.successors(0, 0)[0].target, 1);
  EXPECT_EQ(model.action_names, std::vector<std::string>{"go"});
}

TEST(PrismExplicit, ReadsChains) {
  EXPECT_EQ(read("2 3\n0 0 0.5\n0 1 0.5\n1 1 1\n").mdp.actions(), 1);
}

TEST(PrismExplicit, ReadsStormsDialect) {
  PrismCompanions companions;
  companions.labels = {"#DECLARATION\ninit done\n#END\n0 init\n1 done\n", "m.lab"};
  const Model<double> model = read("mdp\n0 0 1 1 \n0 1 0 1 \n1 0 1 1 \n", companions);
  EXPECT_EQ(model.mdp.actions(), 2);
  EXPECT_EQ(model.start, (std::vector<double>{1, 0}));
  EXPECT_EQ(model.notes[0], "rewards: no .srew or .trew file, all rewards are 0");
}

TEST(PrismExplicit, ResolvesIntervalsBeforeItAverages) {
  PrismCompanions companions;
  companions.transition_rewards = {"2 2 2\n0 0 0 10\n", "m.trew"};
  ReadOptions options;
  options.intervals = IntervalRows::nominal;
  const Model<double> model = read("2 2 3\n0 0 0 [0,1]\n0 0 1 [0,1]\n1 0 1 1\n", companions, options);
  EXPECT_EQ(model.mdp.successors(0, 0)[0].probability, 0.5);
  EXPECT_EQ(model.mdp.reward(0, 0), 5);
}

TEST(PrismExplicit, AnUnlabelledChoiceTakesAFreeLabel) {
  const Model<double> model = read("2 3 3\n0 0 0 1 b\n0 1 1 1 a\n1 0 0 1\n");
  EXPECT_EQ(model.action_names, (std::vector<std::string>{"b", "a"}));
  EXPECT_EQ(model.mdp.successors(1, 0)[0].target, 0);
  EXPECT_EQ(model.mdp.successors(1, 1)[0].target, 0);
}

}  // namespace
}  // namespace maximin
