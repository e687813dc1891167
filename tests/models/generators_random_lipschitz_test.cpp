#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

Metric<double> metric_of(const Model<double>& model) {
  return Metric<double>::from_points(model.geometry.points, model.geometry.norm);
}

ModelConstants<double> constants_of(const Model<double>& model) {
  return model_constants(model.mdp, metric_of(model));
}

bool near(double found, double wanted) {
  return std::abs(found - wanted) <= 1e-9 * wanted;
}

/// Options over the whole documented range of what a campaign asks; l_p is set later, as a share of what is in reach.
LipschitzMdpOptions any_options() {
  LipschitzMdpOptions o;
  o.states = *rc::gen::inRange(2, 16);
  o.actions = *rc::gen::inRange(1, 5);
  o.discount = *rc::gen::element(0.0, 0.5, 0.9);
  o.dimension = *rc::gen::inRange(1, 4);
  o.layout = *rc::gen::element(PointLayout::uniform, PointLayout::lattice, PointLayout::line);
  o.norm = *rc::gen::element(Norm::l1, Norm::l2, Norm::linf);
  o.side = *rc::gen::element(0.01, 1.0, 100.0);
  o.l_r = *rc::gen::element(0.0, 1e-3, 1.0, 50.0);
  o.sign = *rc::gen::element(RewardSign::mixed, RewardSign::nonnegative, RewardSign::nonpositive);
  o.successors = *rc::gen::element(0, 2, 3, 5);
  o.sharpness = *rc::gen::element(0.0, 0.5, 1.0);
  o.action_gap = *rc::gen::element(0.0, 0.1, std::numeric_limits<double>::infinity());
  return o;
}

Model<double> draw(LipschitzMdpOptions& o, double share_of_reach, Stream& rng) {
  const auto points = random_points(o.layout, o.states, o.dimension, o.side, rng);
  const auto distances = pairwise_distances(Metric<double>::from_points(points, o.norm));
  o.l_p = share_of_reach / distances.least;
  return random_lipschitz_mdp(points, o, rng);
}

RC_GTEST_PROP(RandomLipschitzMdp, MeetsTheRequestedConstants, ()) {
  auto o = any_options();
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto model = draw(o, *rc::gen::element(0.0, 1e-4, 0.01, 0.2, 0.7, 1.0), rng);
  const auto c = constants_of(model);
  RC_TAG(o.successors == 0 ? "dense" : "sparse");
  RC_ASSERT(near(c.l_r.value, o.l_r));
  RC_ASSERT(near(c.l_p.value, o.l_p));
  RC_ASSERT(model.mdp.states() == o.states && model.mdp.actions() == o.actions);
  RC_ASSERT(model.geometry.eps == o.eps);
}

RC_GTEST_PROP(RandomLipschitzMdp, KeepsSignSpanGapAndSparsity, ()) {
  auto o = any_options();
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto model = draw(o, *rc::gen::element(0.0, 0.2, 1.0), rng);
  const auto& r = model.mdp.rewards();
  const double slack = 1e-12 * (1 + r.cwiseAbs().maxCoeff());
  if (o.sign == RewardSign::nonnegative) RC_ASSERT(r.minCoeff() == 0);
  if (o.sign == RewardSign::nonpositive) RC_ASSERT(r.maxCoeff() == 0);
  if (o.sign == RewardSign::mixed) RC_ASSERT(r.minCoeff() <= slack && r.maxCoeff() >= -slack);
  for (State s = 0; s < o.states; ++s) {
    for (Action a = 0; a < o.actions; ++a) {
      RC_ASSERT(std::abs(r(s, a) - r(s, 0)) <= o.action_gap + slack);
      if (o.successors > 0) RC_ASSERT(model.mdp.successors(s, a).size() <= static_cast<std::size_t>(o.successors));
    }
  }
}

RC_GTEST_PROP(RandomLipschitzMdp, MeetsARequestedSpanTogetherWithTheConstant, ()) {
  auto o = any_options();
  o.l_r = 1;
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto points = random_points(o.layout, o.states, o.dimension, o.side, rng);
  const auto distances = pairwise_distances(Metric<double>::from_points(points, o.norm));
  const bool beyond = o.actions > 1 && std::isinf(o.action_gap) && *rc::gen::arbitrary<bool>();
  const double share = *rc::gen::element(0.0, 0.3, 1.0);
  o.reward_span = beyond ? 3 * distances.diameter : distances.least + share * (distances.diameter - distances.least);
  o.l_p = 0;
  const auto c = constants_of(random_lipschitz_mdp(points, o, rng));
  RC_ASSERT(near(c.l_r.value, o.l_r));
  RC_ASSERT(near(c.span, *o.reward_span));
}

RC_GTEST_PROP(RandomLipschitzMdp, IsAFunctionOfTheStream, ()) {
  auto o = any_options();
  o.states += 5;  // enough room for two draws never to coincide
  o.sign = RewardSign::mixed;
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Stream one(seed, 3), same(seed, 3), other(seed, 4);
  const auto model = draw(o, 0.1, one);
  RC_ASSERT(model.mdp == draw(o, 0.1, same).mdp);
  RC_ASSERT(!(model.mdp == draw(o, 0.1, other).mdp));
}

