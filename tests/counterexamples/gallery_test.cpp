#include <gtest/gtest.h>

#include <functional>
#include <optional>
#include <set>
#include <sstream>
#include <utility>

#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

Counterexample::Finding run(std::string_view name) {
  const Counterexample& c = find_counterexample(name);
  return c.check(c.model());
}

Counterexample::Finding run(std::string_view name, const Model<Rational>& changed) {
  return find_counterexample(name).check(changed);
}

/// The model with one reward, or the discount, changed.
Model<Rational> changed(std::string_view name, const std::function<Rational(State, Action, Rational)>& reward,
                        std::optional<Rational> discount = {}) {
  Model<Rational> model = find_counterexample(name).model();
  const FiniteMdp<Rational>& mdp = model.mdp;
  FiniteMdpBuilder<Rational> b(mdp.states(), mdp.actions(), discount.value_or(mdp.discount()));
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      b.reward(s, a, reward(s, a, mdp.reward(s, a)));
      for (const auto& next : mdp.successors(s, a)) b.transition(s, a, next.target, next.probability);
    }
  }
  model.mdp = std::move(b).build();
  return model;
}

Rational same(State, Action, Rational r) {
  return r;
}

/// The model where every state is seen as it is.
Model<Rational> in_full_sight(std::string_view name) {
  Model<Rational> model = find_counterexample(name).model();
  model.geometry.eps = Rational(0);
  return model;
}

TEST(Gallery, HasEightWithDifferentNamesThatAreAllRefuted) {
  std::set<std::string_view> names;
  for (const Counterexample& c : counterexamples()) {
    names.insert(c.name);
    EXPECT_TRUE(c.check(c.model()).refuted) << c.name;
    EXPECT_EQ(c.model().name, c.name);
    EXPECT_FALSE(c.claim.empty() || c.title.empty() || c.explanation.empty()) << c.name;
    EXPECT_EQ(c.claim.find('\n'), std::string_view::npos) << c.name;
  }
  EXPECT_EQ(names.size(), 8u);
  EXPECT_THROW(find_counterexample("nothing"), InputError);
}

TEST(Gallery, ModelsSurviveTheirFiles) {
  for (const Counterexample& c : counterexamples()) {
    const Model<Rational> model = c.model();
    std::ostringstream text;
    write_maximin_json(model, text);
    const Model<Rational> again = read_maximin_json<Rational>(text.str(), "m.json");
    EXPECT_TRUE(again.mdp == model.mdp) << c.name;
    const auto before = c.check(model), after = c.check(again);
    EXPECT_EQ(before.found.value, after.found.value) << c.name;
    EXPECT_EQ(before.promised.value, after.promised.value) << c.name;
  }
}

TEST(Contraction, TenApartBecomesMore) {
  const auto finding = run("contraction");
  EXPECT_EQ(finding.promised.value, 10);
  EXPECT_EQ(finding.found.value, Rational(209, 20));
}

TEST(Contraction, NotAtTheThreshold) {
  EXPECT_FALSE(run("contraction", changed("contraction", same, Rational(10, 11))).refuted);
  EXPECT_TRUE(run("contraction", changed("contraction", same, Rational(10, 11) + Rational(1, 1'000'000))).refuted);
  EXPECT_FALSE(run("contraction", changed("contraction", same, Rational(0))).refuted);
  EXPECT_FALSE(run("contraction", in_full_sight("contraction")).refuted);
  EXPECT_THROW(run("contraction", find_counterexample("settling").model()), InputError);
}

TEST(Settling, PeriodThree) {
  const auto finding = run("settling");
  EXPECT_EQ(finding.promised.value, 1);
  EXPECT_EQ(finding.found.value, 3);
}

TEST(Settling, SettlesInFullSight) {
  const auto finding = run("settling", in_full_sight("settling"));
  EXPECT_FALSE(finding.refuted);
  EXPECT_EQ(finding.found.value, 1);
}

TEST(OneSidedRewards, TenAboveSix) {
  const auto finding = run("one-sided-rewards");
  EXPECT_EQ(finding.promised.value, 6);
  EXPECT_EQ(finding.found.value, 10);
}

TEST(OneSidedRewards, RewardsAboveZeroAreNoneOfIt) {
  const auto up = changed("one-sided-rewards", [](State, Action, Rational r) { return Rational(r + 20); });
  EXPECT_FALSE(run("one-sided-rewards", up).refuted);
}

