#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numeric>
#include <sstream>
#include <string>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model_draft.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

bool is_whole(double x) {
  return x == std::floor(x);
}

bool rows_sum_to_one(const FiniteMdp<double>& mdp) {
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      double sum = 0;
      for (const auto& next : mdp.successors(s, a)) sum += next.probability;
      if (std::abs(sum - 1) > 1e-12) return false;
    }
  }
  return true;
}

RC_GTEST_PROP(Arbitrary, GivesValidModelsWithBalls, (const Model<double>& model)) {
  RC_ASSERT(rows_sum_to_one(model.mdp));
  const auto balls = make_perturbation(model);
  RC_ASSERT(balls.states() == model.mdp.states());
  const bool distinct = model_constants(model.mdp, balls.metric()).finite();
  RC_ASSERT(distinct);
  RC_TAG(model.name.empty() ? "small integers" : "campaign family");
}

RC_GTEST_PROP(Arbitrary, GivesBareMdps, (const FiniteMdp<double>& mdp)) {
  RC_ASSERT(rows_sum_to_one(mdp));
  std::ostringstream shown;
  showValue(mdp, shown);
  RC_ASSERT(read_maximin_json<double>(shown.str(), "shown").mdp == mdp);
}

/// The corners that only small integers reach must turn up.
TEST(SmallRandomModel, ReachesTheCorners) {
  int one_state = 0, myopic = 0, no_reward = 0, alone = 0, all_in_one_ball = 0, absorbing = 0;
  for (std::uint64_t k = 0; k < 1000; ++k) {
    Stream rng(9, k);
    const auto model = small_random_model(static_cast<int>(k % 100), rng);
    const auto& mdp = model.mdp;
    const auto balls = make_perturbation(model);
    one_state += mdp.states() == 1;
    myopic += mdp.discount() == 0;
    no_reward += mdp.rewards().cwiseAbs().maxCoeff() == 0;
    alone += mdp.states() > 1 && balls.largest_ball() == 1;
    all_in_one_ball += mdp.states() > 1 && balls.ball(0).size() == static_cast<std::size_t>(mdp.states());
    absorbing += mdp.successors(0, 0).size() == 1 && mdp.successors(0, 0).front().target == 0;
  }
  for (const int count : {one_state, myopic, no_reward, alone, all_in_one_ball, absorbing}) EXPECT_GE(count, 20);
}

RC_GTEST_PROP(Shrink, EveryStepGivesASimplerValidModel, (const Model<double>& model)) {
  const auto size = [](const Model<double>& m) { return std::pair(m.mdp.states(), m.mdp.actions()); };
  for (const auto& simpler : simpler_models(model)) {
    RC_ASSERT(rows_sum_to_one(simpler.mdp));
    RC_ASSERT(size(simpler) <= size(model));
    RC_ASSERT(make_perturbation(simpler).states() == simpler.mdp.states());
    RC_ASSERT(simpler.mdp.discount() <= std::max(model.mdp.discount(), 0.5) + 0.05);
  }
}

RC_GTEST_PROP(Shrink, EndsAtTheSimplestModelThatKeepsIt, (const Model<double>& model)) {
  // No condition at all: one state, one action, nothing but zeros.
  const auto simplest = shrink(model, [](const auto&) { return true; });
  RC_ASSERT(simplest.mdp.states() == 1 && simplest.mdp.actions() == 1 && simplest.mdp.discount() == 0);
  RC_ASSERT(simplest.mdp.reward(0, 0) == 0 && simplest.geometry.points.cwiseAbs().maxCoeff() == 0);
}

RC_GTEST_PROP(Shrink, KeepsWhatItMustAndStopsWhereNothingSimplerDoes, ()) {
  const auto big = *rc::gen::suchThat(rc::gen::resize(100, arbitrary_model()), [](const auto& m) {
    return m.mdp.states() >= 2 && m.mdp.rewards().maxCoeff() > 0.5;
  });
  const ModelPredicate keeps = [](const Model<double>& m) {
    return m.mdp.states() >= 2 && m.mdp.rewards().maxCoeff() > 0.5;
  };
  const auto small = shrink(big, keeps);
  RC_ASSERT(keeps(small));
  RC_ASSERT(!visit_simpler_models(small, keeps));
  RC_ASSERT(small.mdp.states() == 2 && small.mdp.actions() == 1 && small.mdp.transition_count() == 2u);
  RC_ASSERT(small.mdp.rewards().sum() == 1);
}

TEST(Shrink, ACycleShrinksToAFewStatesAndShortNumbers) {
  const ModelPredicate cycles = [](const Model<double>& m) {
    PessimisticQIterationOptions<double> options;
    options.max_iterations = 5'000;
    return pessimistic_q_iteration(m.mdp, make_perturbation(m), options).fate == Fate::cycles;
  };
  int seen = 0;
  for (std::uint64_t trial = 0; seen < 10; ++trial) {
    Stream rng(11, trial);
    const auto model = draw_family_member(Family::sparse, {.states = Range<State>{8, 12}}, rng).model;
    if (!cycles(model)) continue;
    ++seen;
    const auto small = shrink(model, cycles);
    EXPECT_TRUE(cycles(small));
    EXPECT_LE(small.mdp.states(), 4) << "trial " << trial;
    EXPECT_LE(small.mdp.actions(), 3) << "trial " << trial;
    EXPECT_TRUE(small.mdp.rewards().unaryExpr([](double r) { return is_whole(r * 10) ? 1.0 : 0.0; }).minCoeff() == 1);
  }
}

