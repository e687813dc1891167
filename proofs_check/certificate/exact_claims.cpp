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

Integer largest(const QTable<Integer>& table) {
  return *std::max_element(table.data(), table.data() + table.size());
}

Integer least(const QTable<Integer>& table) {
  return *std::min_element(table.data(), table.data() + table.size());
}

/// The claims that need to know what all rounds do.
constexpr ClaimId of_rounds[] = {ClaimId::lemma_1,    ClaimId::lemma_1_iterates,   ClaimId::lemma_2,
                                 ClaimId::theorem_1,  ClaimId::a_optimal_attacker, ClaimId::b_one_sided,
                                 ClaimId::c_finite_n, ClaimId::d_total_variation};

/// The same place, against another bound.
Instance against(Instance instance, Rational right, bool decisive = true) {
  instance.right = std::move(right);
  instance.decisive = decisive;
  return instance;
}

}  // namespace

ExactClaims::ExactClaims(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const ExactGeometry& geometry,
                         Terms terms, const CertifyOptions& options)
    : options_(options),
      scaled_(scaled),
      gamma_(mdp.discount()),
      eps_(geometry.eps()),
      bounds_(terms.bounds),
      exact_(geometry.exact() && !terms.bounds),
      v_(std::move(terms.high)),
      optimal_(scaled.backup(v_)) {
  const auto& c = terms.constants;
  const ScaledTable low = scaled.backup(terms.low);
  start_ = std::max(Rational(0), Rational(largest(low.numerators), low.denominator)) -
           std::min(Rational(0), Rational(least(optimal_.numerators), optimal_.denominator));
  for (State s = 0; s < mdp.states(); ++s) misled_.numerators.push_back(geometry.balls().ball(s).size() > 1 ? 1 : 0);
  const Rational read = options.reading == Reading::paper ? std::max(Rational(0), c.r_max_signed) : c.r_max;
  const auto printed = [&](const Rational& r_max) {
    return bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp.states(), r_max);
  };
  const auto delta = [&](const Rational& l) { return bounds::delta(eps_, gamma_, l); };
  delta_printed_ = delta(printed(read));
  delta_sound_ = delta(printed(c.r_max));
  delta_repaired_ = delta(bounds::lipschitz_of_q(gamma_, c.l_r.value, c.l_p.value, mdp.states(), c.r_max));
  delta_tv_ = delta(bounds::lipschitz_of_q_tv(gamma_, c.l_r.value, c.k_tv.value, c.span));
  if (mdp.states() > options.max_pair_states) return;
  const LipschitzReach reach = lipschitz_reach(mdp, geometry, c, !exact_);
  const Rational horizon = Rational(mdp.states()) / (1 - gamma_);
  if (options.wants(ClaimId::lemma_1)) {
    lemma_1_.emplace(mdp, geometry, reach.rewards + reach.probabilities * Rational(horizon * read));
  }
  if (options.wants(ClaimId::lemma_1_iterates)) {
    lemma_1_iterates_.emplace(mdp, geometry,
                              reach.rewards + reach.probabilities * Rational(horizon * gamma_ * c.r_max));
  }
}

// ---- The rounds ----

void ExactClaims::pair(long n, const CertifiedPair& pair, const Policy& composed) {
  const ScaledTable robust = backup(pair.robust);
  facts_.push_back({scaled_.backup(taken(optimal_, composed)), largest_difference(optimal_, robust, n, 0)});
  if (!lemma_1_) return;
  at(ClaimId::lemma_1).observe(lemma_1_->tightest(backup(pair.fixed), 0, n));
  at(ClaimId::lemma_1).observe(lemma_1_->tightest(robust, 0, n));
}

void ExactClaims::round(long n, const ScaledTable& q, const ScaledTable& next, int pair) {
  const PairFacts& facts = facts_[static_cast<std::size_t>(pair)];
  if (lemma_1_iterates_) at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(q, 0, n));
  if (options_.wants(ClaimId::lemma_2)) lemma_2(at(ClaimId::lemma_2), n, q, next);
  if (options_.wants(ClaimId::lemma_3)) {
    at(ClaimId::lemma_3).observe({distance(next, facts.backup_of_optimal), gamma_ * distance(q, optimal_), n});
  }
  finite_n(n, facts.loss);
}

void ExactClaims::finite_n(long n, Instance loss) {
  loss.n = n;
  if (options_.wants(ClaimId::c_finite_n)) at(ClaimId::c_finite_n).observe(against(loss, finite_n(n, delta_repaired_)));
  if (options_.wants(ClaimId::d_total_variation)) {
    at(ClaimId::d_total_variation).observe(against(loss, finite_n(n, delta_tv_)));
  }
}