TEST(StationaryOptimum, NoPolicyHasBothValues) {
  const auto finding = run("stationary-optimum");
  EXPECT_EQ(finding.promised.value, 2);
  EXPECT_EQ(finding.found.value, 0);
}

TEST(StationaryOptimum, ControlsThatHaveOne) {
  EXPECT_FALSE(run("stationary-optimum", in_full_sight("stationary-optimum")).refuted);
  const auto harmless = changed("stationary-optimum", [](State, Action, Rational r) { return Rational(abs(r)); });
  EXPECT_FALSE(run("stationary-optimum", harmless).refuted);
}

TEST(StationaryOptimum, WithoutTheArgumentNothingIsSaidOfPoliciesAtRandom) {
  // Acting in the bad state now leads to the good one: what one does changes where one goes.
  Model<Rational> model = find_counterexample("stationary-optimum").model();
  FiniteMdpBuilder<Rational> b(2, 2, Rational(1, 4));
  b.reward(0, 1, 1).reward(1, 1, -9);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 1, 1).transition(1, 1, 0, 1);
  model.mdp = std::move(b).build();
  EXPECT_TRUE(find_counterexample("stationary-optimum").searched(model));
  EXPECT_FALSE(run("stationary-optimum", model).refuted);
}

TEST(MyopicAttack, LeavesTwentyMore) {
  const auto finding = run("myopic-attack");
  EXPECT_EQ(finding.promised.value, 10);
  EXPECT_EQ(finding.found.value, -10);
}

TEST(MyopicAttack, IsOptimalWhereThereIsNoChoiceOrThePairSettles) {
  EXPECT_FALSE(run("myopic-attack", in_full_sight("myopic-attack")).refuted);
  // Cycles, but both states look alike, so that pi_n is constant and attacks do not matter.
  EXPECT_FALSE(run("myopic-attack", find_counterexample("settling").model()).refuted);
  EXPECT_FALSE(run("myopic-attack", find_counterexample("one-sided-rewards").model()).refuted);
}

TEST(SharperBelief, LosesASixth) {
  const auto finding = run("sharper-belief");
  EXPECT_EQ(finding.promised.value, 0);
  EXPECT_EQ(finding.found.value, Rational(-1, 6));
}

TEST(SharperBelief, ControlsThatDoNotLose) {
  EXPECT_FALSE(run("sharper-belief", in_full_sight("sharper-belief")).refuted);
  const auto free_reset =
      changed("sharper-belief", [](State s, Action a, Rational r) { return s == 1 && a == 0 ? Rational(0) : r; });
  EXPECT_FALSE(run("sharper-belief", free_reset).refuted) << "resetting when high costs nothing";
}

TEST(BpDqnTarget, ValuesStayingForEver) {
  const auto finding = run("bp-dqn-target");
  EXPECT_EQ(finding.promised.value, 3);
  EXPECT_EQ(finding.found.value, 1);
}

TEST(BpDqnTarget, IsRightWhereNothingMoves) {
  Model<Rational> model = find_counterexample("bp-dqn-target").model();
  model.mdp = find_counterexample("stationary-optimum").model().mdp;
  EXPECT_FALSE(run("bp-dqn-target", model).refuted);
  EXPECT_FALSE(run("bp-dqn-target", changed("bp-dqn-target", same, Rational(0))).refuted);
}

TEST(MaximinDeadlock, NeverArrives) {
  const auto finding = run("maximin-deadlock");
  EXPECT_EQ(finding.promised.value, 8);
  EXPECT_EQ(finding.found.value, 0);
}

TEST(MaximinDeadlock, ControlsThatArriveOrDoNotDiffer) {
  EXPECT_FALSE(run("maximin-deadlock", in_full_sight("maximin-deadlock")).refuted);
  const auto entering_far_pays = [](int pays) {
    return changed("maximin-deadlock",
                   [pays](State s, Action a, Rational r) { return s == 0 && a == 1 ? Rational(pays) : r; });
  };
  EXPECT_TRUE(run("maximin-deadlock", entering_far_pays(-4)).refuted);
  EXPECT_FALSE(run("maximin-deadlock", entering_far_pays(-5)).refuted) << "from far the mean pays for arriving";
  EXPECT_FALSE(run("maximin-deadlock", entering_far_pays(-1)).refuted) << "maximin enters";
  EXPECT_FALSE(run("maximin-deadlock", entering_far_pays(-7)).refuted) << "the mean does not enter either";
  EXPECT_THROW(run("maximin-deadlock", find_counterexample("sharper-belief").model()), InputError);
}

}  // namespace
}  // namespace maximin
