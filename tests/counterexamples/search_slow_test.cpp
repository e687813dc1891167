#include <gtest/gtest.h>

#include <maximin/counterexamples/gallery.hpp>
#include <maximin/counterexamples/search.hpp>
#include <maximin/counterexamples/tiny_models.hpp>

namespace maximin {
namespace {

/// The whole search: a quarter of a minute.
TEST(ExhaustiveSearch, FindsTheSharperBeliefOfTheGallery) {
  const Counterexample& c = find_counterexample("sharper-belief");
  const auto search = search_exhaustively(c, [] { return false; });
  ASSERT_TRUE(search.model);
  EXPECT_TRUE(search.model->mdp == c.model().mdp);
  EXPECT_EQ(tiny_size(search.model->mdp), 8);
  EXPECT_EQ(search.shapes.back().states, 2);
  EXPECT_EQ(search.shapes.back().actions, 3);
}

}  // namespace
}  // namespace maximin
