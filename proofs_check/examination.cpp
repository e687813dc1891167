#include <maximin/proofs_check/examination.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bounds.hpp>

namespace maximin {

bool Examination::any(Verdict verdict) const {
  return std::any_of(checks.begin(), checks.end(), [&](const Check& c) { return c.verdict == verdict; });
}

bool Examination::informative(ClaimId id) const {
  const Check& c = check(id);
  return (c.verdict == Verdict::holds || c.verdict == Verdict::violated) && c.least_right < trivial;
}

namespace {

using Table = QTable<double>;

/// Relative rounding of a bound computed from exact constants by the few operations of theory/bounds.hpp.
constexpr double formula_rounding = 1e-12;

/// A slack above this share of the trivial bound decides nothing.
constexpr double bluntest_slack = 1e-3;

/// Where x - y is largest.
Place place_of_largest(const Table& x, const Table& y, double& difference) {
  Eigen::Index s = 0, a = 0;
  difference = (x - y).maxCoeff(&s, &a);
  return {static_cast<State>(s), -1, static_cast<Action>(a)};
}

/// One model, claim by claim: each claim of the theory is the method of its name.
class Examiner {
 public:
  Examiner(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation, const ExaminationOptions& options)
      : mdp_(mdp), perturbation_(perturbation), options_(options), gamma_(mdp.discount()) {
    result_.states = mdp.states();
    result_.actions = mdp.actions();
    result_.discount = gamma_;
    result_.eps = perturbation.eps();
    result_.radius = perturbation.radius();
    result_.largest_ball = perturbation.largest_ball();
    result_.constants = model_constants(mdp, perturbation.metric());
    result_.trivial = bounds::trivial(gamma_, result_.constants.span);
  }

  Examination run() {
    if (!result_.constants.finite()) {
      assumption_1_fails();
      return std::move(result_);
    }
    poll();
    optimal_ = policy_iteration(mdp_);
    result_.lipschitz_of_q_star = lipschitz_constant(optimal_.q, perturbation_.metric()).value;
    set_constants();
    iterate();
    Gap limit;
    const bool known = limit_of_gaps(limit);
    poll();
    theorem_1(limit, known);
    strengthening_a(limit, known);
    strengthening_b(limit, known);
    strengthening_e();
    poll();
    strengthening_f();
    return std::move(result_);
  }

 private:
  /// The attacked values of one policy pair below Q*, and how well they are known.
  struct Gap {
    double pair = 0;    ///< max (Q* - Q^{pi_n o omega_n})
    double robust = 0;  ///< max (Q* - Q) for the optimal attacker of pi_n
    double error = 0;   ///< of both
    Place pair_place, robust_place;
  };

  // ---- The claims, in the paper's order ----

  /// Lemma 1 (paper, equation 3), for the best response omega_n of the paper and for the optimal attacker:
  /// |Q(s,a) - Q(t,a)| <= (l_r + |S| l_p R_max/(1-gamma)) |x_s - x_t|.
  void lemma_1(long n, const Table& attacked, const Table& robust, double error) {
    if (Check* c = wanted(ClaimId::lemma_1)) {
      lipschitz(*c, attacked, l_printed_, error, n);
      lipschitz(*c, robust, l_printed_, error, n);
    }
  }

  /// Lemma 1 for the iterates, as the proof of Lemma 2 uses it: Q_n is Lipschitz with l_r + gamma |S| l_p
  /// R_max/(1-gamma). Looked at in rounds 0 to 7 and then in powers of two.
  void lemma_1_iterates(long n, const Table& q) {
    Check* c = wanted(ClaimId::lemma_1_iterates);
    if (c && (n < 8 || (n & (n - 1)) == 0)) lipschitz(*c, q, l_repaired_, rounding_, n);
  }

  /// Lemma 2 (paper, equation 4): |T*Q_n - Q_{n+1}| <= Delta. `next` is Q_{n+1}.
  void lemma_2(long n, const Table& q, const Table& next) {
    if (Check* c = wanted(ClaimId::lemma_2)) {
      bellman_optimality(mdp_, q, values_, other_);
      double loss = 0;
      const Place place = place_of_largest((other_ - next).cwiseAbs(), Table::Zero(q.rows(), q.cols()), loss);
      observe(*c, loss, delta_printed_, 0, n, place);
    }
  }

