#include <maximin/proofs_check/examination.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bounds.hpp>

namespace maximin {

namespace {

double certain_ratio(double left, double right, double slack) {
  constexpr double violated = std::numeric_limits<double>::infinity();
  if (!std::isfinite(left) || !std::isfinite(right) || !std::isfinite(slack)) return violated;
  const double certain = left - slack;
  if (certain <= 0) return right + slack >= left ? 0 : violated;
  return right > 0 ? certain / right : violated;
}

}  // namespace

void Check::observe(double l, double r, double s, long round) {
  const double ratio = certain_ratio(l, r, s);
  if (instances++ == 0 || ratio > tightness()) {
    left = l;
    right = r;
    slack = s;
    n = round;
  }
  least_right = std::min(least_right, r);
  if (verdict != Verdict::violated) verdict = ratio <= 1 ? Verdict::holds : Verdict::violated;
}

double Check::tightness() const {
  return certain_ratio(left, right, slack);
}

bool Examination::any(Verdict verdict) const {
  return std::any_of(checks.begin(), checks.end(), [&](const Check& c) { return c.verdict == verdict; });
}

bool Examination::informative(ClaimId id) const {
  const Check& c = check(id);
  return (c.verdict == Verdict::holds || c.verdict == Verdict::violated) && c.least_right < trivial;
}

namespace {

/// Relative rounding of a bound computed from exact constants by the few operations of theory/bounds.hpp.
constexpr double formula_rounding = 1e-12;

/// One model, step by step. Each method checks the claims it is named after.
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
      fail_assumption();
      return std::move(result_);
    }
    optimal_ = policy_iteration(mdp_);
    const auto l_star = lipschitz_constant(optimal_.q, perturbation_.metric());
    result_.lipschitz_of_q_star = l_star.value;
    set_deltas();
    iterate();
    limits();
    test_time();
    belief();
    return std::move(result_);
  }

 private:
  void fail_assumption() {
    const auto& c = result_.constants;
    const auto& bad = c.l_r.infinite ? c.l_r : c.l_p.infinite ? c.l_p : c.k_tv;
    result_.failed_assumption = fmt::format(
        "Assumption 1: states {} and {} are at distance 0 but their {} for action {} differ, so no Lipschitz "
        "constant exists",
        bad.s1, bad.s2, c.l_r.infinite ? "rewards" : "transitions", bad.action);
    for (Check& c2 : result_.checks) c2.verdict = Verdict::assumption_fails;
  }

  Check* wanted(ClaimId id) { return options_.wants(id) ? &result_.check(id) : nullptr; }

  /// |S| times l_p, R_max and so on, under the chosen reading for what the paper prints and the sound one for the rest.
  void set_deltas() {
    const auto& c = result_.constants;
    const double r_max_read = options_.reading == Reading::paper ? std::max(0.0, c.r_max_signed) : c.r_max;
    l_printed_ = bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), r_max_read);
    const double l_printed_sound =
        bounds::lipschitz_of_q_printed(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), c.r_max);
    l_repaired_ = bounds::lipschitz_of_q(gamma_, c.l_r.value, c.l_p.value, mdp_.states(), c.r_max);
    const double eps = perturbation_.radius();
    delta_printed_ = bounds::delta(eps, gamma_, l_printed_);
    delta_printed_sound_ = bounds::delta(eps, gamma_, l_printed_sound);
    delta_repaired_ = bounds::delta(eps, gamma_, l_repaired_);
    delta_tv_ = bounds::delta(eps, gamma_, bounds::lipschitz_of_q_tv(gamma_, c.l_r.value, c.k_tv.value, c.span));
    d_0_ = std::max(0.0, optimal_.q.maxCoeff());
    u_0_ = std::max(0.0, -optimal_.q.minCoeff());
    rounding_ = 1e-14 * static_cast<double>(mdp_.states() + 10) * result_.constants.r_max / (1 - gamma_);
  }

  /// max (Q* - Q) for the attacked values of one policy pair, and how well it is known.
  struct Gap {
    double pair = 0;    ///< against omega_n
    double robust = 0;  ///< against the optimal attacker of pi_n
    double error = 0;
  };

  double slack(double right, double error) const { return error + formula_rounding * std::abs(right) + rounding_; }

  /// Lemma 1: an instance left <= L d for the pair of states where left - L d is largest.
  void check_lipschitz(Check& check, const QTable<double>& q, double l, double error, long n) {
    const auto constant = lipschitz_constant(q, perturbation_.metric());
    if (constant.infinite) return check.observe(std::numeric_limits<double>::infinity(), l, 0, n);
    const double d = perturbation_.metric().distance(constant.s1, constant.s2);
    check.observe(constant.value * d, l * d, slack(l * d, 2 * error), n);
  }

  const Gap& gap_of(int pair, const PolicyPair& policies, long n) {
    if (static_cast<std::size_t>(pair) < gaps_.size()) return gaps_[static_cast<std::size_t>(pair)];
    compose(policies.policy, policies.attack, composed_);
    const auto attacked = evaluate_policy(mdp_, composed_);
    const auto robust = evaluate_against_optimal_attack(mdp_, perturbation_, policies.policy);
    Gap gap;
    gap.pair = (optimal_.q - attacked.q).maxCoeff();
    gap.robust = (optimal_.q - robust.q).maxCoeff();
    gap.error = optimal_.error + std::max(attacked.error, robust.error);
    gaps_.push_back(gap);
    if (Check* c = wanted(ClaimId::lemma_1)) check_lipschitz(*c, attacked.q, l_printed_, attacked.error, n);
    regime(policies);
    return gaps_.back();
  }

  void regime(const PolicyPair& policies) {
    for (std::size_t s = 0; s < policies.attack.size(); ++s) {
      if (policies.policy[static_cast<std::size_t>(policies.attack[s])] != policies.policy[s]) {
        result_.attack_changes_action = true;
      }
    }
  }

  void at_round(long n, const QTable<double>& q, int pair, const PolicyPair& policies) {
    const Gap gap = gap_of(pair, policies, n);
    if (Check* c = wanted(ClaimId::c_finite_n)) {
      const double right = bounds::finite_n(gamma_, delta_repaired_, d_0_, u_0_, n);
      c->observe(gap.robust, right, slack(right, gap.error), n);
    }
    if (Check* c = wanted(ClaimId::d_total_variation)) {
      const double right = bounds::finite_n(gamma_, delta_tv_, d_0_, u_0_, n);
      c->observe(gap.robust, right, slack(right, gap.error), n);
    }
    backups(n, q, policies);
    if (Check* c = wanted(ClaimId::lemma_1_iterates); c && (n < 8 || (n & (n - 1)) == 0)) {
      check_lipschitz(*c, q, l_repaired_, rounding_, n);
    }
    greedy_policy(q, greedy_, options_.tie);
    result_.pessimism_changes_action |= greedy_ != policies.policy;
  }

  /// Lemmas 2 and 3 at round n.
  void backups(long n, const QTable<double>& q, const PolicyPair& policies) {
    compose(policies.policy, policies.attack, composed_);
    bellman_pair(mdp_, composed_, q, values_, next_);
    if (Check* c = wanted(ClaimId::lemma_2)) {
      bellman_optimality(mdp_, q, values_, other_);
      const double left = (other_ - next_).cwiseAbs().maxCoeff();
      c->observe(left, delta_printed_, slack(delta_printed_, 0), n);
    }
    if (Check* c = wanted(ClaimId::lemma_3)) {
      bellman_pair(mdp_, composed_, optimal_.q, values_, other_);
      const double right = gamma_ * (q - optimal_.q).cwiseAbs().maxCoeff();
      c->observe((other_ - next_).cwiseAbs().maxCoeff(), right, slack(right, 0), n);
    }
  }

  void iterate() {
    PessimisticQIterationOptions<double> iteration;
    iteration.max_iterations = options_.max_iterations;
    iteration.tie = options_.tie;
    run_ = pessimistic_q_iteration<double>(
        mdp_, perturbation_, iteration, [this](long n, const QTable<double>& q, int pair, const PolicyPair& policies) {
          at_round(n, q, pair, policies);
        });
    result_.fate = run_.fate;
    result_.period = run_.period;
    result_.iterations = run_.iterations;
    result_.pairs = static_cast<long>(run_.pairs.size());
  }

  /// Theorem 1, A and B: the limsup is the maximum over the pairs that recur.
  void limits() {
    Gap limit;
    if (run_.fate != Fate::undetermined) {
      for (long n = run_.iterations - run_.period; n < run_.iterations; ++n) {
        const Gap& gap = gaps_[static_cast<std::size_t>(run_.pair_of[static_cast<std::size_t>(n)])];
        limit.pair = std::max(limit.pair, gap.pair);
        limit.robust = std::max(limit.robust, gap.robust);
        limit.error = std::max(limit.error, gap.error);
      }
      result_.gap = limit.robust;
    }
    limit_check(ClaimId::theorem_1, limit.pair, bounds::theorem_1(gamma_, delta_printed_), limit.error);
    limit_check(ClaimId::a_optimal_attacker, limit.robust, bounds::theorem_1(gamma_, delta_printed_sound_),
                limit.error);
    limit_check(ClaimId::b_one_sided, limit.robust, bounds::theorem_1_one_sided(gamma_, delta_printed_sound_),
                limit.error);
  }

  void limit_check(ClaimId id, double left, double right, double error) {
    Check* c = wanted(id);
    if (!c) return;
    if (run_.fate == Fate::undetermined) {
      c->verdict = Verdict::undetermined;
    } else {
      c->observe(left, right, slack(right, error), run_.iterations - 1);
    }
  }

  /// How much the right sides of E and F may be off because L* comes from a computed Q*.
  double l_star_slack(double factor) const {
    double nearest = std::numeric_limits<double>::infinity();
    for (State s = 0; s < mdp_.states(); ++s) {
      for (State t = s + 1; t < mdp_.states(); ++t) {
        const double d = perturbation_.metric().distance(s, t);
        if (d > 0) nearest = std::min(nearest, d);
      }
    }
    return factor * 2 * optimal_.error / nearest;
  }

  /// E: the maximin policy of Q* itself, against its optimal attacker.
  void test_time() {
    Check* c = wanted(ClaimId::e_test_time);
    if (!c) return;
    Policy policy;
    std::vector<double> scratch;
    maximin_policy(optimal_.q, perturbation_, policy, scratch, MinAggregator{}, options_.tie);
    const auto robust = evaluate_against_optimal_attack(mdp_, perturbation_, policy);
    const double right = bounds::test_time_pessimism(perturbation_.radius(), gamma_, result_.lipschitz_of_q_star);
    const double l_error = l_star_slack(2 * perturbation_.radius() * gamma_ / (1 - gamma_));
    c->observe((optimal_.q - robust.q).maxCoeff(), right, slack(right, optimal_.error + robust.error + l_error));
  }

  /// F: the maximin policy of Q* over the exact belief, against any attack.
  void belief() {
    Check* c = wanted(ClaimId::f_belief);
    if (!c) return;
    BeliefGameOptions game;
    game.max_positions = options_.max_belief_positions;
    try {
      const auto value = solve_belief_game(mdp_, perturbation_, maximin_belief_policy(optimal_.q, options_.tie), game);
      const double right = bounds::belief(value.reach, gamma_, result_.lipschitz_of_q_star);
      const double l_error = l_star_slack(value.reach / (1 - gamma_));
      c->observe((optimal_.v - value.v).maxCoeff(), right, slack(right, optimal_.error + value.error + l_error));
      result_.belief_positions = value.positions;
    } catch (const BudgetExhausted&) {
      c->verdict = Verdict::undetermined;
    }
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
  double rounding_ = 0;  ///< of a few backups, absolute
  Policy composed_, greedy_;
  Values<double> values_;
  QTable<double> next_, other_;
};

}  // namespace

Examination examine(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                    const ExaminationOptions& options) {
  if (perturbation.states() != mdp.states()) {
    throw InputError(
        fmt::format("perturbation: of {} states, expected the model's {}", perturbation.states(), mdp.states()));
  }
  return Examiner(mdp, perturbation, options).run();
}

}  // namespace maximin
