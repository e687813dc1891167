#include <maximin/models/files/prism_explicit.hpp>

#include <fmt/format.h>
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

TEST(PrismExplicit, TransitionRewardsComeInAnyOrder) {
  PrismCompanions companions;
  companions.transition_rewards = {"2 2 3\n1 0 1 7\n0 0 1 8\n0 0 0 4\n", "m.trew"};
  const Model<double> model = read("2 2 3\n0 0 1 0.75\n0 0 0 0.25\n1 0 1 1\n", companions);
  EXPECT_EQ(model.mdp.reward(0, 0), 0.25 * 4 + 0.75 * 8);
  EXPECT_EQ(model.mdp.reward(1, 0), 7);
}

TEST(PrismExplicit, RefusesRewardsGivenTwiceOrOfNothing) {
  const auto error = [](const PrismCompanions& companions) {
    return testing::error_of([&] { read("2 2 2\n0 0 0 1\n1 0 1 1\n", companions); });
  };
  PrismCompanions companions;
  companions.state_rewards = {"2 2\n1 5\n0 1\n1 5\n", "m.srew"};
  EXPECT_EQ(error(companions), "m.srew:4: the reward of state 1 is given twice, expected each state once");
  companions = {};
  companions.transition_rewards = {"2 2 2\n1 0 1 4\n0 0 0 4\n1 0 1 5\n", "m.trew"};
  EXPECT_EQ(error(companions), "m.trew:4: the reward to state 1 is given twice, expected each transition once");
  companions.transition_rewards = {"2 2 1\n0 0 1 4\n", "m.trew"};
  EXPECT_EQ(error(companions),
            "m.trew:2: the choice has no transition to state 1, expected a transition of the .tra file");
}

// What a terminal would act on instead of showing it.
TEST(PrismExplicit, RefusesActionNamesThatAreNoText) {
  for (const std::string active : {"\u0085", "\u009B", "\u202A", "\u202E", "\u2066", "\u2069"}) {
    const std::string said = testing::error_of([&] { read("1 1 1\n0 0 0 1 a" + active + "\n"); });
    std::string escaped = "a";
    for (const unsigned char byte : active) escaped += fmt::format("\\x{:02x}", byte);
    EXPECT_EQ(said, "m.tra:2: '" + escaped + "': expected a name without control characters");
  }
  for (const std::string shown : {"\u00A0", "\u2029", "\u202F", "\u2065", "\u206A", "\u00E9"}) {
    EXPECT_EQ(read("1 1 1\n0 0 0 1 a" + shown + "\n").action_names, std::vector<std::string>{"a" + shown});
  }
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
