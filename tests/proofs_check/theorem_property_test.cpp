// Every lemma and theorem on random models, both sides worked out by independent.hpp: a fault of `examine` or of the
// bounds cannot hide here.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_game.hpp>

#include "../tabular/random_tables.hpp"
#include "independent.hpp"

namespace maximin {
namespace {

using independent::Gaps;
using independent::Subject;

TieBreak any_tie() {
  return *rc::gen::element(TieBreak::lowest_index, TieBreak::highest_index);
}

/// Calls body(subject, tie), unless twins at distance 0 differ, so that the claims assume what the model has not.
template <class Body>
void on_subject(const Model<double>& model, Body body) {
  const auto balls = make_perturbation(model);
  const Subject subject{model.mdp, balls};
  const TieBreak tie = any_tie();
  if (subject.c.finite()) body(subject, tie);
}

/// gap(step) <= bound(n) in every round until nothing new can come.
template <class Gap, class Bound>
bool at_every_round(const Subject& subject, TieBreak tie, Gap gap, Bound bound) {
  bool holds = true;
  independent::play(subject, independent::rounds_until_settled(subject.g), tie,
                    [&](long n, const auto&, const PessimisticStep<double>& step, const auto&) {
                      holds = holds && gap(step) <= bound(n) * (1 + 1e-12) + subject.slack;
                    });
  return holds;
}

RC_GTEST_PROP(Lemma1, QOfEveryPairIsLipschitz, (const Model<double>& model, std::uint64_t seed)) {
  on_subject(model, [&](const Subject& subject, TieBreak) {
    Stream rng(seed);
    Policy composed;
    compose(random_policy(model.mdp, rng), random_attack(subject.balls, rng), composed);
    const auto q = reference::of_pair(model.mdp, composed);
    const double l = independent::lipschitz(q, subject.balls.metric());
    RC_ASSERT(l <= subject.l_repaired() * (1 + 1e-12) + subject.slack);
    RC_ASSERT(l <= subject.l_tv() * (1 + 1e-12) + subject.slack);  // strengthening D
    RC_ASSERT(subject.l_tv() <= subject.l_repaired() * (1 + 1e-12));
  });
}

/// What the proof of Lemma 2 uses, and the paper does not prove.
RC_GTEST_PROP(Lemma1, EveryIterateIsLipschitz, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    independent::play(subject, 60, tie, [&](long, const QTable<double>& q, const auto&, const auto&) {
      const double l = independent::lipschitz(q, subject.balls.metric());
      RC_ASSERT(l <= subject.l_repaired() * (1 + 1e-12) + subject.slack);
      RC_ASSERT(l <= subject.l_tv() * (1 + 1e-12) + subject.slack);
    });
  });
}

RC_GTEST_PROP(Lemma2, OneBackupLosesAtMostDelta, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Values<double> v;
    QTable<double> best;
    independent::play(subject, 60, tie, [&](long, const QTable<double>& q, const auto&, const QTable<double>& next) {
      bellman_optimality(model.mdp, q, v, best);
      const double lost = (best - next).cwiseAbs().maxCoeff();
      RC_ASSERT(lost <= subject.delta(subject.l_repaired()) * (1 + 1e-12) + subject.slack);
      RC_ASSERT(lost <= subject.delta(subject.l_tv()) * (1 + 1e-12) + subject.slack);
    });
  });
}

/// A pair's Q is the fixed point of its contraction, so every round halves the way to it, or better: gamma it.
RC_GTEST_PROP(Lemma3, ApproachesTheFixedPointOfThePair, (const Model<double>& model, std::uint64_t seed)) {
  on_subject(model, [&](const Subject& subject, TieBreak) {
    Stream rng(seed);
    Policy composed;
    compose(random_policy(model.mdp, rng), random_attack(subject.balls, rng), composed);
    const QTable<double> fixed = reference::of_pair(model.mdp, composed).cast<double>();
    QTable<double> q = random_table(model.mdp, rng), next;
    Values<double> v;
    for (int n = 0; n < 20; ++n) {
      bellman_pair(model.mdp, composed, q, v, next);
      RC_ASSERT((next - fixed).cwiseAbs().maxCoeff() <= subject.g * (q - fixed).cwiseAbs().maxCoeff() + subject.slack);
      q.swap(next);
    }
  });
}

/// The limit superior over rounds, as a bound on each of them with what is left of the transient.
RC_GTEST_PROP(Theorem1, BoundsTheGapOfEveryPairInTheLimit, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Gaps gaps(subject);
    RC_ASSERT(at_every_round(
        subject, tie, [&](const auto& step) { return gaps.pair(step.composed); },
        [&](long n) { return subject.theorem_1() + subject.transient(n); }));
  });
}

RC_GTEST_PROP(StrengtheningA, Theorem1HoldsAgainstTheOptimalAttacker, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Gaps gaps(subject);
    RC_ASSERT(at_every_round(
        subject, tie, [&](const auto& step) { return gaps.robust(step.policy); },
        [&](long n) { return subject.theorem_1() + subject.transient(n); }));
  });
}

RC_GTEST_PROP(StrengtheningB, OneFactorLess, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Gaps gaps(subject);
    RC_ASSERT(at_every_round(
        subject, tie, [&](const auto& step) { return gaps.robust(step.policy); },
        [&](long n) { return subject.one_sided() + subject.transient(n); }));
  });
}

RC_GTEST_PROP(StrengtheningC, HoldsInEveryRound, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Gaps gaps(subject);
    RC_ASSERT(at_every_round(
        subject, tie, [&](const auto& step) { return gaps.robust(step.policy); },
        [&](long n) { return subject.finite_n(subject.l_repaired(), n); }));
  });
}

RC_GTEST_PROP(StrengtheningD, HoldsInEveryRound, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Gaps gaps(subject);
    RC_ASSERT(at_every_round(
        subject, tie, [&](const auto& step) { return gaps.robust(step.policy); },
        [&](long n) { return subject.finite_n(subject.l_tv(), n); }));
  });
}

RC_GTEST_PROP(StrengtheningE, PessimismAtTestTime, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    Policy policy;
    std::vector<double> scratch;
    maximin_policy(QTable<double>(subject.q_star.cast<double>()), subject.balls, policy, scratch, MinAggregator{}, tie);
    const double l_star = independent::lipschitz(subject.q_star, subject.balls.metric());
    const double bound = 2 * subject.eps * subject.g * l_star / (1 - subject.g);
    RC_ASSERT(Gaps(subject).robust(policy) <= bound * (1 + 1e-12) + subject.slack);
  });
}

RC_GTEST_PROP(StrengtheningF, MaximinOverTheBelief, (const Model<double>& model)) {
  on_subject(model, [&](const Subject& subject, TieBreak tie) {
    const QTable<double> q = subject.q_star.cast<double>();
    const auto game = solve_belief_game(model.mdp, subject.balls, maximin_belief_policy(q, tie));
    RC_ASSERT(game.reach <= 2 * subject.eps * (1 + 1e-12));
    const double l_star = independent::lipschitz(subject.q_star, subject.balls.metric());
    const Values<double> v_star = q.rowwise().maxCoeff();
    RC_ASSERT((v_star - game.v).maxCoeff() <= game.reach * l_star / (1 - subject.g) * (1 + 1e-12) + subject.slack);
  });
}

}  // namespace
}  // namespace maximin