void ExactClaims::lemma_2(Tightest& claim, long n, const ScaledTable& q, const ScaledTable& next, const Rational& off) {
  const ScaledTable lost = difference(scaled_.backup(greedy(q)), next);
  if (off == 0) return claim.observe(largest_entry(lost, n, delta_printed_));
  const ScaledTable reach = expected(misled_);
  for (State s = 0; s < scaled_.states(); ++s) {
    for (Action a = 0; a < scaled_.actions(); ++a) {
      const Rational added = 2 * off * reach(s, a);
      claim.observe({Rational(lost(s, a) + added), delta_printed_, n, {s}, a, added == 0});
    }
  }
}

Rational ExactClaims::finite_n(long n, const Rational& delta) const {
  return bounds::finite_n(gamma_, delta, start_, Rational(0), n);
}

/// gamma sum_s' P(s'|s,a) v(s').
ScaledTable ExactClaims::expected(const ScaledValues& v) const {
  ScaledValues nothing;
  nothing.numerators.assign(v.numerators.size(), Integer(0));
  nothing.denominator = v.denominator;
  return difference(scaled_.backup(v), scaled_.backup(nothing));
}

// ---- The limit ----

Rational ExactClaims::limit(long from, const ScaledTable& last, const EnteredOrbit& entered,
                            const CertifiedLimit& limit) {
  limit_ = {};
  if (lemma_1_iterates_) {
    at_limit(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(last, 0, from));
  }
  Rational gap(0);
  for (std::size_t j = 0; j < limit.low.size(); ++j) {
    gap = std::max(gap, phase(from + static_cast<long>(j), j, entered, limit));
  }
  return gap;
}

void ExactClaims::no_limit() {
  limit_ = {};
  for (const ClaimId id : of_rounds) at_limit(id).undecided();
}

Rational ExactClaims::phase(long n, std::size_t j, const EnteredOrbit& entered, const CertifiedLimit& limit) {
  const std::vector<ScaledTable>& orbit = entered.orbit.tables;
  if (lemma_1_iterates_) {
    at_limit(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(orbit[j], 2 * gamma_ * entered.off, n));
  }
  lemma_2(at_limit(ClaimId::lemma_2), n, orbit[j], orbit[(j + 1) % orbit.size()], entered.off);

  const bool attained = limit.attained[j];
  const ScaledTable low = backup(limit.low[j]);
  std::optional<ScaledTable> fixed;
  if (limit.fixed[j]) fixed = backup(*limit.fixed[j]);
  if (fixed && attained && lemma_1_) {
    at_limit(ClaimId::lemma_1).observe(lemma_1_->tightest(*fixed, 0, n));
    at_limit(ClaimId::lemma_1).observe(lemma_1_->tightest(low, 0, n));
  } else {
    at_limit(ClaimId::lemma_1).undecided();
  }
  const Instance loss = largest_difference(optimal_, low, n, 0);
  const Instance gap = fixed ? largest_difference(optimal_, *fixed, n, 0) : loss;
  at_limit(ClaimId::theorem_1).observe(against(gap, bounds::theorem_1(gamma_, delta_printed_), fixed.has_value()));
  losses_in_phase(loss, attained);
  return loss.left;
}

void ExactClaims::losses_in_phase(const Instance& loss, bool attained) {
  const auto observe = [&](ClaimId id, const Rational& right) { at_limit(id).observe(against(loss, right, attained)); };
  observe(ClaimId::a_optimal_attacker, bounds::theorem_1(gamma_, delta_sound_));
  observe(ClaimId::b_one_sided, bounds::theorem_1_one_sided(gamma_, delta_sound_));
  observe(ClaimId::c_finite_n, least_from(loss.n, delta_repaired_));
  observe(ClaimId::d_total_variation, least_from(loss.n, delta_tv_));
}

Rational ExactClaims::least_from(long n, const Rational& delta) const {
  return std::min(finite_n(n, delta), bounds::theorem_1_one_sided(gamma_, delta));
}

// ---- What is enclosed ----

void ExactClaims::boxed_pair(long n, const PairBox& values) {
  Instance loss = largest_difference(optimal_, scaled_.backup(values.below), n, 0);
  loss.decisive = false;
  facts_.push_back({{}, std::move(loss)});
  if (lemma_1_) at(ClaimId::lemma_1).observe(spread(*lemma_1_, {values.below, values.above}, n));
}

void ExactClaims::boxed_round(long n, const ValueBox* before, const RoundBox& round, int pair) {
  if (lemma_1_iterates_ && before) at(ClaimId::lemma_1_iterates).observe(spread(*lemma_1_iterates_, *before, n));
  boxed_lemma_2(at(ClaimId::lemma_2), n, round);
  finite_n(n, facts_[static_cast<std::size_t>(pair)].loss);
}

