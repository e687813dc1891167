#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/proofs_check/certificate/belief_positions.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/proofs_check/certificate/limit.hpp>
#include <maximin/proofs_check/certificate/tightest.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

/// One model, claim by claim. The counterpart of the examination in floating point, with nothing rounded.
class Certifier {
 public:
  Certifier(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides, const CertifyOptions& options)
      : options_(options),
        geometry_(exact_geometry(model, overrides)),
        mdp_(model.mdp),
        balls_(geometry_.balls),
        scaled_(model.mdp),
        gamma_(model.mdp.discount()),
        result_(model) {
    result_.model.geometry = geometry_.geometry;
    result_.reading = options.reading;
    result_.tie = options.tie;
    result_.largest_ball = balls_.largest_ball();
    result_.constants = model_constants(mdp_, geometry_);
    refuse_infinite_constants();
  }

  Certificate run() {
    SolverOptions solver;
    solver.tie = options_.tie;
    auto solution = policy_iteration(mdp_, solver);
    result_.optimal = std::move(solution.v);
    scaled_.backup(ScaledValues(result_.optimal), optimal_);
    result_.l_star = lipschitz_constant(solution.q, geometry_);
    set_constants();
    iterate();
    tail();
    test_time(solution.q);
    beliefs(solution.q);
    for (const Claim& c : claims()) {
      if (options_.wants(c.id)) result_.claims.push_back(at(c.id).verdict(c.id, geometry_.exact));
    }
    return std::move(result_);
  }

 private:
  Tightest& at(ClaimId id) { return tightest_[static_cast<std::size_t>(id)]; }

  void poll() const {
    if (options_.stop && *options_.stop) throw Interrupted();
  }

  void refuse_infinite_constants() const {
    const auto& c = result_.constants;
    if (c.finite()) return;
    const auto& bad = c.l_r.infinite ? c.l_r : c.l_p.infinite ? c.l_p : c.k_tv;
    throw AssumptionFails(fmt::format(
        "Assumption 1: states {} and {} are at distance 0, but their {} for action {} differ, so no Lipschitz constant "
        "exists",
        bad.s1, bad.s2, c.l_r.infinite ? "rewards" : "transitions", bad.action));
  }

