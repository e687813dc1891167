#pragma once

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <maximin/models/small_random_model.hpp>
#include <maximin/proofs_check/campaign.hpp>

namespace maximin {

/// Models of a few states, some of each kind.
inline DrawnModel small_source(Stream& rng) {
  const int size = rng.integer(10, 80);
  Model<double> model = small_random_model(size, rng);
  return {size < 40 ? "smaller" : "larger", std::move(model)};
}

/// The records of a small campaign, of all claims or of some, made one by one.
inline std::vector<TrialRecord> small_records(long trials, std::optional<std::set<ClaimId>> only = {}) {
  Campaign campaign;
  campaign.examination.only = std::move(only);
  std::vector<TrialRecord> records;
  for (long k = 0; k < trials; ++k) records.push_back(run_trial(campaign, draw_trial(campaign, small_source, k), k));
  return records;
}

/// The lines that a trials file would hold.
inline std::vector<std::string> lines_of(const std::vector<TrialRecord>& records) {
  std::vector<std::string> lines;
  for (const TrialRecord& record : records) lines.push_back(to_json(record).dump());
  return lines;
}

}  // namespace maximin
