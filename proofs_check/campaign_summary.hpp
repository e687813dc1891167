#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/proofs_check/claims.hpp>
#include <maximin/proofs_check/trial_record.hpp>

namespace maximin {

/// What many trials say of one claim.
struct ClaimSummary {
  long instances = 0;  ///< inequalities looked at, all rounds and trials
  long holds = 0, violated = 0, undetermined = 0, assumption_fails = 0;  ///< trials
  long first_violation = -1;                                             ///< the first trial that violates it
  long informative = 0;                 ///< trials on which the bound beats gamma span(R)/(1-gamma)
  double median = 0, p99 = 0, max = 0;  ///< of Check::tightness(), over the trials checked
  long max_trial = -1;                  ///< the trial of `max`, for --replay
  Check tightest;                       ///< that instance

  long checked() const { return holds + violated; }
};

/// What a campaign came to: a function of its records alone, whatever the order in time they were made in.
struct CampaignSummary {
  long trials = 0;
  long violations = 0;           ///< trials with at least one violated claim
  long first_violation = -1;     ///< the first such trial
  long undetermined = 0;         ///< trials with at least one undetermined claim
  long decided = 0;              ///< trials on which every claim asked for was decided
  long assumption_failures = 0;  ///< trials on which an assumption failed
  long any_informative = 0;      ///< trials with at least one informative bound
  std::array<ClaimSummary, claim_count> claims;
  long settled = 0, cycles = 0, fate_undetermined = 0;
  std::map<long, long> periods;    ///< period of a cycle -> trials
  long balls_of_several = 0;       ///< trials whose largest ball has more than one state
  long attack_changes_action = 0;  ///< trials
  long pessimism_changes_action = 0;
  std::map<std::string, long> families;

  /// 95 percent upper limit on the share of such models that violate a claim (Clopper and Pearson, one-sided; for none
  /// seen it is 1 - 0.05^(1/decided)): of the models that are decided as those of this campaign were.
  double violation_upper_limit() const;
  /// A claim was asked for and decided on no trial.
  bool some_claim_never_decided() const;
  /// No bound said anything on any model: the campaign verifies nothing.
  bool vacuous() const { return any_informative == 0; }
};

/// Summarises the records.
CampaignSummary summarise(const std::vector<TrialRecord>& records);

/// The summary as JSON: the same bytes for the same records.
nlohmann::ordered_json to_json(const CampaignSummary& summary);

}  // namespace maximin
