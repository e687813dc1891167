#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <string>

#include <maximin/models/model_family.hpp>
#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/rescale.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

Metric<double> metric_of(const Model<double>& model) {
  return Metric<double>::from_points(model.geometry.points, model.geometry.norm);
}

/// Theorem 1 as printed, with the R_max that is handed in.
double printed_bound(const Model<double>& model, const Perturbation<double>& balls, const ModelConstants<double>& c,
                     double r_max) {
  const double gamma = model.mdp.discount();
  const double l = bounds::lipschitz_of_q_printed(gamma, c.l_r.value, c.l_p.value, model.mdp.states(), r_max);
  return bounds::theorem_1(gamma, bounds::delta(balls.radius(), gamma, l));
}

/// max |Q* - Q^{pi o omega}| over the policy pairs that recur.
double paper_gap(const Model<double>& model, const PessimisticQIteration<double>& run) {
  const QTable<double> optimal = value_iteration(model.mdp).q;
  double gap = 0;
  for (long n = run.periodic_from; n < run.periodic_from + run.period; ++n) {
    const PolicyPair& pair = run.pairs[static_cast<std::size_t>(run.pair_of[static_cast<std::size_t>(n)])];
    Policy composed;
    compose(pair.policy, pair.attack, composed);
    QTable<double> q = QTable<double>::Zero(model.mdp.states(), model.mdp.actions()), next;
    Values<double> v;
    for (int sweep = 0; sweep < 500; ++sweep) {
      bellman_pair(model.mdp, composed, q, v, next);
      std::swap(q, next);
    }
    gap = std::max(gap, (optimal - q).cwiseAbs().maxCoeff());
  }
  return gap;
}

/// How often a family brings about what it is for, in `draws` draws.
struct Regimes {
  int informative = 0;        ///< Theorem 1 as printed, with |R| <= R_max, is below span(R)/(1-gamma)
  int crowded = 0;            ///< most balls hold more than one state
  int pessimism_matters = 0;  ///< the maximin policy differs from the greedy one of the same Q
  int gap = 0;                ///< the attack costs something
  int cycles = 0;             ///< the policy pair never settles
  int beats_one_sided = 0;    ///< the gap exceeds Theorem 1 with R_max = max(0, max R)
  int beats_theorem_1 = 0;    ///< the gap exceeds Theorem 1 with R_max = max |R|
};

void observe(Regimes& regimes, const Model<double>& model) {
  const auto& mdp = model.mdp;
  const Perturbation<double> balls(metric_of(model), *model.geometry.eps);
  const auto c = model_constants(mdp, balls.metric());
  const double trivial = bounds::trivial(mdp.discount(), c.span);
  regimes.informative += printed_bound(model, balls, c, c.r_max) < trivial;
  State crowd = 0;
  for (State s = 0; s < mdp.states(); ++s) crowd += balls.ball(s).size() > 1;
  regimes.crowded += 2 * crowd > mdp.states();
  const auto run = pessimistic_q_iteration(mdp, balls);
  Policy greedy, maximin;
  std::vector<double> scratch;
  greedy_policy(run.q, greedy);
  maximin_policy(run.q, balls, maximin, scratch);
  regimes.pessimism_matters += greedy != maximin;
  regimes.cycles += run.fate == Fate::cycles;
  if (run.fate == Fate::undetermined) return;
  const double gap = paper_gap(model, run);
  const double slack = 1e-8 * trivial;
  regimes.gap += gap > slack;
  regimes.beats_one_sided += gap > printed_bound(model, balls, c, std::max(0.0, c.r_max_signed)) + slack;
  regimes.beats_theorem_1 += gap > printed_bound(model, balls, c, c.r_max) + slack;
}

constexpr int draws = 400;

Regimes regimes_of(Family family) {
  Regimes regimes;
  for (int trial = 0; trial < draws; ++trial) {
    Stream rng(20260101, static_cast<std::uint64_t>(trial));
    observe(regimes, draw_family_member(family, {}, rng).model);
  }
  EXPECT_EQ(regimes.beats_theorem_1, 0);
  return regimes;
}

TEST(Family, InformativeIsInformativeAndNotDegenerate) {
  const Regimes r = regimes_of(Family::informative);
  EXPECT_GE(r.informative, draws * 95 / 100);
  EXPECT_GE(r.crowded, draws * 95 / 100);
  EXPECT_GE(r.pessimism_matters, draws * 60 / 100);
  EXPECT_GE(r.gap, draws * 60 / 100);
}

