#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include <maximin/apps/common/model_options.hpp>
#include <maximin/proofs_check/certificate/bounds_certificate.hpp>

namespace maximin::verify_bound {

/// What `verify_bound certify` can be asked.
struct CertifyCommand {
  apps::ModelOptions model;
  std::string arith = "exact", reading = "corrected", tie = "lowest";
  std::vector<std::string> claims;
  CertifyOptions budgets;
  std::string output;
  bool force = false, json = false, quiet = false;
};

void declare(CLI::App& command, CertifyCommand& options);

/// Proves the claims on the model, writes the certificate, prints the verdicts. Returns the exit code.
int run_certify_command(const CertifyCommand& options);

}  // namespace maximin::verify_bound
