#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <maximin/apps/maximin_deep/table_plan.hpp>
#include <maximin/deep/attacks/named_attack.hpp>

namespace maximin::apps {
namespace {

const char* const our_title = "BP-DQN (exact belief, mean)";

TEST(TablePlan, HasEveryCellOnceAndEveryRowAndColumnOfThePaper) {
  const std::vector<PlannedCell> plan = gridworld_plan();
  std::set<std::tuple<std::string, std::string, std::string, double>> cells;
  std::map<std::string, int> figures;  // of the paper's block
  for (const PlannedCell& c : plan) {
    EXPECT_TRUE(cells.emplace(c.block, c.cell.agent, c.cell.attack, c.cell.eps).second)
        << c.cell.agent << c.cell.attack;
    if (c.block == "the paper's attacks" && c.cell.paper) ++figures[c.cell.agent];
    if (c.is_trained()) {
      EXPECT_NO_THROW(spec_of(c, 1, {}));
    }
  }
  for (const char* agent : {"DQN", "SA-DQN", "WocaR-DQN", "Radial-DQN", our_title, "BP-DQN (PF-LSTM, min)"}) {
    EXPECT_EQ(figures[agent], 7) << agent;
  }
  EXPECT_EQ(figures["CAR-DQN"], 0);  // not in the paper
  // Without attack a DQN is one agent for both radii, the others are trained for each.
  EXPECT_TRUE(cells.contains({"the paper's attacks", "DQN", "natural", 0.0}));
  EXPECT_FALSE(cells.contains({"the paper's attacks", "DQN", "natural, trained for 0.5", 0.0}));
  EXPECT_TRUE(cells.contains({"the paper's attacks", "SA-DQN", "natural, trained for 0.5", 0.0}));
}

TEST(TablePlan, TargetsAreThePapersMeansForOneAgentAlone) {
  std::map<std::string, double> targets;
  for (const PlannedCell& c : gridworld_plan()) {
    if (!c.cell.target) continue;
    EXPECT_EQ(c.cell.agent, our_title) << c.block;
    EXPECT_EQ(c.cell.target->sense, deep::Target::Sense::at_least);
    targets[c.attack + " " + std::to_string(static_cast<int>(10 * c.attack_eps))] = c.cell.target->value;
  }
  const std::map<std::string, double> expected{{"none 0", 163},     {"pgd 1", 165},          {"pgd 5", 176},
                                               {"min-best 1", 147}, {"min-best 5", 114},     {"pa-ad 1", 171.9},
                                               {"pa-ad 5", 177.2},  {"pgd-released 1", 165}, {"pgd-released 5", 176}};
  EXPECT_EQ(targets, expected);
}

deep::ResultTable table_of(const std::vector<std::tuple<std::string, std::string, std::vector<double>>>& cells) {
  deep::ResultTable table;
  table.blocks = {
      {"the paper's attacks", "", {}}, {"attacks that the paper did not try", "", {}}, {"ablation", "", {}}};
  for (const auto& [block, attack, means] : cells) {
    deep::ResultCell cell;
    cell.agent = our_title;
    cell.attack = attack;
    cell.eps = 0.5;
    for (std::size_t i = 0; i < means.size(); ++i) cell.runs.push_back({i + 1, 1001 + i, {means[i], means[i]}, 0});
    table.find(block)->cells.push_back(cell);
  }
  return table;
}

TEST(TablePlan, TheStrongestIsLeastOfBothBlocksOverCommonSeeds) {
  const char* const paper = "the paper's attacks";
  const char* const further = "attacks that the paper did not try";
  const auto strongest = [](deep::ResultTable table) {
    add_strongest(table);
    add_strongest(table);  // once more changes nothing
    EXPECT_EQ(table.blocks.size(), 4U);
    EXPECT_EQ(table.blocks[2].name, "the strongest of these");
    EXPECT_EQ(table.blocks[2].cells.size(), 1U);
    return table.blocks[2].cells.at(0);
  };
  const deep::ResultCell a =
      strongest(table_of({{paper, "PGD", {150, 160}}, {further, "director", {140, 150}}, {"ablation", "PGD", {0, 0}}}));
  EXPECT_EQ(a.note, "by director");
  EXPECT_EQ(a.runs.size(), 2U);
  EXPECT_EQ(a.target->value, 73);
  EXPECT_EQ(strongest(table_of({{paper, "PGD", {150, 130}}, {further, "director", {140, 150}}})).note, "by PGD");
  // A director that was run on the first seed alone is compared there, and not left out.
  const deep::ResultCell b = strongest(table_of({{paper, "PGD", {150, 100}}, {further, "director", {140}}}));
  EXPECT_EQ(b.note, "by director");
  EXPECT_EQ(b.runs.size(), 1U);
  deep::ResultTable nothing = table_of({{paper, "PGD", {}}});
  add_strongest(nothing);
  EXPECT_EQ(nothing.blocks.size(), 3U);
}

TEST(TablePlan, NotesSayWhatWasDone) {
  EXPECT_NE(block_note("the paper's attacks", {}).find("1000000 frames and 250000 updates"), std::string::npos);
  EXPECT_NE(block_note("the paper's attacks", deep::Effort(false, 4000)).find("4000 frames and 1000 updates"),
            std::string::npos);
}

}  // namespace
}  // namespace maximin::apps