TEST(Family, BroadIsMostlyVacuousAsPrinted) {
  const Regimes r = regimes_of(Family::broad);
  EXPECT_LE(r.informative, draws * 35 / 100);
  EXPECT_GE(r.informative, draws / 100);
  EXPECT_GE(r.gap, draws * 60 / 100);
}

TEST(Family, CyclingCycles) {
  EXPECT_GE(regimes_of(Family::cycling).cycles, draws * 10 / 100);
}

TEST(Family, CostsRefuteTheOneSidedReading) {
  const Regimes r = regimes_of(Family::costs);
  EXPECT_GE(r.beats_one_sided, draws * 5 / 100);
}

TEST(Family, MixedHasEverything) {
  const Regimes r = regimes_of(Family::mixed);
  EXPECT_GE(r.informative, draws / 2);
  EXPECT_GE(r.cycles, draws * 2 / 100);
  EXPECT_GE(r.gap, draws * 60 / 100);
  EXPECT_GE(r.beats_one_sided, 1);
}

TEST(Family, CostsHaveMaximumZero) {
  for (int trial = 0; trial < 1000; ++trial) {
    Stream rng(3, static_cast<std::uint64_t>(trial));
    EXPECT_EQ(draw_family_member(Family::costs, {}, rng).model.mdp.rewards().maxCoeff(), 0);
  }
}

Family any_family() {
  return *rc::gen::elementOf(std::vector<Family>(all_families().begin(), all_families().end()));
}

RC_GTEST_PROP(Family, DrawsValidModelsFromTheStreamAlone, ()) {
  const Family family = any_family();
  const auto seed = *rc::gen::arbitrary<std::uint64_t>();
  Stream one(seed, 1), same(seed, 1);
  const auto member = draw_family_member(family, {}, one);
  const auto again = draw_family_member(family, {}, same);
  RC_ASSERT(member.family == again.family && member.family != Family::mixed);
  RC_ASSERT(family == Family::mixed || member.family == family);
  RC_ASSERT(member.model.mdp == again.model.mdp);
  RC_ASSERT(member.model.geometry.points == again.model.geometry.points);
  RC_ASSERT(member.model.geometry.points.rows() == member.model.mdp.states());
  RC_ASSERT(member.model.geometry.eps && *member.model.geometry.eps > 0);
  RC_TAG(std::string(family_name(member.family)));
}

RC_GTEST_PROP(Family, MeetsWhatWasAskedFor, ()) {
  const Family family = any_family();
  FamilyOptions o;
  const State least = *rc::gen::inRange(2, 6);
  o.states = {least, least + *rc::gen::inRange(0, 5)};
  o.actions = {1, *rc::gen::inRange(1, 4)};
  o.discount = {0.3, 0.3 + *rc::gen::element(0.0, 0.4)};
  o.norm = *rc::gen::element(Norm::l1, Norm::l2, Norm::linf);
  o.dimension = *rc::gen::inRange(1, 4);
  if (*rc::gen::arbitrary<bool>()) o.eps = *rc::gen::element(0.01, 0.3, 2.0);
  if (*rc::gen::arbitrary<bool>()) o.l_r = *rc::gen::element(0.1, 1.0, 20.0);
  if (*rc::gen::arbitrary<bool>()) o.l_p = *rc::gen::element(0.0, 0.01, 0.5, 30.0);
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto model = draw_family_member(family, o, rng).model;
  const auto c = model_constants(model.mdp, metric_of(model));
  RC_ASSERT(model.mdp.states() >= o.states->low && model.mdp.states() <= o.states->high);
  RC_ASSERT(model.mdp.actions() <= o.actions->high);
  RC_ASSERT(model.mdp.discount() >= 0.3 && model.mdp.discount() <= o.discount->high);
  RC_ASSERT(model.geometry.norm == *o.norm && model.geometry.points.cols() == *o.dimension);
  if (o.eps) RC_ASSERT(*model.geometry.eps == *o.eps);
  if (o.l_r) RC_ASSERT(std::abs(c.l_r.value - *o.l_r) <= 1e-9 * *o.l_r);
  if (o.l_p)
    RC_ASSERT(std::abs(c.l_p.value - *o.l_p) <= 1e-9 * *o.l_p + 1e-15 / pairwise_distances(metric_of(model)).least);
}

