#include <maximin/models/nearest_name.hpp>

#include <gtest/gtest.h>

namespace maximin {
namespace {

const std::vector<std::string> names{"eps", "points", "states", "state_names", "--model", "--metric"};

TEST(NearestName, IsTheOneFewestEditsAway) {
  EXPECT_EQ(nearest_name("sates", names), "states");
  EXPECT_EQ(nearest_name("--modle", names), "--model");
  EXPECT_EQ(nearest_name("esp", names), "eps");
}

TEST(NearestName, IsTheOneAbbreviatedOrSpeltOut) {
  EXPECT_EQ(nearest_name("epsilon", names), "eps");
  EXPECT_EQ(nearest_name("--met", names), "--metric");
}

TEST(NearestName, IsEmptyWhereNothingIsNear) {
  EXPECT_EQ(nearest_name("transitions", names), "");
  EXPECT_EQ(nearest_name("--", names), "");
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name(std::string(100, 's'), names), "");
}

}  // namespace
}  // namespace maximin
