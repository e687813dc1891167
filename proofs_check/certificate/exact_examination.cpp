#include <maximin/proofs_check/certificate/exact_examination.hpp>

#include <algorithm>
#include <limits>

#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

double rounded(const Rational& x) {
  return static_cast<double>(x);
}

LipschitzConstant<double> rounded(const LipschitzConstant<Rational>& c) {
  return {rounded(c.value), c.infinite, c.s1, c.s2, c.action, c.target};
}

ModelConstants<double> rounded(const ModelConstants<Rational>& c) {
  return {rounded(c.l_r),          rounded(c.l_p),   rounded(c.k_tv), rounded(c.r_min),
          rounded(c.r_max_signed), rounded(c.r_max), rounded(c.span)};
}

Check check_of(const CertifiedClaim& claim) {
  Check check;
  check.verdict = claim.verdict;
  if (claim.verdict == Verdict::undetermined) return check;
  check.left = rounded(claim.left);
  check.right = rounded(claim.right);
  check.least_right = check.right;
  check.n = claim.n;
  check.instances = 1;
  check.place.action = claim.action;
  if (!claim.states.empty()) check.place.state = claim.states.front();
  if (claim.states.size() > 1) check.place.other = claim.states.back();
  return check;
}

void set_model(Examination& e, const Model<Rational>& model) {
  e.states = model.mdp.states();
  e.actions = model.mdp.actions();
  e.discount = rounded(model.mdp.discount());
}

/// All claims that were asked for have the verdict.
Examination all(Verdict verdict, const Model<Rational>& model, const ExaminationOptions& options) {
  Examination e;
  set_model(e, model);
  for (const Claim& c : claims()) {
    if (options.wants(c.id)) e.check(c.id).verdict = verdict;
  }
  return e;
}

template <class Any>
Examination what_both_say(const Any& c) {
  Examination e;
  set_model(e, c.model);
  e.eps = e.radius = rounded(*c.model.geometry.eps);
  e.constants = rounded(c.constants);
  e.lipschitz_of_q_star = rounded(c.l_star.value);
  e.trivial = bounds::trivial(e.discount, e.constants.span);
  e.iterations = static_cast<long>(c.rounds.size());
  e.pairs = static_cast<long>(c.pairs.size());
  e.largest_ball = c.largest_ball;
  e.pessimism_changes_action = c.pessimism_changes_action;
  e.gap = std::numeric_limits<double>::quiet_NaN();
  if (c.belief_game) e.belief_positions = static_cast<long>(c.belief_game->positions.size());
  for (const CertifiedClaim& claim : c.claims) e.check(claim.id) = check_of(claim);
  return e;
}

}  // namespace

Examination examination_of(const Certificate& c) {
  Examination e = what_both_say(c);
  e.attack_changes_action = std::any_of(c.pairs.begin(), c.pairs.end(), [](const CertifiedPair& p) {
    for (std::size_t s = 0; s < p.policies.policy.size(); ++s) {
      if (p.policies.policy[static_cast<std::size_t>(p.policies.attack[s])] != p.policies.policy[s]) return true;
    }
    return false;
  });
  if (c.boxes) e.enclosed_from = e.iterations;
  if (c.limit) {
    e.fate = c.limit->period == 1 ? Fate::settled : Fate::cycles;
    e.period = c.limit->period;
    e.periodic_from = e.iterations;
    e.gap = rounded(c.limit->gap);
  }
  return e;
}

Examination examination_of(const BoundsCertificate& c) {
  Examination e = what_both_say(c);
  e.attack_changes_action = c.attack_changes_action;
  if (c.limit) e.enclosed_from = e.iterations;
  return e;
}

CertifyOptions certify_options(const ExaminationOptions& options) {
  CertifyOptions exact;
  exact.reading = options.reading;
  exact.tie = options.tie;
  exact.only = options.only;
  if (options.by_bounds && exact.only) exact.only->erase(ClaimId::lemma_3);
  exact.max_rounds = std::min(options.max_iterations, exact.max_rounds);
  exact.max_period = options.max_period;
  exact.max_positions = options.max_belief_positions;
  exact.stop = options.stop;
  exact.progress = options.progress;
  return exact;
}

Examination examine_exactly(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                            const ExaminationOptions& options,
                            const std::function<void(const std::string&)>& certified) {
  const CertifyOptions exact = certify_options(options);
  try {
    const auto told = [&](const auto& certificate) {
      if (certified) certified(certificate_json(certificate));
      return examination_of(certificate);
    };
    return options.by_bounds ? told(certify_by_bounds(model, overrides, exact))
                             : told(certify(model, overrides, exact));
  } catch (const AssumptionFails& failed) {
    Examination e = all(Verdict::assumption_fails, model, options);
    e.failed_assumption = failed.what();
    return e;
  } catch (const BudgetExhausted&) {
    return all(Verdict::undetermined, model, options);
  }
}

}  // namespace maximin
