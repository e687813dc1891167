#pragma once

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <maximin/proofs_check/examination.hpp>

namespace maximin {

/// One line of a trials file: which model, and what was found.
struct TrialRecord {
  long trial = 0;
  std::string family;  ///< of random models, or the name of the model
  Examination found = {};
  std::optional<double> score = {};  ///< of a search, what it maximises
};

/// The record as JSON with a fixed order of keys. NaN and infinity become null.
nlohmann::ordered_json to_json(const TrialRecord& record);

/// The inverse. Throws nlohmann::json::exception or InputError when something is missing or of the wrong kind.
TrialRecord trial_record_from_json(const nlohmann::ordered_json& json);

std::string_view to_string(Verdict verdict);
std::string_view to_string(Fate fate);
std::string_view to_string(Reading reading);

}  // namespace maximin
