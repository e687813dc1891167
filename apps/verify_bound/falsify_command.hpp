#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace maximin::verify_bound {

/// What `verify_bound falsify` can be asked.
struct FalsifyCommand {
  std::vector<std::string> goals;
  std::string reading = "corrected", tie = "lowest", states = "2:6", family = "mixed", directory = ".", trials_out;
  long restarts = 1'000'000, steps = 300, seconds = 60;
  std::uint64_t seed = 1;
  int threads = 0;
  bool resume = false, json = false, quiet = false;
};

void declare(CLI::App& command, FalsifyCommand& options);

/// Searches, prints the tightest model of every goal and writes each to a file. Returns the exit code: 0, or 1 when a
/// claim is violated.
int run_falsify_command(const FalsifyCommand& options);

}  // namespace maximin::verify_bound
