#include <gtest/gtest.h>

#include <set>
#include <sstream>
#include <string>

#include <maximin/counterexamples/gallery.hpp>
#include <maximin/counterexamples/search.hpp>
#include <maximin/counterexamples/tiny_models.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

bool never() {
  return false;
}

TEST(TinyModels, AreAllDifferentAndComeBySize) {
  std::set<std::string> seen;
  Rational last(0);
  const long count = visit_tiny_models(2, 1, [&](const Model<Rational>& model) {
    std::ostringstream text;
    write_maximin_json(model, text);
    EXPECT_TRUE(seen.insert(text.str()).second);
    const Rational size = tiny_size(model.mdp);
    EXPECT_LE(last, size);
    last = size;
    return false;
  });
  EXPECT_EQ(count, 15 * 15) << "5 rewards and 3 rows in either state";
  EXPECT_EQ(visit_tiny_models(2, 2, [](const auto&) { return false; }), 225 * 224 / 2);
  EXPECT_EQ(visit_tiny_models(2, 2, [](const auto&) { return true; }), 1);
  EXPECT_EQ(visit_tiny_models(1, 6, [](const auto&) { return false; }), 0) << "there are but 5 actions to choose from";
  EXPECT_THROW(visit_tiny_models(4, 1, [](const auto&) { return false; }), InputError);
}

TEST(ExhaustiveSearch, FindsTheModelOfTheGallery) {
  const Counterexample& c = find_counterexample("stationary-optimum");
  const auto search = search_exhaustively(c, never);
  ASSERT_TRUE(search.model);
  EXPECT_TRUE(search.model->mdp == c.model().mdp);
  EXPECT_EQ(tiny_size(search.model->mdp), 2);
  for (const auto& shape : search.shapes) EXPECT_TRUE(shape.all);
}

TEST(ExhaustiveSearch, NoSharperBeliefHurtsWithTwoStatesAndTwoActions) {
  const Counterexample& c = find_counterexample("sharper-belief");
  visit_tiny_models(2, 2, [&](const Model<Rational>& model) {
    EXPECT_FALSE(c.searched(model));
    return false;
  });
}

TEST(ExhaustiveSearch, StopsWhenAsked) {
  int asked = 0;
  const auto search = search_exhaustively(find_counterexample("sharper-belief"), [&] { return ++asked > 100; });
  EXPECT_FALSE(search.model);
  EXPECT_FALSE(search.shapes.back().all);
}

TEST(RandomSearch, FindsSmallOnesThatTheCheckRefutes) {
  for (const char* name : {"stationary-optimum", "sharper-belief"}) {
    const Counterexample& c = find_counterexample(name);
    const auto search = search_randomly(c, 1, never);
    ASSERT_TRUE(search.model) << name;
    EXPECT_TRUE(c.check(*search.model).refuted) << name;
    EXPECT_LE(search.model->mdp.states(), 3) << name;
  }
}

TEST(Search, RefusesWhatHasNone) {
  EXPECT_THROW(search_exhaustively(find_counterexample("settling"), never), InputError);
  EXPECT_THROW(search_randomly(find_counterexample("settling"), 1, never), InputError);
}

}  // namespace
}  // namespace maximin