/// Negative control: the check that the properties make notices a kernel contracted by a little too little, and rewards
/// scaled by a little too much.
TEST(RandomLipschitzMdp, AWrongScaleIsNoticed) {
  LipschitzMdpOptions o;
  Stream rng(1);
  const auto model = random_lipschitz_mdp(o, rng);
  ASSERT_TRUE(near(constants_of(model).l_p.value, o.l_p));
  FiniteMdpBuilder<double> wrong(o.states, o.actions, o.discount);
  for (State s = 0; s < o.states; ++s) {
    for (Action a = 0; a < o.actions; ++a) {
      wrong.reward(s, a, model.mdp.reward(s, a) * (1 + 1e-8));
      const double t = 1 - 1e-8;
      for (const auto& next : model.mdp.successors(s, a)) {
        wrong.transition(s, a, next.target, t * next.probability + (1 - t) / o.states);
      }
    }
  }
  const auto c = model_constants(std::move(wrong).build(), metric_of(model));
  EXPECT_FALSE(near(c.l_p.value, o.l_p));
  EXPECT_FALSE(near(c.l_r.value, o.l_r));
}

std::string error_of(const LipschitzMdpOptions& o) {
  Stream rng(7);
  try {
    random_lipschitz_mdp(o, rng);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(RandomLipschitzMdp, SaysWhatIsInReach) {
  LipschitzMdpOptions o;
  o.layout = PointLayout::line;
  o.states = 5;  // 0.25 apart: no kernel changes faster than 4 per unit
  o.l_p = 4;
  EXPECT_EQ(error_of(o), "no error");
  o.l_p = 5;
  EXPECT_EQ(error_of(o),
            "l_p: 5 requested, expected at most 4, the largest that any kernel reaches on these points (states 0 and 1 "
            "lie 0.25 apart)");
  o.l_p = 0;
  o.actions = 1;
  o.reward_span = 2;
  EXPECT_EQ(error_of(o), "reward_span: 2 requested, expected 0.25 to 1 on these points with l_r 1");
  o.actions = 2;
  EXPECT_EQ(error_of(o), "no error");
  o.reward_span = 0.1;
  EXPECT_EQ(error_of(o), "reward_span: 0.1 requested, expected at least 0.25 on these points with l_r 1");
  o.reward_span.reset();
  o.states = 1;
  EXPECT_EQ(error_of(o), "l_r: 1 requested, expected 0, the largest there is with one state");
  o.l_r = 0;
  EXPECT_EQ(error_of(o), "no error");
  o.l_p = 0.1;
  EXPECT_EQ(
      error_of(o),
      "l_p: 0.1 requested, expected at most 0, the largest that any kernel reaches on these points (there is only "
      "one state)");
}

TEST(RandomLipschitzMdp, RejectsOptionsOutOfRange) {
  const auto error_with = [](auto change) {
    LipschitzMdpOptions o;
    change(o);
    return error_of(o);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(error_with([](auto& o) { o.states = 0; }), "states: 0, expected 1 to 2000");
  EXPECT_EQ(error_with([](auto& o) { o.actions = 0; }), "actions: 0, expected 1 to 1000");
  EXPECT_EQ(error_with([](auto& o) { o.discount = 1; }), "discount: 1, expected 0 <= discount < 1");
  EXPECT_EQ(error_with([](auto& o) { o.dimension = 0; }), "dimension: 0, expected 1 to 16");
  EXPECT_EQ(error_with([](auto& o) { o.side = 0; }), "side: 0, expected a positive finite number");
  EXPECT_EQ(error_with([](auto& o) { o.successors = 1; }), "successors: 1, expected 0 (dense) or at least 2");
  EXPECT_EQ(error_with([&](auto& o) { o.eps = nan; }), "eps: nan, expected a finite number >= 0");
  EXPECT_EQ(error_with([&](auto& o) { o.l_r = nan; }), "l_r: nan, expected a finite number >= 0");
  EXPECT_EQ(error_with([](auto& o) { o.l_p = -1; }), "l_p: -1, expected a finite number >= 0");
  EXPECT_EQ(error_with([](auto& o) { o.sharpness = 2; }), "sharpness: 2, expected 0 to 1");
  EXPECT_EQ(error_with([](auto& o) { o.action_gap = -1; }), "action_gap: -1, expected a number >= 0");
  EXPECT_EQ(error_with([](auto& o) { o.reward_span = -1; }), "reward_span: -1, expected a finite number >= 0");
}

RC_GTEST_PROP(RandomPoints, KeepTheirSpacingAndTheirBox, ()) {
  const State n = *rc::gen::inRange(1, 40);
  const int dimension = *rc::gen::inRange(1, 5);
  const double side = *rc::gen::element(0.5, 1.0, 30.0);
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto layout = *rc::gen::element(PointLayout::uniform, PointLayout::lattice, PointLayout::line);
  const auto points = random_points(layout, n, dimension, side, rng);
  RC_ASSERT(points.rows() == n && points.cols() == dimension);
  RC_ASSERT(points.minCoeff() >= 0 && points.maxCoeff() <= side * (1 + 1e-12));
  const auto distances = pairwise_distances(Metric<double>::from_points(points, Norm::linf));
  const double spacing = layout == PointLayout::line ? side / n : uniform_spacing(n, dimension, side);
  if (n > 1) RC_ASSERT(distances.least >= spacing);
}

RC_GTEST_PROP(GroupedPoints, HaveCompanyAndSpreadWide, ()) {
  const State n = *rc::gen::inRange(5, 40);
  const int dimension = *rc::gen::inRange(1, 4);
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto points = grouped_points(n, dimension, 20, 1, rng);
  const auto distances = pairwise_distances(Metric<double>::from_points(points, Norm::linf));
  RC_ASSERT(distances.diameter >= 20);
  State alone = 0;
  for (State s = 0; s < n; ++s) alone += (distances.table.row(s).array() <= 1).count() < 2;
  RC_ASSERT(alone <= 1);  // only the last group may be left with one member
}

}  // namespace
}  // namespace maximin