void ExactClaims::boxed_limit(long from, const BoxLimit& limit) {
  limit_ = {};
  for (std::size_t j = 0; j < limit.phases.size(); ++j) {
    const long n = from + static_cast<long>(j);
    const ValueBox& before = limit.phases[j == 0 ? limit.phases.size() - 1 : j - 1].passed;
    const PairBox& values = limit.pairs[j];
    if (lemma_1_) at_limit(ClaimId::lemma_1).observe(spread(*lemma_1_, {values.below, values.above}, n));
    if (lemma_1_iterates_) {
      at_limit(ClaimId::lemma_1_iterates).observe(spread(*lemma_1_iterates_, before, n));
    }
    boxed_lemma_2(at_limit(ClaimId::lemma_2), n, limit.phases[j]);
    const Instance loss = largest_difference(optimal_, scaled_.backup(values.below), n, 0);
    at_limit(ClaimId::theorem_1).observe(against(loss, bounds::theorem_1(gamma_, delta_printed_), false));
    losses_in_phase(loss, false);
  }
}

/// 0 <= T*Q_n - Q_{n+1} is at most gamma P D, where D is what the best action has over x_n, and 0 where the agent sees
/// the truth.
void ExactClaims::boxed_lemma_2(Tightest& claim, long n, const RoundBox& round) const {
  if (!options_.wants(ClaimId::lemma_2)) return;
  const Integer& grid = round.passed.low.denominator;
  ScaledValues lost;
  lost.denominator = round.denominator * grid;
  for (State s = 0; s < scaled_.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    Integer& d = lost.numerators.emplace_back(0);
    if (misled_.numerators[i] != 0) {
      d = round.q.high.row(s).maxCoeff() * grid - round.passed.low.numerators[i] * round.denominator;
    }
  }
  Instance instance = largest_entry(expected(lost), n, delta_printed_);
  instance.decisive = false;
  claim.observe(std::move(instance));
}

Instance ExactClaims::spread(const LipschitzCheck& check, const ValueBox& v, long n) const {
  ScaledValues middle;
  middle.denominator = 2 * v.low.denominator;
  Integer widest(0);
  for (std::size_t s = 0; s < v.low.numerators.size(); ++s) {
    middle.numerators.push_back(v.low.numerators[s] + v.high.numerators[s]);
    widest = std::max(widest, Integer(v.high.numerators[s] - v.low.numerators[s]));
  }
  const Rational half(widest, middle.denominator);
  Instance instance = check.tightest(scaled_.backup(middle), 2 * gamma_ * half, n);
  instance.decisive = false;
  return instance;
}

// ---- E and F ----

void ExactClaims::test_time(const ScaledValues& robust, const Rational& l_star) {
  const Rational right = bounds::test_time_pessimism(eps_, gamma_, l_star);
  at(ClaimId::e_test_time).observe(largest_difference(optimal_, scaled_.backup(robust), -1, right));
}

void ExactClaims::beliefs(const CertifiedBeliefGame& game, const Values<Rational>& start, const Rational& l_star) {
  const Rational right = bounds::belief(game.reach, gamma_, l_star);
  for (State s = 0; s < start.size(); ++s) {
    at(ClaimId::f_belief).observe({Rational(v_[s] - start[s]), right, -1, {s}, -1, game.exact});
  }
}

// ---- Verdicts ----

CertifiedClaim ExactClaims::verdict(ClaimId id) const {
  Tightest all = rounds_[static_cast<std::size_t>(id)];
  all.join(limit_[static_cast<std::size_t>(id)]);
  return all.verdict(id, exact_);
}

bool ExactClaims::out_of_reach(ClaimId id) const {
  return (id == ClaimId::lemma_1 && !lemma_1_) || (id == ClaimId::lemma_1_iterates && !lemma_1_iterates_);
}

bool ExactClaims::rounds_hold() const {
  return std::all_of(std::begin(of_rounds), std::end(of_rounds), [&](ClaimId id) {
    return !options_.wants(id) || out_of_reach(id) || verdict(id).verdict == Verdict::holds;
  });
}

std::vector<CertifiedClaim> ExactClaims::verdicts() const {
  std::vector<CertifiedClaim> result;
  for (const Claim& c : claims()) {
    const bool left_out = bounds_ && (c.id == ClaimId::lemma_3 || (!options_.only && out_of_reach(c.id)));
    if (options_.wants(c.id) && !left_out) result.push_back(verdict(c.id));
  }
  return result;
}

}  // namespace maximin
