#include <maximin/proofs_check/certificate/exact_claims.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <maximin/theory/bounds.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

/// s -> max_a q(s,a).
ScaledValues greedy(const ScaledTable& q) {
  Policy best;
  greedy_policy(q.numerators, best);
  return taken(q, best);
}

/// The same place, against another bound.
Instance against(Instance instance, Rational right, bool decisive = true) {
  instance.right = std::move(right);
  instance.decisive = decisive;
  return instance;
}

}  // namespace

ExactClaims::ExactClaims(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const ExactGeometry& geometry,
                         const ModelConstants<Rational>& c, const CertifiedSolution<Rational>& optimal,
                         const CertifyOptions& options)
    : options_(options),
      scaled_(scaled),
      gamma_(mdp.discount()),
      eps_(geometry.eps),
      exact_(geometry.exact),
      v_(optimal.v),
      optimal_(backup(optimal.v)),
      start_(std::max(Rational(0), optimal.q.maxCoeff()) - std::min(Rational(0), optimal.q.minCoeff())) {
  const Rational read = options.reading == Reading::paper ? std::max(Rational(0), c.r_max_signed) : c.r_max;
  const auto printed = [&](const Rational& r_max) {
    return bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp.states(), r_max);
  };
  const auto delta = [&](const Rational& l) { return bounds::delta(eps_, gamma_, l); };
  delta_printed_ = delta(printed(read));
  delta_sound_ = delta(printed(c.r_max));
  delta_repaired_ = delta(bounds::lipschitz_of_q(gamma_, c.l_r.value, c.l_p.value, mdp.states(), c.r_max));
  delta_tv_ = delta(bounds::lipschitz_of_q_tv(gamma_, c.l_r.value, c.k_tv.value, c.span));
  const LipschitzReach reach = lipschitz_reach(mdp, geometry, c);
  const Rational horizon = Rational(mdp.states()) / (1 - gamma_);
  lemma_1_.emplace(mdp, geometry, reach.rewards + reach.probabilities * Rational(horizon * read));
  lemma_1_iterates_.emplace(mdp, geometry, reach.rewards + reach.probabilities * Rational(horizon * gamma_ * c.r_max));
}

// ---- The rounds ----

void ExactClaims::pair(long n, const CertifiedPair& pair, const Policy& composed) {
  const ScaledTable robust = backup(pair.robust);
  facts_.push_back({scaled_.backup(taken(optimal_, composed)), largest_difference(optimal_, robust, n, 0)});
  if (!options_.wants(ClaimId::lemma_1)) return;
  at(ClaimId::lemma_1).observe(lemma_1_->tightest(backup(pair.fixed), 0, n));
  at(ClaimId::lemma_1).observe(lemma_1_->tightest(robust, 0, n));
}

void ExactClaims::round(long n, const ScaledTable& q, const ScaledTable& next, int pair) {
  const PairFacts& facts = facts_[static_cast<std::size_t>(pair)];
  if (options_.wants(ClaimId::lemma_1_iterates)) {
    at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(q, 0, n));
  }
  if (options_.wants(ClaimId::lemma_2)) lemma_2(n, q, next);
  if (options_.wants(ClaimId::lemma_3)) {
    at(ClaimId::lemma_3).observe({distance(next, facts.backup_of_optimal), gamma_ * distance(q, optimal_), n});
  }
  Instance loss = facts.loss;
  loss.n = n;
  if (options_.wants(ClaimId::c_finite_n)) at(ClaimId::c_finite_n).observe(against(loss, finite_n(n, delta_repaired_)));
  if (options_.wants(ClaimId::d_total_variation)) {
    at(ClaimId::d_total_variation).observe(against(loss, finite_n(n, delta_tv_)));
  }
}

void ExactClaims::lemma_2(long n, const ScaledTable& q, const ScaledTable& next, const Rational& off) {
  Instance instance = largest_difference(scaled_.backup(greedy(q)), next, n, delta_printed_);
  instance.left += 2 * gamma_ * off;
  instance.decisive = off == 0;
  at(ClaimId::lemma_2).observe(std::move(instance));
}

