#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include <maximin/proofs_check/checker/checker.hpp>

namespace maximin::testing {

/// The certificates of this folder, by name.
inline const std::map<std::string, nlohmann::json>& sample_certificates() {
  static const auto all = [] {
    std::map<std::string, nlohmann::json> found;
    for (const auto& entry : std::filesystem::directory_iterator(MAXIMIN_CERTIFICATES)) {
      if (entry.path().extension() != ".json") continue;
      std::ifstream file(entry.path());
      found[entry.path().stem().string()] = nlohmann::json::parse(file);
    }
    return found;
  }();
  return all;
}

/// Why the checker refuses a text; empty where it does not.
inline std::string refusal(const std::string& text, const checker::Limits& limits = {}) {
  try {
    checker::check(text, limits);
    return {};
  } catch (const checker::Refused& refused) {
    return refused.what();
  }
}

}  // namespace maximin::testing
