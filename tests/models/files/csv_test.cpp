#include <maximin/models/files/csv.hpp>

#include <gtest/gtest.h>

#include "model_file_testing.hpp"

namespace maximin {
namespace {

Model<double> read(std::string_view text) {
  return read_csv<double>(text, "m.csv");
}

TEST(Csv, AveragesRewardsOverTargets) {
  const Model<double> model = read(
      "idstatefrom,idaction,idstateto,probability,reward\n"
      "0,0,0,0.25,4\n0,0,1,0.75,0\n1,0,1,1,-3\n");
  EXPECT_EQ(model.mdp.reward(0, 0), 1);
  EXPECT_EQ(model.mdp.reward(1, 0), -3);
  EXPECT_EQ(model.mdp.successors(0, 0)[1].probability, 0.75);
}

TEST(Csv, TakesAnyOrderOfLinesAndColumnsAndNoHeader) {
  const Model<double> model = read("1,0,1,1,-3\r\n0,0,1,1,2\r\n");
  const Model<double> other = read("reward,probability,idstateto,idaction,idstatefrom\n2,1,1,0,0\n\n-3,1,1,0,1");
  EXPECT_TRUE(model.mdp == other.mdp);
  EXPECT_EQ(model.mdp.reward(0, 0), 2);
}

TEST(Csv, FillsActionsThatAStateLacksWithItsFirst) {
  const Model<double> model = read("0,0,1,1,5\n0,1,0,1,0\n1,0,1,1,7\n");
  EXPECT_EQ(model.mdp.actions(), 2);
  EXPECT_EQ(model.mdp.reward(1, 1), 7);
  EXPECT_EQ(model.mdp.successors(1, 1)[0].target, 1);
  EXPECT_EQ(model.notes[1],
            "actions: 1 (state, action) pairs that the file lacks act as the state's first choice, which leaves V* "
            "unchanged");
}

}  // namespace
}  // namespace maximin