  void set_constants() {
    const auto& c = result_.constants;
    const Rational read = options_.reading == Reading::paper ? std::max(Rational(0), c.r_max_signed) : c.r_max;
    const auto printed = [&](const Rational& r_max) {
      return bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), r_max);
    };
    const auto delta = [&](const Rational& l) { return bounds::delta(geometry_.eps, gamma_, l); };
    const Rational repaired = bounds::lipschitz_of_q(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), c.r_max);
    const LipschitzReach reach = lipschitz_reach(mdp_, geometry_, c);
    const Rational horizon = Rational(mdp_.states()) / (1 - gamma_);
    lemma_1_.emplace(mdp_, geometry_, reach.rewards + reach.probabilities * Rational(horizon * read));
    lemma_1_iterates_.emplace(mdp_, geometry_,
                              reach.rewards + reach.probabilities * Rational(horizon * gamma_ * c.r_max));
    delta_printed_ = delta(printed(read));
    delta_sound_ = delta(printed(c.r_max));
    delta_repaired_ = delta(repaired);
    delta_tv_ = delta(bounds::lipschitz_of_q_tv(gamma_, c.l_r.value, c.k_tv.value, c.span));
    const QTable<Rational> q = optimal_.rational();
    start_ = Rational(0);
    Rational largest(0), least(0);
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      largest = std::max(largest, q.data()[i]);
      least = std::min(least, q.data()[i]);
    }
    start_ = largest - least;
  }

  // ---- The rounds ----

  /// Runs rounds, exactly, until the limit is known or a budget ends them.
  void iterate() {
    ScaledTable q{QTable<Integer>::Constant(mdp_.states(), mdp_.actions(), Integer(0)), 1}, next;
    for (long n = 0; n < options_.max_rounds; ++n) {
      poll();
      round(n, q, next);
      std::swap(q, next);
      if (orbit_is_entered(q)) {
        last_ = std::move(q);
        return;
      }
      if (hopeless_ || static_cast<long>(msb(q.denominator)) > options_.max_bits) return;
    }
  }

  void round(long n, const ScaledTable& q, ScaledTable& next) {
    PolicyPair policies;
    std::vector<Integer> scratch;
    maximin_policy(q.numerators, balls_, policies.policy, scratch, MinAggregator{}, options_.tie);
    best_response_attack(q.numerators, policies.policy, balls_, policies.attack, options_.tie);
    Policy composed, best;
    greedy_policy(q.numerators, best, options_.tie);
    result_.pessimism_changes_action = result_.pessimism_changes_action || best != policies.policy;
    compose(policies.policy, policies.attack, composed);
    scaled_.backup(taken(q, composed), next);
    const PairFacts& pair = facts_of(n, std::move(policies), composed);

    if (options_.wants(ClaimId::lemma_1_iterates)) {
      at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(q, 0, n));
    }
    if (options_.wants(ClaimId::lemma_2)) lemma_2(n, q, next);
    if (options_.wants(ClaimId::lemma_3)) {
      at(ClaimId::lemma_3).observe({distance(next, pair.backup_of_optimal), gamma_ * distance(q, optimal_), n});
    }
    finite_n(n, pair.loss);
  }

  /// Lemma 2: |T*Q_n - Q_{n+1}| <= Delta. T*Q_n is never the smaller.
  void lemma_2(long n, const ScaledTable& q, const ScaledTable& next, const Rational& extra = 0, bool decisive = true) {
    ScaledTable best;
    scaled_.backup(greedy(q), best);
    Instance instance = largest_difference(best, next, n, delta_printed_);
    instance.left += extra;
    instance.decisive = decisive;
    at(ClaimId::lemma_2).observe(std::move(instance));
  }

  /// C and D in round n, whose policy loses `loss` at most.
  void finite_n(long n, const Instance& loss) {
    for (const auto& [id, delta] :
         {std::pair(ClaimId::c_finite_n, &delta_repaired_), std::pair(ClaimId::d_total_variation, &delta_tv_)}) {
      if (!options_.wants(id)) continue;
      Instance instance = loss;
      instance.n = n;
      instance.right = bounds::finite_n(gamma_, *delta, start_, Rational(0), n);
      at(id).observe(std::move(instance));
    }
  }

  /// What is said of a policy pair in every round that uses it.
  struct PairFacts {
    ScaledTable backup_of_optimal;  ///< T^{pi o omega} Q*
    Instance loss;                  ///< max (Q* - Q) against the optimal attacker
  };

  const PairFacts& facts_of(long n, PolicyPair policies, const Policy& composed) {
    const auto [entry, is_new] =
        known_.try_emplace({policies.policy, policies.attack}, static_cast<int>(result_.pairs.size()));
    result_.rounds.push_back(entry->second);
    composed_.push_back(composed);
    if (!is_new) return facts_[static_cast<std::size_t>(entry->second)];
    auto robust = evaluate_against_optimal_attack(mdp_, balls_, policies.policy);
    CertifiedPair pair{std::move(policies), internal::solve_policy_values_exactly(mdp_, composed), std::move(robust.v)};
    PairFacts facts;
    scaled_.backup(taken(optimal_, composed), facts.backup_of_optimal);
    const ScaledTable robust_q = backup(pair.robust);
    facts.loss = largest_difference(optimal_, robust_q, n, 0);
    if (options_.wants(ClaimId::lemma_1)) {
      at(ClaimId::lemma_1).observe(lemma_1_->tightest(backup(pair.fixed), 0, n));
      at(ClaimId::lemma_1).observe(lemma_1_->tightest(robust_q, 0, n));
    }
    result_.pairs.push_back(std::move(pair));
    facts_.push_back(std::move(facts));
    return facts_.back();
  }

  // ---- The limit ----

  /// Whether Q_N = q, N the number of rounds run, lies so near to an orbit that it is known what all later rounds do.
  bool orbit_is_entered(const ScaledTable& q) {
    const long k = period();
    const auto n = static_cast<long>(result_.rounds.size());
    if (k == 0 || mdp_.states() * k > most_orbit_unknowns || n < next_attempt_) return false;
    std::vector<Policy> last(composed_.end() - k, composed_.end());
    // An orbit is solved once per rotation of its phases: the one that is found near is the one that is kept.
    const auto [entry, is_new] = orbits_.try_emplace(std::move(last));
    if (is_new) entry->second = find_orbit(mdp_, balls_, entry->first);

    off_ = distance(q, entry->second.tables.front());
    if (off_ > entry->second.radius) return false;
    phases_ = settle(mdp_, balls_, entry->second, q, options_.tie);
    if (!phases_) {
      next_attempt_ = n + 1 + n / 4;  // what is equal for ever may become so later
      result_.ties_open = true;
      hopeless_ = ++failures_[entry->first] >= most_failures;
    }
    orbit_ = phases_ ? &entry->second : nullptr;
    if (phases_) result_.ties_open = false;
    return phases_.has_value();
  }

  /// The smallest period that what is done has had for twice as long, or 0.
  long period() const {
    const auto n = static_cast<long>(composed_.size());
    for (long k = 1; k <= options_.max_period && 3 * k <= n; ++k) {
      bool repeats = true;
      for (long i = 1; i <= 2 * k && repeats; ++i) {
        repeats = composed_[static_cast<std::size_t>(n - i)] == composed_[static_cast<std::size_t>(n - i - k)];
      }
      if (repeats) return k;
    }
    return 0;
  }

  /// Everything that is claimed of the rounds n >= N.
  void tail() {
    static constexpr ClaimId of_the_tail[] = {ClaimId::lemma_1,    ClaimId::lemma_1_iterates,   ClaimId::lemma_2,
                                              ClaimId::theorem_1,  ClaimId::a_optimal_attacker, ClaimId::b_one_sided,
                                              ClaimId::c_finite_n, ClaimId::d_total_variation};
    if (orbit_ == nullptr) {
      for (const ClaimId id : of_the_tail) at(id).undecided();
      return;
    }
    result_.limit = certify_limit(mdp_, balls_, *orbit_, std::move(*phases_), options_.tie);
    at(ClaimId::lemma_1_iterates)
        .observe(lemma_1_iterates_->tightest(last_, 0, static_cast<long>(result_.rounds.size())));
    for (std::size_t j = 0; j < orbit_->tables.size(); ++j) phase(j);
  }

  void phase(std::size_t j) {
    CertifiedLimit& limit = *result_.limit;
    const long n = static_cast<long>(result_.rounds.size() + j);
    const ScaledTable low = backup(limit.low[j]);
    const bool attained = limit.attained[j];
    const ScaledTable& q = orbit_->tables[j];

    at(ClaimId::lemma_1_iterates).observe(lemma_1_iterates_->tightest(q, 2 * gamma_ * off_, n));
    lemma_2(n, q, orbit_->tables[(j + 1) % orbit_->tables.size()], 2 * gamma_ * off_, off_ == 0);
    if (limit.fixed[j] && attained) {
      at(ClaimId::lemma_1).observe(lemma_1_->tightest(backup(*limit.fixed[j]), 0, n));
      at(ClaimId::lemma_1).observe(lemma_1_->tightest(low, 0, n));
    } else {
      at(ClaimId::lemma_1).undecided();
    }
    const Rational bound = bounds::theorem_1(gamma_, delta_printed_);
    Instance gap = largest_difference(optimal_, limit.fixed[j] ? backup(*limit.fixed[j]) : low, n, bound);
    gap.decisive = limit.fixed[j].has_value();
    at(ClaimId::theorem_1).observe(std::move(gap));
    limit.gap = std::max(limit.gap, largest_difference(optimal_, low, n, 0).left);
    const auto loss = [&](ClaimId id, const Rational& right) {
      Instance instance = largest_difference(optimal_, low, n, right);
      instance.decisive = attained;
      at(id).observe(std::move(instance));
    };
    loss(ClaimId::a_optimal_attacker, bounds::theorem_1(gamma_, delta_sound_));
    loss(ClaimId::b_one_sided, bounds::theorem_1_one_sided(gamma_, delta_sound_));
    loss(ClaimId::c_finite_n, least_from(n, delta_repaired_));
    loss(ClaimId::d_total_variation, least_from(n, delta_tv_));
  }

  /// The bound of C changes from round to round in one direction: its least value from n on is that of n or its limit.
  Rational least_from(long n, const Rational& delta) const {
    const Rational rest = 1 - gamma_;
    return std::min(bounds::finite_n(gamma_, delta, start_, Rational(0), n),
                    Rational((gamma_ * delta / rest + delta) / rest));
  }

  // ---- E and F ----

  void test_time(const QTable<Rational>& q) {
    std::vector<Rational> scratch;
    maximin_policy(q, balls_, result_.test_time_policy, scratch, MinAggregator{}, options_.tie);
    result_.test_time_robust = evaluate_against_optimal_attack(mdp_, balls_, result_.test_time_policy).v;
    at(ClaimId::e_test_time)
        .observe(largest_difference(optimal_, backup(result_.test_time_robust), -1,
                                    bounds::test_time_pessimism(geometry_.eps, gamma_, result_.l_star.value)));
  }

  void beliefs(const QTable<Rational>& q) {
    if (!options_.wants(ClaimId::f_belief)) return;
    poll();
    result_.belief_game = certify_belief_game(mdp_, geometry_, q, options_);
    if (!result_.belief_game) return;
    const Values<Rational> v = start_values(*result_.belief_game, balls_);
    const Rational right = bounds::belief(result_.belief_game->reach, gamma_, result_.l_star.value);
    for (State s = 0; s < v.size(); ++s) {
      at(ClaimId::f_belief)
          .observe({Rational(result_.optimal[s] - v[s]), right, -1, {s}, -1, result_.belief_game->exact});
    }
  }

  // ---- Tables ----

  ScaledTable backup(const Values<Rational>& v) const {
    ScaledTable q;
    scaled_.backup(ScaledValues(v), q);
    return q;
  }

  /// s -> q(s, action[s]).
  static ScaledValues taken(const ScaledTable& q, const Policy& action) {
    ScaledValues v;
    v.denominator = q.denominator;
    for (std::size_t s = 0; s < action.size(); ++s) {
      v.numerators.push_back(q.numerators(static_cast<Eigen::Index>(s), action[s]));
    }
    return v;
  }

  /// s -> max_a q(s,a).
  static ScaledValues greedy(const ScaledTable& q) {
    Policy best;
    greedy_policy(q.numerators, best);
    return taken(q, best);
  }

  static constexpr long most_orbit_unknowns = 1'000;
  /// Differences that vanish in the limit alone decide such ties: no number of rounds would show it.
  static constexpr int most_failures = 16;

  const CertifyOptions& options_;
  ExactGeometry geometry_;
  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  ScaledMdp scaled_;
  Rational gamma_;
  Certificate result_;
  ScaledTable optimal_;  // Q*
  Rational start_;       // d_0 + u_0
  Rational delta_printed_, delta_sound_, delta_repaired_, delta_tv_;
  std::optional<LipschitzCheck> lemma_1_, lemma_1_iterates_;
  std::array<Tightest, claim_count> tightest_;
  std::map<std::pair<Policy, AttackPolicy>, int> known_;
  std::vector<PairFacts> facts_;  // by pair
  std::vector<Policy> composed_;  // by round
  std::map<std::vector<Policy>, Orbit> orbits_;
  const Orbit* orbit_ = nullptr;
  std::optional<SettledPhases> phases_;
  ScaledTable last_;                             // Q_N
  Rational off_;                                 // how far Q_N is from the orbit
  std::map<std::vector<Policy>, int> failures_;  // to settle an orbit that Q_n had come near
  bool hopeless_ = false;
  long next_attempt_ = 0;  // the first round in which settling is tried again
};

}  // namespace

Certificate certify(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                    const CertifyOptions& options) {
  return Certifier(model, overrides, options).run();
}

}  // namespace maximin
