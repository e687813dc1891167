#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <maximin/models/model_family.hpp>
#include <maximin/proofs_check/campaign.hpp>
#include <maximin/proofs_check/claims.hpp>

#include <maximin/apps/common/model_options.hpp>

namespace maximin::verify_bound {

/// Everything that can be asked of verify_bound.
struct Options {
  // What to check
  std::string reading = "corrected";
  std::vector<std::string> claims;
  std::string arith = "double";
  bool pedantic = false;
  std::string tie = "lowest";
  long max_iterations = 20'000;
  long max_period = 64;
  long max_positions = 20'000;

  // On random models
  long trials = 5000;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: one per core
  std::string family = "mixed";
  std::string states, actions, gamma;  ///< "LOW:HIGH" or one number; empty: as the family has it
  std::optional<double> l_r, l_p;
  std::optional<int> dimension;
  std::optional<int> successors;
  std::optional<long> replay;

  // On a model file; its eps and norm restrict random models too
  apps::ModelOptions model;

  // Output
  bool json = false;
  std::string trials_out, report, save_model;
  std::string violation_dir = ".";
  std::string certificates;
  bool resume = false;
  bool explain = false;
  bool quiet = false;
};

/// Whether rational numbers were asked for.
inline bool is_exact(const Options& options) {
  return options.arith != "double";
}

/// Declares the options on the program.
void declare(CLI::App& program, Options& options);

/// Refuses options that would be ignored: those of model files on random models, and the other way round. Throws
/// InputError naming both.
void check_combination(const CLI::App& program, const Options& options);

/// The claims of --claims; nothing for all. Throws InputError on a name that is none.
std::optional<std::set<ClaimId>> claims_named(const std::vector<std::string>& names);

/// What to examine on each model. Throws InputError on an unknown claim.
ExaminationOptions examination_options(const Options& options);

/// The range of --states. Throws InputError where it is none.
std::optional<Range<State>> state_range(const std::string& text);

/// The restrictions on the random family. Throws InputError on a range that is not one.
FamilyOptions family_options(const Options& options);

/// Everything that the results depend on, for the header of the trials file and the summary. Never the number of
/// threads.
nlohmann::ordered_json configuration(const Options& options);

/// The same and how the results are told, for those who read them.
nlohmann::ordered_json told_configuration(const Options& options);

/// The options that make the same models again, for a command line that replays a trial.
std::string replay_options(const Options& options);

}  // namespace maximin::verify_bound
