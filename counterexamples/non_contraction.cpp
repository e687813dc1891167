#include <maximin/counterexamples/non_contraction.hpp>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <vector>

namespace maximin::non_contraction {
namespace {

using Whole = std::int64_t;

/// Q(s, pi_Q(omega_Q(s))) for every s.
Values<Whole> attacked_values_of(const QTable<Whole>& q, const Perturbation<Whole>& perturbation, TieBreak tie) {
  Policy policy, composed;
  AttackPolicy attack;
  std::vector<Whole> scratch;
  maximin_policy(q, perturbation, policy, scratch, MinAggregator{}, tie);
  best_response_attack(q, policy, perturbation, attack, tie);
  compose(policy, attack, composed);
  Values<Whole> values;
  policy_values(q, composed, values);
  return values;
}

Side examine_side(QTable<double> q, const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                  TieBreak tie) {
  Side side;
  side.q = std::move(q);
  pessimistic_update(mdp, perturbation, side.q, side.step, side.backup, tie);
  return side;
}

}  // namespace

Examination examine(double gamma, TieBreak tie) {
  const auto mdp = model(gamma);
  const auto perturbation = balls<double>();
  Examination e{examine_side(q1<double>(), mdp, perturbation, tie), examine_side(q2<double>(), mdp, perturbation, tie),
                0, 0};
  e.distance_before = (e.first.q - e.second.q).cwiseAbs().maxCoeff();
  e.distance_after = (e.first.backup - e.second.backup).cwiseAbs().maxCoeff();
  return e;
}

ExactDistances exact_distances(TieBreak tie) {
  // Rewards cancel, so |T Q1 - T Q2| = gamma max_{s,a} |P(.|s,a) (V1 - V2)|; the transitions are whole numbers too.
  const auto mdp = model<Whole>(0);
  const auto perturbation = balls<Whole>();
  const QTable<Whole> first = q1<Whole>(), second = q2<Whole>();
  const Values<Whole> gap =
      attacked_values_of(first, perturbation, tie) - attacked_values_of(second, perturbation, tie);
  ExactDistances exact;
  exact.before = (first - second).cwiseAbs().maxCoeff();
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      exact.after_per_gamma = std::max(exact.after_per_gamma, std::abs(mdp.expectation(s, a, gap)));
    }
  }
  return exact;
}

}  // namespace maximin::non_contraction