  /// Lemma 3: |T^{pi o omega}Q_n - T^{pi o omega}Q*| <= gamma |Q_n - Q*|. `next` is T^{pi o omega}Q_n.
  void lemma_3(long n, const Table& q, const Table& next) {
    if (Check* c = wanted(ClaimId::lemma_3)) {
      bellman_pair(mdp_, composed_, optimal_.q, values_, other_);
      observe(*c, (other_ - next).cwiseAbs().maxCoeff(), gamma_ * (q - optimal_.q).cwiseAbs().maxCoeff(), 0, n);
    }
  }

  /// Theorem 1: limsup |Q* - Q^{pi_n o omega_n}| <= (1+gamma)/(1-gamma)^2 Delta, R_max as the reading has it.
  void theorem_1(const Gap& limit, bool known) {
    at_the_limit(ClaimId::theorem_1, known, limit.pair, bounds::theorem_1(gamma_, delta_printed_), limit.error,
                 limit.pair_place);
  }

  /// A: Theorem 1 against the optimal attacker of pi_n.
  void strengthening_a(const Gap& limit, bool known) {
    at_the_limit(ClaimId::a_optimal_attacker, known, limit.robust, bounds::theorem_1(gamma_, delta_printed_sound_),
                 limit.error, limit.robust_place);
  }

  /// B: the constant 1/(1-gamma)^2 in the place of (1+gamma)/(1-gamma)^2.
  void strengthening_b(const Gap& limit, bool known) {
    at_the_limit(ClaimId::b_one_sided, known, limit.robust, bounds::theorem_1_one_sided(gamma_, delta_printed_sound_),
                 limit.error, limit.robust_place);
  }

  /// C: the gap at every n, against the optimal attacker.
  void strengthening_c(long n, const Gap& gap) { at_round_n(ClaimId::c_finite_n, delta_repaired_, n, gap); }

  /// D: the same with the Lipschitz constant from total variation.
  void strengthening_d(long n, const Gap& gap) { at_round_n(ClaimId::d_total_variation, delta_tv_, n, gap); }

  /// E: the maximin policy of Q* itself, against its optimal attacker, loses at most 2 eps gamma L*/(1-gamma) in Q.
  void strengthening_e() {
    Check* c = wanted(ClaimId::e_test_time);
    if (!c) return;
    Policy policy;
    std::vector<double> scratch;
    maximin_policy(optimal_.q, perturbation_, policy, scratch, MinAggregator{}, options_.tie);
    const auto robust = evaluate_against_optimal_attack(mdp_, perturbation_, policy);
    const double eps = perturbation_.radius();
    const double right = bounds::test_time_pessimism(eps, gamma_, result_.lipschitz_of_q_star);
    const double l_error = bounds::test_time_pessimism(eps, gamma_, error_of_l_star());
    double gap = 0;
    const Place place = place_of_largest(optimal_.q, robust.q, gap);
    observe(*c, gap, right, optimal_.error + robust.error + l_error, -1, place);
  }

  /// F: the maximin policy of Q* over the exact belief, against any attack, loses at most rho L*/(1-gamma) in V, where
  /// rho is the largest distance found from a true state to a member of the belief held in it.
  void strengthening_f() {
    Check* c = wanted(ClaimId::f_belief);
    if (!c) return;
    BeliefGameOptions game;
    game.max_positions = options_.max_belief_positions;
    try {
      const auto value = solve_belief_game(mdp_, perturbation_, maximin_belief_policy(optimal_.q, options_.tie), game);
      const double right = bounds::belief(value.reach, gamma_, result_.lipschitz_of_q_star);
      const double l_error = bounds::belief(value.reach, gamma_, error_of_l_star());
      Eigen::Index s = 0;
      const double loss = (optimal_.v - value.v).maxCoeff(&s);
      observe(*c, loss, right, optimal_.error + value.error + l_error, -1, {static_cast<State>(s), -1, -1});
      result_.belief_positions = value.positions;
    } catch (const BudgetExhausted&) {
      c->undecided();
    }
  }

  // ---- What the claims share ----

  void poll() const {
    if (options_.stop && *options_.stop) throw Interrupted();
  }

  Check* wanted(ClaimId id) { return options_.wants(id) ? &result_.check(id) : nullptr; }

  /// One instance, with the error of its sides and the rounding of the formulas. A slack that is not small against what
  /// there is to lose decides nothing.
  void observe(Check& check, double left, double right, double error, long n, const Place& place = {}) {
    const double slack = error + formula_rounding * std::abs(right) + rounding_;
    if (result_.trivial > 0 && slack > bluntest_slack * result_.trivial && left <= right + slack) {
      check.undecided();
    } else {
      check.observe(left, right, slack, n, place);
    }
  }