/// A violation of Theorem 1 as printed, with R <= R_max only, shrinks to the size of the counterexample known by hand,
/// three states and two actions; now and then to four states, of which none can go by itself.
TEST(Shrink, AViolationShrinksToThreeStatesOrFour) {
  const ModelPredicate violates = [](const Model<double>& m) {
    const auto balls = make_perturbation(m);
    const auto c = model_constants(m.mdp, balls.metric());
    const auto run = pessimistic_q_iteration(m.mdp, balls);
    if (!c.finite() || run.fate != Fate::settled) return false;
    const double gamma = m.mdp.discount();
    const double l =
        bounds::lipschitz_of_q_printed(gamma, c.l_r.value, c.l_p.value, m.mdp.states(), std::max(0.0, c.r_max_signed));
    const double bound = bounds::theorem_1(gamma, bounds::delta(balls.radius(), gamma, l));
    return (value_iteration(m.mdp).q - run.q).cwiseAbs().maxCoeff() > bound + 1e-6;
  };
  int seen = 0, three = 0;
  for (std::uint64_t trial = 0; seen < 10; ++trial) {
    Stream rng(12, trial);
    const auto model = draw_family_member(Family::costs, {.states = Range<State>{5, 8}}, rng).model;
    if (!violates(model)) continue;
    ++seen;
    const auto small = shrink(model, violates);
    EXPECT_TRUE(violates(small));
    EXPECT_LE(small.mdp.states(), 4) << "trial " << trial;
    EXPECT_EQ(small.mdp.actions(), 2) << "trial " << trial;
    EXPECT_EQ(small.mdp.transition_count(), static_cast<std::size_t>(2 * small.mdp.states())) << "trial " << trial;
    three += small.mdp.states() == 3;
  }
  EXPECT_GE(three, 6);
}

TEST(Shrink, TriesNoMoreThanAllowed) {
  Stream rng(1);
  const auto model = draw_family_member(Family::informative, {}, rng).model;
  long tests = 0;
  const auto count = [&](const auto&) {
    ++tests;
    return false;
  };
  EXPECT_EQ(shrink(model, count, 7).mdp, model.mdp);
  EXPECT_EQ(tests, 7);
}

Model<double> three_states() {
  FiniteMdpBuilder<double> b(3, 1, 0.5);
  b.transition(0, 0, 1, 0.5).transition(0, 0, 2, 0.5);
  b.transition(1, 0, 1, 1).transition(2, 0, 0, 0.25).transition(2, 0, 1, 0.75);
  b.reward(0, 0, 10).reward(1, 0, 11).reward(2, 0, 12);
  Model<double> m{.mdp = std::move(b).build()};
  m.state_names = {"left", "middle", "right"};
  m.start = {0.5, 0.25, 0.25};
  m.geometry.kind = Geometry<double>::Kind::neighbourhoods;
  m.geometry.neighbourhoods = {{0, 1}, {0, 1, 2}, {1, 2}};
  return m;
}

TEST(ModelDraft, DroppedStatesAreRedirected) {
  ModelDraft draft(three_states());
  draft.keep_states({true, false, true}, std::nullopt);
  const auto m = std::move(draft).build();
  ASSERT_EQ(m.mdp.states(), 2);
  EXPECT_EQ(m.mdp.reward(1, 0), 12);
  const auto from_left = m.mdp.successors(0, 0), from_right = m.mdp.successors(1, 0);
  EXPECT_EQ(std::vector(from_left.begin(), from_left.end()), (ModelDraft::Row{{0, 0.5}, {1, 0.5}}));
  EXPECT_EQ(std::vector(from_right.begin(), from_right.end()), (ModelDraft::Row{{0, 0.25}, {1, 0.75}}));
  EXPECT_EQ(m.state_names, (std::vector<std::string>{"left", "right"}));
  EXPECT_EQ(m.start, (std::vector{2.0 / 3, 1.0 / 3}));
  EXPECT_EQ(m.geometry.neighbourhoods, (std::vector<std::vector<State>>{{0}, {1}}));

  ModelDraft other(three_states());
  other.keep_states({true, false, true}, 2);
  const auto to_right = std::move(other).build();
  EXPECT_EQ(to_right.mdp.successors(0, 0).size(), 1u);
  EXPECT_EQ(to_right.mdp.successors(0, 0)[0], (Successor<double>{1, 1.0}));
  EXPECT_EQ(to_right.mdp.successors(1, 0)[1], (Successor<double>{1, 0.75}));
}

TEST(ModelDraft, RoundsRowsByLargestRemainder) {
  const ModelDraft::Row row{{0, 0.2}, {1, 0.5}, {2, 0.3}};
  EXPECT_EQ(rounded_row(row, 2), (ModelDraft::Row{{1, 0.5}, {2, 0.5}}));
  EXPECT_EQ(rounded_row(row, 4), (ModelDraft::Row{{0, 0.25}, {1, 0.5}, {2, 0.25}}));
  EXPECT_EQ(deterministic_row(row), (ModelDraft::Row{{1, 1.0}}));
}

RC_GTEST_PROP(ModelDraft, RoundedRowsSumToOne, ()) {
  const auto weights = *rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(rc::gen::inRange(1, 1000)));
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  ModelDraft::Row row;
  for (std::size_t i = 0; i < weights.size(); ++i) row.push_back({static_cast<State>(i), weights[i] / total});
  const int parts = *rc::gen::element(2, 4, 8, 64);
  double sum = 0;
  for (const auto& next : rounded_row(row, parts)) {
    RC_ASSERT(next.probability > 0 && is_whole(next.probability * parts));
    sum += next.probability;
  }
  RC_ASSERT(sum == 1);
}

}  // namespace
}  // namespace maximin
