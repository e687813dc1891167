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

/// Verifies certificates, each from its file alone, and prints their verdicts. Returns the exit code: that of the
/// worst, a violated claim before an undetermined one. Throws InputError at the first file that is no certificate.
int run_check_command(const CheckCommand& options);

}  // namespace maximin::verify_bound
