#include <maximin/proofs_check/campaign_summary.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <boost/math/distributions/binomial.hpp>

namespace maximin {
namespace {

using Json = nlohmann::ordered_json;

/// The value below which a share q of the sorted sample lies (nearest rank).
double quantile(const std::vector<double>& sorted, double q) {
  if (sorted.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(sorted.size())));
  return sorted[std::min(sorted.size() - 1, rank == 0 ? 0 : rank - 1)];
}

void count(const Check& check, ClaimSummary& into) {
  into.instances += check.instances;
  into.holds += check.verdict == Verdict::holds;
  into.violated += check.verdict == Verdict::violated;
  into.undetermined += check.verdict == Verdict::undetermined;
  into.assumption_fails += check.verdict == Verdict::assumption_fails;
}

/// Tightness of one claim over all records.
void rank(const std::vector<TrialRecord>& records, ClaimId id, ClaimSummary& into) {
  std::vector<double> ratios;
  for (const TrialRecord& record : records) {
    const Check& check = record.found.check(id);
    count(check, into);
    if (check.verdict != Verdict::holds && check.verdict != Verdict::violated) continue;
    if (check.verdict == Verdict::violated && into.first_violation < 0) into.first_violation = record.trial;
    into.informative += record.found.informative(id);
    const double ratio = check.tightness();
    if (into.max_trial < 0 || ratio > into.max) {
      into.max = ratio;
      into.max_trial = record.trial;
      into.tightest = check;
    }
    ratios.push_back(ratio);
  }
  std::sort(ratios.begin(), ratios.end());
  into.median = quantile(ratios, 0.5);
  into.p99 = quantile(ratios, 0.99);
}

void count(const TrialRecord& record, CampaignSummary& s) {
  const Examination& e = record.found;
  ++s.trials;
  ++s.families[record.family];
  if (e.any(Verdict::violated)) {
    if (s.violations++ == 0) s.first_violation = record.trial;
  }
  s.undetermined += e.any(Verdict::undetermined);
  s.decided += !e.any(Verdict::undetermined) && !e.any(Verdict::assumption_fails);
  s.assumption_failures += !e.failed_assumption.empty();
  const auto& all = claims();
  s.any_informative +=
      std::any_of(all.begin(), all.end(), [&](const Claim& c) { return c.is_bound && e.informative(c.id); });
  s.settled += e.fate == Fate::settled;
  s.cycles += e.fate == Fate::cycles;
  s.fate_undetermined += e.fate == Fate::undetermined;
  if (e.fate == Fate::cycles) ++s.periods[e.period];
  s.balls_of_several += e.largest_ball > 1;
  s.attack_changes_action += e.attack_changes_action;
  s.pessimism_changes_action += e.pessimism_changes_action;
}

Json number(double x) {
  return std::isfinite(x) ? Json(x) : Json(nullptr);
}

Json to_json(const Claim& claim, const ClaimSummary& s) {
  Json json{{"name", claim.name},
            {"reference", claim.reference},
            {"statement", claim.statement},
            {"checked", s.checked()},
            {"instances", s.instances},
            {"holds", s.holds},
            {"violated", s.violated},
            {"first_violation", s.first_violation},
            {"undetermined", s.undetermined},
            {"assumption_fails", s.assumption_fails}};
  if (claim.is_bound) json["informative"] = s.informative;
  json["tightness"] = {{"median", number(s.median)}, {"p99", number(s.p99)}, {"max", number(s.max)}};
  json["tightest"] = {{"trial", s.max_trial},
                      {"n", s.tightest.n},
                      {"left", number(s.tightest.left)},
                      {"right", number(s.tightest.right)},
                      {"slack", number(s.tightest.slack)}};
  return json;
}

}  // namespace

double CampaignSummary::violation_upper_limit() const {
  const long seen = std::max(decided, violations);  // a violation decides a model, whatever else is open
  if (seen == 0 || violations >= seen) return 1;
  return boost::math::binomial_distribution<>::find_upper_bound_on_p(static_cast<double>(seen),
                                                                     static_cast<double>(violations), 0.05);
}

bool CampaignSummary::some_claim_never_decided() const {
  return std::any_of(claims.begin(), claims.end(),
                     [](const ClaimSummary& c) { return c.checked() == 0 && c.undetermined > 0; });
}

CampaignSummary summarise(const std::vector<TrialRecord>& records) {
  CampaignSummary summary;
  for (const TrialRecord& record : records) count(record, summary);
  for (const Claim& c : claims()) rank(records, c.id, summary.claims[static_cast<std::size_t>(c.id)]);
  return summary;
}

Json to_json(const CampaignSummary& s) {
  Json periods = Json::object();
  for (const auto& [period, trials] : s.periods) periods[std::to_string(period)] = trials;
  Json json{
      {"trials", s.trials},
      {"violations", s.violations},
      {"first_violation", s.first_violation},
      {"violation_upper_limit_95", s.violation_upper_limit()},
      {"undetermined", s.undetermined},
      {"decided", s.decided},
      {"assumption_failures", s.assumption_failures},
      {"any_bound_informative", s.any_informative},
      {"vacuous", s.vacuous()},
      {"fates",
       {{"settled", s.settled}, {"cycles", s.cycles}, {"undetermined", s.fate_undetermined}, {"periods", periods}}},
      {"regimes",
       {{"ball_of_more_than_one_state", s.balls_of_several},
        {"attack_changes_the_action", s.attack_changes_action},
        {"pessimism_changes_the_action", s.pessimism_changes_action}}},
      {"families", s.families}};
  Json& all = json["claims"] = Json::array();
  for (const Claim& c : claims()) {
    const ClaimSummary& claim_summary = s.claims[static_cast<std::size_t>(c.id)];
    if (claim_summary.checked() + claim_summary.undetermined + claim_summary.assumption_fails > 0) {
      all.push_back(to_json(c, claim_summary));
    }
  }
  return json;
}

}  // namespace maximin