  /// |Q(s,a) - Q(t,a)| <= L |x_s - x_t| for all s, t and a, each side of every instance known to within the error.
  void lipschitz(Check& check, const Table& q, double l, double error, long n) {
    for (State s = 0; s < q.rows(); ++s) {
      for (State t = s + 1; t < q.rows(); ++t) {
        const double right = l * perturbation_.metric().distance(s, t);
        if (!std::isfinite(right)) continue;  // no path joins the states: nothing is claimed
        for (Action a = 0; a < q.cols(); ++a)
          observe(check, std::abs(q(s, a) - q(t, a)), right, 2 * error, n, {s, t, a});
      }
    }
    if (check.verdict == Verdict::not_asked) check.observe(0, 0, 0, n);  // no two states to compare: holds of itself
  }

  void at_the_limit(ClaimId id, bool known, double left, double right, double error, const Place& place) {
    Check* c = wanted(id);
    if (!c) return;
    if (known) {
      observe(*c, left, right, error, run_.iterations - 1, place);
    } else {
      c->undecided();
    }
  }

  void at_round_n(ClaimId id, double delta, long n, const Gap& gap) {
    if (Check* c = wanted(id)) {
      const double start_error = 2 * optimal_.error * gamma_ / (1 - gamma_);  // of d_0 + u_0
      observe(*c, gap.robust, bounds::finite_n(gamma_, delta, d_0_, u_0_, n), gap.error + start_error, n,
              gap.robust_place);
    }
  }

  /// Q_n is Lipschitz, and so are all claims but Lemma 3, only where Assumption 1 holds with finite constants.
  void assumption_1_fails() {
    const auto& c = result_.constants;
    const auto& bad = c.l_r.infinite ? c.l_r : c.l_p.infinite ? c.l_p : c.k_tv;
    result_.failed_assumption = fmt::format(
        "Assumption 1: states {} and {} are at distance 0, or as good as, but their {} for action {} differ, so no "
        "Lipschitz constant exists",
        bad.s1, bad.s2, c.l_r.infinite ? "rewards" : "transitions", bad.action);
    for (const Claim& claim : claims()) {
      if (Check* check = wanted(claim.id)) check->verdict = Verdict::assumption_fails;
    }
  }

