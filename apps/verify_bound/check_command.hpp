#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace maximin::verify_bound {

/// What `verify_bound check` can be asked.
struct CheckCommand {
  std::vector<std::string> files;
  bool json = false;
};

void declare(CLI::App& command, CheckCommand& options);

/// Verifies certificates, each from its file alone, and prints their verdicts. A file that is no certificate
/// is told in one line on standard error, and the others are verified all the same. Returns the exit code of the worst:
/// no certificate before a violated claim before an undetermined one.
int run_check_command(const CheckCommand& options);

}  // namespace maximin::verify_bound
