#include <algorithm>
#include <map>
#include <utility>

#include <maximin/proofs_check/certificate/belief_positions.hpp>
#include <maximin/proofs_check/certificate/bounds_certificate.hpp>
#include <maximin/proofs_check/certificate/exact_claims.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/proofs_check/certificate/orbit_search.hpp>
#include <maximin/proofs_check/certificate/witnesses.hpp>
#include <maximin/tabular/scaled.hpp>

namespace maximin {
namespace {

/// Lemma 1 looks at all pairs of states, and would take longer than all the rest.
constexpr long most_pair_states = 1'000;

/// One model: encloses what a certificate states of it, and shows it to the claims.
class BoundsCertifier {
 public:
  BoundsCertifier(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                  const CertifyOptions& options)
      : options_(options),
        geometry_(model, overrides),
        mdp_(model.mdp),
        balls_(geometry_.balls()),
        scaled_(model.mdp),
        boxes_(mdp_, balls_, scaled_, options),
        optimal_(boxes_.enclose_optimal()),
        low_(scaled_.backup(optimal_.low)),
        high_(scaled_.backup(optimal_.high)),
        witnesses_(find_witnesses(mdp_, geometry_, low_, high_)),
        claims_(mdp_, scaled_, geometry_, {witnesses_.constants, optimal_.low, optimal_.high, true}, options),
        result_(model) {
    result_.model.geometry = geometry_.stated();
    result_.reading = options.reading;
    result_.tie = options.tie;
    result_.constants = witnesses_.constants;
    result_.l_star = witnesses_.l_star;
    result_.optimal = optimal_;
    result_.bits = boxes_.grid().bits();
    result_.largest_ball = balls_.largest_ball();
  }

  BoundsCertificate run() {
    iterate();
    test_time();
    beliefs();
    result_.claims = claims_.verdicts();
    return std::move(result_);
  }

 private:
  /// Runs rounds until boxes around all later ones prove what is wanted, or a budget ends them. They are tried at
  /// N = 8, 16, 32, ... and in the end
  void iterate() {
    long next_attempt = 8;
    std::optional<ValueBox> before;
    std::vector<Integer> reached;
    for (long n = 0; n < options_.max_rounds; ++n) {
      options_.begin("round", n);
      RoundBox round = before ? boxes_.round_after(*before) : boxes_.first_round();
      result_.rounds.push_back(index_of(n, round));
      claims_.boxed_round(n, before ? &*before : nullptr, round, result_.rounds.back());
      before = std::move(round.passed);
      if (n + 1 < next_attempt && n + 1 < options_.max_rounds) continue;
      next_attempt *= 2;
      options_.begin("boxes from round", n + 1);
      result_.limit = boxes_.limit_after(*before, std::max(1L, period_at_end(result_.rounds, options_.max_period)));
      if (!result_.limit) continue;
      claims_.boxed_limit(n + 1, *result_.limit);
      const auto& below = result_.limit->pairs.front().below.numerators;
      if (claims_.rounds_hold() || below == reached) return;  // or it comes no nearer
      reached = below;
    }
    if (!result_.limit) claims_.no_limit();
  }

  /// The index of what is known of a round's policies, whose values are bounded when it is first met.
  int index_of(long n, const RoundBox& round) {
    const auto [entry, is_new] =
        known_.try_emplace({round.choices, round.provoked}, static_cast<int>(result_.pairs.size()));
    if (is_new) {
      result_.pairs.push_back({round.choices, round.provoked, boxes_.enclose_pair(round.choices, round.provoked)});
      claims_.boxed_pair(n, result_.pairs.back().values);
      count(round);
    }
    return entry->second;
  }

  /// What a campaign counts of a round.
  void count(const RoundBox& round) {
    const auto apart = [](const std::vector<Action>& x, const std::vector<Action>& y) {
      return std::none_of(x.begin(), x.end(), [&](Action a) { return std::binary_search(y.begin(), y.end(), a); });
    };
    for (State s = 0; s < mdp_.states(); ++s) {
      const auto& choices = round.choices[static_cast<std::size_t>(s)];
      if (apart(choices, candidates(round.q, {&s, 1}, options_.tie))) result_.pessimism_changes_action = true;
      if (apart(choices, round.provoked[static_cast<std::size_t>(s)])) result_.attack_changes_action = true;
    }
  }

  void test_time() {
    const Choices choices = candidates(q_star(), balls_, options_.tie);
    result_.test_time = boxes_.enclose_robust(choices);
    claims_.test_time(result_.test_time, result_.l_star.value);
  }

  void beliefs() {
    if (!options_.wants(ClaimId::f_belief)) return;
    options_.begin("belief game");
    const TableBox<Integer> q = q_star();
    result_.belief_game = certify_belief_game(
        mdp_, geometry_, [&](std::span<const State> belief) { return candidates(q, belief, options_.tie); }, options_);
    if (!result_.belief_game) return;
    claims_.beliefs(*result_.belief_game, start_values(*result_.belief_game, balls_), result_.l_star.value);
  }

  /// Around Q*. Both tables have one denominator, that of the grid times the model's.
  TableBox<Integer> q_star() const { return {low_.numerators, high_.numerators}; }

  const CertifyOptions& options_;
  ExactGeometry geometry_;
  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  ScaledMdp scaled_;
  Boxes boxes_;
  ValueBox optimal_;
  ScaledTable low_, high_;  // around Q*
  Witnesses witnesses_;
  ExactClaims claims_;
  std::map<std::pair<Choices, Choices>, int> known_;  // indices of pairs
  BoundsCertificate result_;
};

}  // namespace

BoundsCertificate certify_by_bounds(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                                    const CertifyOptions& options) {
  if (options.only && options.only->contains(ClaimId::lemma_3)) {
    throw InputError("claims: lemma-3 is not proved by bounds, expected others or --arith exact");
  }
  options.begin("optimal values");
  CertifyOptions bounded = options;
  bounded.max_exact_positions = 0;
  bounded.max_pair_states = std::min(options.max_pair_states, most_pair_states);
  return BoundsCertifier(model, overrides, bounded).run();
}

bool BoundsCertificate::any(Verdict verdict) const {
  return std::any_of(claims.begin(), claims.end(), [&](const CertifiedClaim& c) { return c.verdict == verdict; });
}

}  // namespace maximin