/// Without eps, a constant of the kernel is a unit of distance: the balls and the bound's worth stay.
TEST(Family, InformativeStaysInformativeWhateverTheUnits) {
  int informative = 0;
  for (int trial = 0; trial < draws; ++trial) {
    Stream rng(5, static_cast<std::uint64_t>(trial));
    FamilyOptions o;
    if (trial % 2 == 0) o.eps = 100;
    if (trial % 2 == 1) o.l_p = 3;
    o.l_r = 7;
    const auto model = draw_family_member(Family::informative, o, rng).model;
    const Perturbation<double> balls(metric_of(model), *model.geometry.eps);
    const auto c = model_constants(model.mdp, balls.metric());
    informative += printed_bound(model, balls, c, c.r_max) < bounds::trivial(model.mdp.discount(), c.span);
  }
  EXPECT_GE(informative, draws * 95 / 100);
}

std::string error_of(const FamilyOptions& o) {
  Stream rng(1);
  try {
    draw_family_member(Family::mixed, o, rng);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST(Family, RejectsOptionsOutOfRange) {
  EXPECT_EQ(error_of({}), "no error");
  EXPECT_EQ(error_of({.states = Range<State>{1, 5}}), "states: 1 to 5, expected a range within 2 to 2000");
  EXPECT_EQ(error_of({.states = Range<State>{5, 4}}), "states: 5 to 4, expected a range within 2 to 2000");
  EXPECT_EQ(error_of({.actions = Range<Action>{0, 4}}), "actions: 0 to 4, expected a range within 1 to 1000");
  EXPECT_EQ(error_of({.discount = Range<double>{0.5, NAN}}).substr(0, 24), "discount: 0.5 to nan, ex");
  EXPECT_EQ(error_of({.dimension = 17}), "dimension: 17, expected 1 to 16");
  EXPECT_EQ(error_of({.successors = 1}), "successors: 1, expected 0 (dense) or at least 2");
  EXPECT_EQ(error_of({.eps = -1}), "eps: -1, expected a finite number >= 0");
  EXPECT_EQ(error_of({.l_r = INFINITY}), "l_r: inf, expected a finite number >= 0");
  EXPECT_EQ(error_of({.l_p = -0.5}), "l_p: -0.5, expected a finite number >= 0");
}

TEST(Family, HasNames) {
  for (const Family family : all_families()) EXPECT_EQ(family_named(family_name(family)), family);
  EXPECT_THROW(
      {
        try {
          family_named("cosy");
        } catch (const InputError& e) {
          EXPECT_STREQ(e.what(),
                       "family: 'cosy' is unknown, expected one of informative, broad, sparse, cycling, costs, mixed");
          throw;
        }
      },
      InputError);
}

RC_GTEST_PROP(Rescale, ScalesConstantsAndNothingElse, ()) {
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto model = draw_family_member(any_family(), {.states = Range<State>{2, 8}}, rng).model;
  const auto before = model_constants(model.mdp, metric_of(model));
  const double factor = *rc::gen::element(0.25, 2.0, 8.0);  // powers of two: no rounding at all
  const auto richer = scale_rewards(model, factor);
  const auto with_rewards = model_constants(richer.mdp, metric_of(richer));
  RC_ASSERT(with_rewards.l_r.value == factor * before.l_r.value);
  RC_ASSERT(with_rewards.l_p.value == before.l_p.value && with_rewards.span == factor * before.span);
  const auto wider = scale_space(model, factor);
  const auto with_space = model_constants(wider.mdp, metric_of(wider));
  RC_ASSERT(with_space.l_r.value == before.l_r.value / factor && with_space.l_p.value == before.l_p.value / factor);
  const Perturbation<double> balls(metric_of(model), *model.geometry.eps);
  const Perturbation<double> same(metric_of(wider), *wider.geometry.eps);
  for (State s = 0; s < model.mdp.states(); ++s) {
    RC_ASSERT(std::equal(balls.ball(s).begin(), balls.ball(s).end(), same.ball(s).begin(), same.ball(s).end()));
  }
  const auto flatter = contract_kernel(model, 0.25);
  const auto with_kernel = model_constants(flatter.mdp, metric_of(flatter));
  const double rounding = 1e-15 / pairwise_distances(metric_of(model)).least;
  RC_ASSERT(std::abs(with_kernel.l_p.value - 0.25 * before.l_p.value) <= rounding);
  RC_ASSERT(std::abs(with_kernel.k_tv.value - 0.25 * before.k_tv.value) <= 10 * rounding);
}

}  // namespace
}  // namespace maximin