  /// The Lipschitz constants and Deltas of the claims: R_max under the chosen reading for what the paper prints, sound
  /// for the rest.
  void set_constants() {
    const auto& c = result_.constants;
    const double r_max_read = options_.reading == Reading::paper ? std::max(0.0, c.r_max_signed) : c.r_max;
    const auto printed = [&](double r_max) {
      return bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), r_max);
    };
    l_printed_ = printed(r_max_read);
    l_repaired_ = bounds::lipschitz_of_q(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), c.r_max);
    const double eps = perturbation_.radius();
    delta_printed_ = bounds::delta(eps, gamma_, l_printed_);
    delta_printed_sound_ = bounds::delta(eps, gamma_, printed(c.r_max));
    delta_repaired_ = bounds::delta(eps, gamma_, l_repaired_);
    delta_tv_ = bounds::delta(eps, gamma_, bounds::lipschitz_of_q_tv(gamma_, c.l_r.value, c.k_tv.value, c.span));
    d_0_ = std::max(0.0, optimal_.q.maxCoeff());
    u_0_ = std::max(0.0, -optimal_.q.minCoeff());
    const double largest =
        std::max(bounds::theorem_1(gamma_, delta_printed_sound_), bounds::theorem_1(gamma_, delta_tv_));
    if (!std::isfinite(largest)) {
      throw InputError("eps: so large, or the Lipschitz constants, that the bounds overflow; expected a smaller eps");
    }
    rounding_ = 1e-14 * static_cast<double>(mdp_.states() + 10) * c.r_max / (1 - gamma_);
  }

  /// How far L*, taken from a computed Q*, may be below the Lipschitz constant of the exact one. States with the same
  /// rewards and transitions have the same exact values and are left out, however near they are.
  double error_of_l_star() const {
    double largest = result_.lipschitz_of_q_star;
    for (State s = 0; s < mdp_.states(); ++s) {
      for (State t = s + 1; t < mdp_.states(); ++t) {
        const double d = perturbation_.metric().distance(s, t);
        for (Action a = 0; a < mdp_.actions(); ++a) {
          const auto x = mdp_.successors(s, a), y = mdp_.successors(t, a);
          if (mdp_.reward(s, a) == mdp_.reward(t, a) && std::equal(x.begin(), x.end(), y.begin(), y.end())) continue;
          largest = std::max(largest, (std::abs(optimal_.q(s, a) - optimal_.q(t, a)) + 2 * optimal_.error) / d);
        }
      }
    }
    return largest - result_.lipschitz_of_q_star;
  }

  void iterate() {
    PessimisticQIterationOptions<double> iteration;
    iteration.max_iterations = options_.max_iterations;
    iteration.max_period = options_.max_period;
    iteration.tie = options_.tie;
    run_ = pessimistic_q_iteration<double>(
        mdp_, perturbation_, iteration,
        [this](long n, const Table& q, int pair, const PolicyPair& policies) { round(n, q, pair, policies); });
    result_.fate = run_.fate;
    result_.period = run_.period;
    result_.periodic_from = run_.fate == Fate::undetermined ? -1 : run_.periodic_from;
    result_.iterations = run_.iterations;
    result_.pairs = static_cast<long>(run_.pairs.size());
  }

  /// Everything that is claimed of round n.
  void round(long n, const Table& q, int pair, const PolicyPair& policies) {
    poll();
    compose(policies.policy, policies.attack, composed_);
    const Gap gap = gap_of(pair, policies, n);
    bellman_pair(mdp_, composed_, q, values_, next_);
    lemma_1_iterates(n, q);
    lemma_2(n, q, next_);
    lemma_3(n, q, next_);
    strengthening_c(n, gap);
    strengthening_d(n, gap);
    greedy_policy(q, greedy_, options_.tie);
    result_.pessimism_changes_action |= greedy_ != policies.policy;
    result_.attack_changes_action |= composed_ != policies.policy;
  }

  /// The values of a policy pair, computed when it is first met. Its composed policy is in composed_.
  const Gap& gap_of(int pair, const PolicyPair& policies, long n) {
    if (static_cast<std::size_t>(pair) < gaps_.size()) return gaps_[static_cast<std::size_t>(pair)];
    const auto attacked = evaluate_policy(mdp_, composed_);
    const auto robust = evaluate_against_optimal_attack(mdp_, perturbation_, policies.policy);
    const double error = std::max(attacked.error, robust.error);
    lemma_1(n, attacked.q, robust.q, error);
    Gap gap;
    gap.pair_place = place_of_largest(optimal_.q, attacked.q, gap.pair);
    gap.robust_place = place_of_largest(optimal_.q, robust.q, gap.robust);
    gap.error = optimal_.error + error;
    gaps_.push_back(gap);
    return gaps_.back();
  }

  /// The limsup of the gaps is their maximum over the pairs that recur. Returns whether it is known.
  bool limit_of_gaps(Gap& limit) {
    if (run_.fate == Fate::undetermined) {
      result_.gap = std::numeric_limits<double>::quiet_NaN();
      return false;
    }
    limit = {-1, -1, 0, {}, {}};
    for (long n = run_.iterations - run_.period; n < run_.iterations; ++n) {
      const Gap& gap = gaps_[static_cast<std::size_t>(run_.pair_of[static_cast<std::size_t>(n)])];
      if (gap.pair > limit.pair) limit.pair = gap.pair, limit.pair_place = gap.pair_place;
      if (gap.robust > limit.robust) limit.robust = gap.robust, limit.robust_place = gap.robust_place;
      limit.error = std::max(limit.error, gap.error);
    }
    result_.gap = limit.robust;
    return true;
  }

  const FiniteMdp<double>& mdp_;
  const Perturbation<double>& perturbation_;
  const ExaminationOptions& options_;
  double gamma_;
  Examination result_;
  CertifiedSolution<double> optimal_;
  PessimisticQIteration<double> run_;
  std::vector<Gap> gaps_;  // by policy pair
  double l_printed_ = 0, l_repaired_ = 0;
  double delta_printed_ = 0, delta_printed_sound_ = 0, delta_repaired_ = 0, delta_tv_ = 0;
  double d_0_ = 0, u_0_ = 0;
  double rounding_ = 0;  // of a few backups, absolute
  Policy composed_, greedy_;
  Values<double> values_;
  Table next_, other_;
};

}  // namespace

Examination examine(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                    const ExaminationOptions& options) {
  if (perturbation.states() != mdp.states()) {
    throw InputError(
        fmt::format("perturbation: of {} states, expected the model's {}", perturbation.states(), mdp.states()));
  }
  const MacQueenBound<double> finite_values(mdp);  // refuses rewards whose values overflow
  return Examiner(mdp, perturbation, options).run();
}

}  // namespace maximin