Rational ExactClaims::finite_n(long n, const Rational& delta) const {
  return bounds::finite_n(gamma_, delta, start_, Rational(0), n);
}

// ---- The limit ----

Rational ExactClaims::limit(long from, const ScaledTable& last, const EnteredOrbit& entered,
                            const CertifiedLimit& limit) {
  at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(last, 0, from));
  Rational gap(0);
  for (std::size_t j = 0; j < limit.low.size(); ++j) {
    gap = std::max(gap, phase(from + static_cast<long>(j), j, entered, limit));
  }
  return gap;
}

void ExactClaims::no_limit() {
  for (const ClaimId id :
       {ClaimId::lemma_1, ClaimId::lemma_1_iterates, ClaimId::lemma_2, ClaimId::theorem_1, ClaimId::a_optimal_attacker,
        ClaimId::b_one_sided, ClaimId::c_finite_n, ClaimId::d_total_variation}) {
    at(id).undecided();
  }
}

Rational ExactClaims::phase(long n, std::size_t j, const EnteredOrbit& entered, const CertifiedLimit& limit) {
  const std::vector<ScaledTable>& orbit = entered.orbit.tables;
  at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(orbit[j], 2 * gamma_ * entered.off, n));
  lemma_2(n, orbit[j], orbit[(j + 1) % orbit.size()], entered.off);

  const bool attained = limit.attained[j];
  const ScaledTable low = backup(limit.low[j]);
  std::optional<ScaledTable> fixed;
  if (limit.fixed[j]) fixed = backup(*limit.fixed[j]);
  if (fixed && attained) {
    at(ClaimId::lemma_1).observe(lemma_1_->tightest(*fixed, 0, n));
    at(ClaimId::lemma_1).observe(lemma_1_->tightest(low, 0, n));
  } else {
    at(ClaimId::lemma_1).undecided();
  }
  const Instance loss = largest_difference(optimal_, low, n, 0);
  const Instance gap = fixed ? largest_difference(optimal_, *fixed, n, 0) : loss;
  at(ClaimId::theorem_1).observe(against(gap, bounds::theorem_1(gamma_, delta_printed_), fixed.has_value()));
  const auto observe = [&](ClaimId id, const Rational& right) { at(id).observe(against(loss, right, attained)); };
  observe(ClaimId::a_optimal_attacker, bounds::theorem_1(gamma_, delta_sound_));
  observe(ClaimId::b_one_sided, bounds::theorem_1_one_sided(gamma_, delta_sound_));
  observe(ClaimId::c_finite_n, least_from(n, delta_repaired_));
  observe(ClaimId::d_total_variation, least_from(n, delta_tv_));
  return loss.left;
}

Rational ExactClaims::least_from(long n, const Rational& delta) const {
  return std::min(finite_n(n, delta), bounds::theorem_1_one_sided(gamma_, delta));
}

// ---- E and F ----

void ExactClaims::test_time(const Values<Rational>& robust, const Rational& l_star) {
  const Rational right = bounds::test_time_pessimism(eps_, gamma_, l_star);
  at(ClaimId::e_test_time).observe(largest_difference(optimal_, backup(robust), -1, right));
}

void ExactClaims::beliefs(const CertifiedBeliefGame& game, const Values<Rational>& start, const Rational& l_star) {
  const Rational right = bounds::belief(game.reach, gamma_, l_star);
  for (State s = 0; s < start.size(); ++s) {
    at(ClaimId::f_belief).observe({Rational(v_[s] - start[s]), right, -1, {s}, -1, game.exact});
  }
}

std::vector<CertifiedClaim> ExactClaims::verdicts() const {
  std::vector<CertifiedClaim> result;
  for (const Claim& c : claims()) {
    if (!options_.wants(c.id)) continue;
    result.push_back(tightest_[static_cast<std::size_t>(c.id)].verdict(c.id, exact_));
  }
  return result;
}

}  // namespace maximin
