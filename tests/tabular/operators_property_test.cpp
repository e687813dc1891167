// What the proofs use of the Bellman operators, on random models and tables. Monotonicity and the identities are exact
// in floating point: each step of a backup rounds monotonically, and both sides make the same steps.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/theory/bellman.hpp>
#include <maximin/theory/lipschitz.hpp>

#include "random_tables.hpp"

namespace maximin {
namespace {

QTable<double> t_star(const FiniteMdp<double>& mdp, const QTable<double>& q) {
  Values<double> v;
  QTable<double> out;
  bellman_optimality(mdp, q, v, out);
  return out;
}

QTable<double> t_pair(const FiniteMdp<double>& mdp, const Policy& composed, const QTable<double>& q) {
  Values<double> v;
  QTable<double> out;
  bellman_pair(mdp, composed, q, v, out);
  return out;
}

QTable<double> t_robust(const FiniteMdp<double>& mdp, const Policy& policy, const Perturbation<double>& balls,
                        const QTable<double>& q) {
  Values<double> v;
  QTable<double> out;
  bellman_robust(mdp, policy, balls, q, v, out);
  return out;
}

QTable<double> pessimistic(const FiniteMdp<double>& mdp, const Perturbation<double>& balls, const QTable<double>& q,
                           PessimisticStep<double>& step, TieBreak tie) {
  QTable<double> out;
  pessimistic_update(mdp, balls, q, step, out, tie);
  return out;
}

bool below(const QTable<double>& x, const QTable<double>& y) {
  return (x.array() <= y.array()).all();
}

double distance(const QTable<double>& x, const QTable<double>& y) {
  return (x - y).cwiseAbs().maxCoeff();
}

/// What a few roundings of numbers of the size of the table and the rewards come to.
double rounding(const FiniteMdp<double>& mdp, const QTable<double>& q) {
  return 1e-14 * (1 + q.cwiseAbs().maxCoeff() + mdp.rewards().cwiseAbs().maxCoeff());
}

RC_GTEST_PROP(BellmanOperators, AreMonotone, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto low = random_table(model.mdp, rng);
  const QTable<double> high = low + random_table(model.mdp, rng).cwiseAbs();
  const auto policy = random_policy(model.mdp, rng);
  RC_ASSERT(below(t_star(model.mdp, low), t_star(model.mdp, high)));
  RC_ASSERT(below(t_pair(model.mdp, policy, low), t_pair(model.mdp, policy, high)));
  RC_ASSERT(below(t_robust(model.mdp, policy, balls, low), t_robust(model.mdp, policy, balls, high)));
}

RC_GTEST_PROP(BellmanOperators, DiscountAConstant, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto q = random_table(model.mdp, rng);
  const double c = rng.uniform(-5, 5);
  const QTable<double> shifted = q.array() + c;
  const auto policy = random_policy(model.mdp, rng);
  const auto by = [&](const QTable<double>& before, const QTable<double>& after) {
    const QTable<double> expected = before.array() + model.mdp.discount() * c;
    return distance(after, expected) <= rounding(model.mdp, shifted);
  };
  RC_ASSERT(by(t_star(model.mdp, q), t_star(model.mdp, shifted)));
  RC_ASSERT(by(t_pair(model.mdp, policy, q), t_pair(model.mdp, policy, shifted)));
  RC_ASSERT(by(t_robust(model.mdp, policy, balls, q), t_robust(model.mdp, policy, balls, shifted)));
}

/// Lemma 3, for every fixed pair, and for T* and T^{pi}_rob.
RC_GTEST_PROP(BellmanOperators, AreContractions, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto x = random_table(model.mdp, rng), y = random_table(model.mdp, rng);
  const auto policy = random_policy(model.mdp, rng);
  Policy composed;
  compose(policy, random_attack(balls, rng), composed);
  const double bound = model.mdp.discount() * distance(x, y) + rounding(model.mdp, x) + rounding(model.mdp, y);
  RC_ASSERT(distance(t_star(model.mdp, x), t_star(model.mdp, y)) <= bound);
  RC_ASSERT(distance(t_pair(model.mdp, composed, x), t_pair(model.mdp, composed, y)) <= bound);
  RC_ASSERT(distance(t_robust(model.mdp, policy, balls, x), t_robust(model.mdp, policy, balls, y)) <= bound);
}

/// The optimal attacker's operator is the least of all pairs' and is attained by the best response.
RC_GTEST_PROP(BellmanOperators, RobustIsTheLeastOverAllAttacks, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto q = random_table(model.mdp, rng);
  const auto policy = random_policy(model.mdp, rng);
  const auto least = t_robust(model.mdp, policy, balls, q);
  Policy composed;
  for (int k = 0; k < 5; ++k) {
    compose(policy, random_attack(balls, rng), composed);
    RC_ASSERT(below(least, t_pair(model.mdp, composed, q)));
  }
  for (const TieBreak tie : both_ties) {
    AttackPolicy attack;
    best_response_attack(q, policy, balls, attack, tie);
    compose(policy, attack, composed);
    RC_ASSERT(t_pair(model.mdp, composed, q) == least);
  }
}

/// Strengthening A rests on it: om_n is the exact minimiser, so Q_{n+1} is T^{pi_n}_rob Q_n.
RC_GTEST_PROP(PessimisticUpdate, IsTheRobustOperatorOfItsOwnPolicy, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto q = random_table(model.mdp, rng);
  for (const TieBreak tie : both_ties) {
    PessimisticStep<double> step;
    const auto next = pessimistic(model.mdp, balls, q, step, tie);
    RC_ASSERT(next == t_robust(model.mdp, step.policy, balls, q));
    RC_ASSERT(next == t_pair(model.mdp, step.composed, q));
  }
}

/// Strengthening B rests on it: Q_{n+1} <= T*Q_n.
RC_GTEST_PROP(PessimisticUpdate, IsBelowTheOptimalityOperator, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto q = random_table(model.mdp, rng);
  for (const TieBreak tie : both_ties) {
    PessimisticStep<double> step;
    RC_ASSERT(below(pessimistic(model.mdp, balls, q, step, tie), t_star(model.mdp, q)));
  }
}

RC_GTEST_PROP(PessimisticUpdate, WithoutConfusionIsTheOptimalityOperator,
              (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const Perturbation<double> alone(Metric<double>::discrete(model.mdp.states()), 0);
  const auto q = random_table(model.mdp, rng);
  for (const TieBreak tie : both_ties) {
    PessimisticStep<double> step;
    RC_ASSERT(pessimistic(model.mdp, alone, q, step, tie) == t_star(model.mdp, q));
  }
}

/// Lemma 2 for any table at all, with the table's own Lipschitz constant: T*Q - Q_{n+1} <= 2 eps gamma L.
RC_GTEST_PROP(PessimisticUpdate, LosesAtMostDeltaOfTheTable, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto q = random_table(model.mdp, rng);
  const auto l = lipschitz_constant(q, balls.metric());
  if (l.infinite) return;
  const double delta = 2 * balls.radius() * model.mdp.discount() * l.value;
  for (const TieBreak tie : both_ties) {
    PessimisticStep<double> step;
    const double lost = distance(t_star(model.mdp, q), pessimistic(model.mdp, balls, q, step, tie));
    RC_ASSERT(lost <= delta + rounding(model.mdp, q));
  }
}

}  // namespace
}  // namespace maximin
