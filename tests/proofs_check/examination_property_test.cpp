#include <maximin/proofs_check/examination.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/proofs_check/trial_record.hpp>

#include "../tabular/random_tables.hpp"
#include "independent.hpp"

namespace maximin {
namespace {

using independent::Gaps;
using independent::Subject;

RC_GTEST_PROP(Examination, FindsNoClaimViolated, (const Model<double>& model)) {
  const auto balls = make_perturbation(model);
  for (const TieBreak tie : both_ties) {
    const auto found = examine(model.mdp, balls, {.tie = tie});
    const Verdict expected = found.constants.finite() ? Verdict::holds : Verdict::assumption_fails;
    const bool fate_known = found.fate != Fate::undetermined;
    for (const Claim& c : claims()) {
      const bool of_limit =
          c.id == ClaimId::theorem_1 || c.id == ClaimId::a_optimal_attacker || c.id == ClaimId::b_one_sided;
      const Verdict verdict = found.check(c.id).verdict;
      if (of_limit && !fate_known && found.constants.finite()) {
        RC_ASSERT(verdict == Verdict::undetermined);
      } else if (c.id == ClaimId::f_belief && verdict == Verdict::undetermined) {
        RC_ASSERT(found.belief_positions == 0);
      } else {
        RC_ASSERT(verdict == expected);
        RC_ASSERT(expected != Verdict::holds || found.check(c.id).instances > 0);
      }
    }
    RC_TAG(to_string(found.fate));
  }
}

/// |x - y| within the accuracy that both sides are computed to.
bool same(const Subject& subject, double x, double y) {
  return std::abs(x - y) <= subject.slack + 1e-9 * std::abs(y);
}

bool same(const Subject& subject, const Check& check, double left, double right) {
  return same(subject, check.left, left) && same(subject, check.right, right);
}

/// Left and right of Theorem 1, A, B, C and E, worked out without `examine`.
RC_GTEST_PROP(Examination, AgreesWithAnIndependentCalculation, (const Model<double>& model)) {
  const auto balls = make_perturbation(model);
  const Subject subject{model.mdp, balls};
  if (!subject.c.finite()) return;
  const TieBreak tie = *rc::gen::element(TieBreak::lowest_index, TieBreak::highest_index);
  const auto found = examine(model.mdp, balls, {.tie = tie});
  if (found.fate == Fate::undetermined) return;

  Gaps gaps(subject);
  double pair = 0, robust = 0, tightest_c = 0;
  const Check& c = found.check(ClaimId::c_finite_n);
  bool c_agrees = false;
  independent::play(subject, found.iterations, tie,
                    [&](long n, const auto&, const PessimisticStep<double>& step, const auto&) {
                      const double gap = gaps.robust(step.policy), right = subject.finite_n(subject.l_repaired(), n);
                      if (n == c.n) c_agrees = same(subject, c, gap, right);
                      if (gap > subject.slack) tightest_c = std::max(tightest_c, (gap - subject.slack) / right);
                      if (n < found.iterations - found.period) return;
                      pair = std::max(pair, gaps.pair(step.composed));
                      robust = std::max(robust, gap);
                    });
  RC_ASSERT(c_agrees);
  RC_ASSERT(c.instances == found.iterations);
  RC_ASSERT(tightest_c <= c.tightness() + 1e-6);  // no round was tighter than the one that is reported
  RC_ASSERT(same(subject, found.check(ClaimId::theorem_1), pair, subject.theorem_1()));
  RC_ASSERT(same(subject, found.check(ClaimId::a_optimal_attacker), robust, subject.theorem_1()));
  RC_ASSERT(same(subject, found.check(ClaimId::b_one_sided), robust, subject.one_sided()));
  RC_ASSERT(same(subject, found.gap, robust));

  const double l_star = independent::lipschitz(subject.q_star, balls.metric());
  Policy policy;
  std::vector<double> scratch;
  maximin_policy(QTable<double>(subject.q_star.cast<double>()), balls, policy, scratch, MinAggregator{}, tie);
  const double bound_e = 2 * subject.eps * subject.g * l_star / (1 - subject.g);
  RC_ASSERT(same(subject, found.check(ClaimId::e_test_time).right, bound_e));
  RC_ASSERT(same(subject, found.lipschitz_of_q_star, l_star));
  RC_ASSERT(same(subject, found.trivial, subject.g * subject.c.span / (1 - subject.g)));
  RC_ASSERT(found.informative(ClaimId::e_test_time) == (found.check(ClaimId::e_test_time).right < found.trivial));
  // Near-ties of Q* may be broken differently by a Q* that is off by rounding; then E is about another policy.
  const bool clear_cut = [&] {
    for (State t = 0; t < model.mdp.states(); ++t) {
      std::vector<reference::Real> worst;
      for (Action a = 0; a < model.mdp.actions(); ++a) {
        reference::Real least = INFINITY;
        for (const State m : balls.ball(t)) least = std::min(least, subject.q_star(m, a));
        worst.push_back(least);
      }
      std::sort(worst.rbegin(), worst.rend());
      if (worst.size() > 1 && worst[0] - worst[1] < reference::Real(subject.slack)) return false;
    }
    return true;
  }();
  RC_TAG(clear_cut ? "E compared" : "E: near-tie");
  if (clear_cut) RC_ASSERT(same(subject, found.check(ClaimId::e_test_time).left, gaps.robust(policy)));
}

}  // namespace
}  // namespace maximin
