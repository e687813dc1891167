#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <maximin/proofs_check/certificate/belief_positions.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_claims.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/proofs_check/certificate/limit.hpp>
#include <maximin/proofs_check/certificate/orbit_search.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

/// The constants of the model. Throws AssumptionFails where there are none.
ModelConstants<Rational> finite_constants(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry) {
  ModelConstants<Rational> c = model_constants(mdp, geometry);
  refuse_infinite(c);
  return c;
}

/// One model: solves what a certificate states of it, and shows it to the claims.
class Certifier {
 public:
  Certifier(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides, const CertifyOptions& options)
      : options_(options),
        geometry_(model, overrides),
        mdp_(model.mdp),
        balls_(geometry_.balls()),
        scaled_(model.mdp),
        constants_(finite_constants(model.mdp, geometry_)),
        optimal_(policy_iteration(model.mdp, {.tie = options.tie})),
        claims_(model.mdp, scaled_, geometry_, {constants_, ScaledValues(optimal_.v), ScaledValues(optimal_.v)},
                options),
        result_(model) {
    result_.model.geometry = geometry_.stated();
    result_.reading = options.reading;
    result_.tie = options.tie;
    result_.largest_ball = balls_.largest_ball();
    result_.constants = constants_;
    result_.l_star = lipschitz_constant(optimal_.q, geometry_);
    result_.optimal = optimal_.v;
  }

  Certificate run() {
    iterate();
    test_time();
    beliefs();
    result_.claims = claims_.verdicts();
    return std::move(result_);
  }

 private:
  /// Runs rounds, exactly, until the limit is known or a budget ends them. An orbit tells most. Where none is found for
  /// long, boxes are tried every so often: if they prove what is wanted, they end the search.
  void iterate() {
    OrbitSearch search(mdp_, scaled_, balls_, options_);
    const Boxes boxes(mdp_, balls_, scaled_, options_);
    long next_boxes = options_.rounds_before_boxes;
    ScaledTable q{QTable<Integer>::Constant(mdp_.states(), mdp_.actions(), Integer(0)), 1};
    for (long n = 0;;) {
      options_.begin("round", n);
      Policy composed = round(n++, q);
      if (const auto entered = search.after_round(std::move(composed), q)) return follow(n, q, *entered);
      const bool over =
          n >= options_.max_rounds || search.hopeless() || static_cast<long>(msb(q.denominator)) > options_.max_bits;
      result_.ties_open = search.ties_open();
      if (over || n == next_boxes) {
        next_boxes *= 2;
        if (enclose(boxes, n, search.period()) || over) return;
      }
    }
  }

  /// The rounds from n on follow an orbit.
  void follow(long n, const ScaledTable& q, const EnteredOrbit& entered) {
    options_.begin("limit from round", n);
    result_.ties_open = false;
    result_.boxes.reset();
    result_.limit = certify_limit(mdp_, balls_, entered.orbit, entered.phases, options_.tie);
    result_.limit->gap = claims_.limit(n, q, entered, *result_.limit);
  }

  /// Boxes around all rounds from n on. Returns whether they prove every claim about rounds that is wanted.
  bool enclose(const Boxes& boxes, long n, long period) {
    options_.begin("boxes from round", n);
    result_.boxes = boxes.limit_after(boxes.on_grid(passed_), std::max(1L, period));
    if (!result_.boxes) {
      claims_.no_limit();
      return false;
    }
    claims_.boxed_limit(n, *result_.boxes);
    return claims_.rounds_hold();
  }

  /// Makes Q_n Q_{n+1}. Returns pi_n o omega_n.
  Policy round(long n, ScaledTable& q) {
    PolicyPair policies;
    std::vector<Integer> scratch;
    maximin_policy(q.numerators, balls_, policies.policy, scratch, MinAggregator{}, options_.tie);
    best_response_attack(q.numerators, policies.policy, balls_, policies.attack, options_.tie);
    Policy composed, best;
    greedy_policy(q.numerators, best, options_.tie);
    result_.pessimism_changes_action = result_.pessimism_changes_action || best != policies.policy;
    compose(policies.policy, policies.attack, composed);
    passed_ = taken(q, composed);
    ScaledTable next = scaled_.backup(passed_);
    result_.rounds.push_back(index_of(n, std::move(policies), composed));
    claims_.round(n, q, next, result_.rounds.back());
    q = std::move(next);
    return composed;
  }

  /// The index of a policy pair, which is solved when it is first met.
  int index_of(long n, PolicyPair policies, const Policy& composed) {
    const auto [entry, is_new] =
        known_.try_emplace({policies.policy, policies.attack}, static_cast<int>(result_.pairs.size()));
    if (is_new) {
      auto robust = evaluate_against_optimal_attack(mdp_, balls_, policies.policy).v;
      auto fixed = internal::solve_policy_values_exactly(mdp_, composed);
      claims_.pair(n,
                   result_.pairs.emplace_back(CertifiedPair{std::move(policies), std::move(fixed), std::move(robust)}),
                   composed);
    }
    return entry->second;
  }

  void test_time() {
    options_.begin("pessimism at test time");
    std::vector<Rational> scratch;
    maximin_policy(optimal_.q, balls_, result_.test_time_policy, scratch, MinAggregator{}, options_.tie);
    result_.test_time_robust = evaluate_against_optimal_attack(mdp_, balls_, result_.test_time_policy).v;
    claims_.test_time(ScaledValues(result_.test_time_robust), result_.l_star.value);
  }

  void beliefs() {
    if (!options_.wants(ClaimId::f_belief)) return;
    options_.begin("belief game");
    result_.belief_game = certify_belief_game(mdp_, geometry_, optimal_.q, options_);
    if (!result_.belief_game) return;
    claims_.beliefs(*result_.belief_game, start_values(*result_.belief_game, balls_), result_.l_star.value);
  }

  const CertifyOptions& options_;
  ExactGeometry geometry_;
  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  ScaledMdp scaled_;
  ModelConstants<Rational> constants_;
  CertifiedSolution<Rational> optimal_;  // Q* and V*
  ExactClaims claims_;
  std::map<std::pair<Policy, AttackPolicy>, int> known_;  // indices of pairs
  ScaledValues passed_;                                   // x_n of the last round
  Certificate result_;
};

}  // namespace

void CertifyOptions::poll() const {
  if (stop && *stop) throw Interrupted();
}

void CertifyOptions::begin(const char* stage, long n) const {
  poll();
  if (progress) progress(stage, n);
}

Certificate certify(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                    const CertifyOptions& options) {
  options.begin("optimal values");
  return Certifier(model, overrides, options).run();
}

}  // namespace maximin
