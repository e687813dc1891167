#include <gmpxx.h>
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include <maximin/proofs_check/checker/checker.hpp>

namespace {

using maximin::checker::ClaimVerdict;
using maximin::checker::Refused;
using maximin::checker::Report;

enum Exit { all_hold = 0, violated = 1, refused = 2, undetermined = 3, internal_error = 70, output_error = 74 };

constexpr const char* notes = R"(Examples:
  check_certificate lake.json              each claim with its verdict and its sides where it is tightest
  check_certificate --json a.json b.json   the same for programs, sides exact
  check_certificate - < lake.cert.json

Exit codes: 0 all claims hold, 1 a claim is violated, and that is proved, 3 a claim is undetermined,
2 bad usage, or not a certificate: one line says what is false in it)";

/// The worst comes first: a file that is no certificate, a violation, a claim that nothing is said of.
Exit worse(Exit x, Exit y) {
  for (const Exit code : {refused, violated, undetermined}) {
    if (x == code || y == code) return code;
  }
  return all_hold;
}

Exit outcome(const Report& report) {
  return report.worst() == "violated" ? violated : report.worst() == "undetermined" ? undetermined : all_hold;
}

Report check_file(const std::string& name) {
  if (name == "-") return maximin::checker::check(std::cin);
  std::ifstream file(name, std::ios::binary);
  if (!file || file.peek() == std::ifstream::traits_type::eof()) {
    throw Refused("cannot be read or is empty, expected a certificate");
  }
  return maximin::checker::check(file);
}

/// A side for a table: exact where that is short, else six digits, or its first ones where no double is as large.
std::string short_text(const std::string& number) {
  if (number.size() <= 12) return number;
  char text[32];
  const double near = mpq_class(number).get_d();
  if (!std::isfinite(near)) return number.substr(0, 7) + "... (" + std::to_string(number.size()) + " characters)";
  std::snprintf(text, sizeof text, "~%.6g", near);
  return text;
}

void print_table(const std::string& name, const Report& report) {
  std::printf("%s: a certificate of %zu states, %zu actions, %zu rounds", name.c_str(), report.states, report.actions,
              report.rounds);
  std::printf(report.period == 0 ? ", no limit\n" : ", limit of period %zu\n", report.period);
  for (const ClaimVerdict& claim : report.claims) {
    std::printf("%-16s  %-12s", claim.claim.c_str(), claim.verdict.c_str());
    if (claim.verdict != "undetermined") {
      std::printf("  %14s %s %s", short_text(claim.left).c_str(), claim.verdict == "holds" ? "<=" : "> ",
                  short_text(claim.right).c_str());
    }
    std::printf("\n");
  }
  for (const std::string& claim : report.left_out) std::printf("%-16s  not in this certificate\n", claim.c_str());
}

nlohmann::ordered_json to_json(const std::string& name, const Report& report) {
  nlohmann::ordered_json claims = nlohmann::ordered_json::array();
  for (const ClaimVerdict& claim : report.claims) {
    nlohmann::ordered_json entry{{"claim", claim.claim}, {"verdict", claim.verdict}};
    if (claim.verdict != "undetermined") {
      entry["left"] = claim.left;
      entry["right"] = claim.right;
    }
    claims.push_back(std::move(entry));
  }
  return {{"file", name}, {"exit_code", outcome(report)}, {"claims", std::move(claims)}, {"left_out", report.left_out}};
}

Exit run(const std::vector<std::string>& files, bool json) {
  Exit code = all_hold;
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const std::string& name : files) {
    try {
      const Report report = check_file(name);
      code = worse(code, outcome(report));
      if (json) {
        all.push_back(to_json(name, report));
      } else {
        print_table(name, report);
      }
    } catch (const Refused& refusal) {
      code = refused;
      std::fflush(stdout);
      std::fprintf(stderr, "check_certificate: %s: %s\n", name.c_str(), refusal.what());
      if (json) all.push_back({{"file", name}, {"exit_code", refused}, {"refused", refusal.what()}});
    }
  }
  if (json) {
    using Handler = nlohmann::ordered_json::error_handler_t;
    std::printf("%s\n", all.dump(1, ' ', false, Handler::replace).c_str());
  }
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0 ? code : output_error;
}

}  // namespace

/// check_certificate: is what a certificate says true?
int main(int argc, char** argv) {
  try {
    CLI::App program("Verifies certificates of verify_bound by substitution, in exact arithmetic.",
                     "check_certificate");
    program.set_version_flag("--version", std::string("check_certificate ") + MAXIMIN_VERSION);
    program.footer(notes);
    std::vector<std::string> files;
    bool json = false;
    program.add_option("CERTIFICATE", files, "certificates to verify; - is standard input")->required();
    program.add_flag("--json", json, "one JSON array for other programs");
    try {
      program.parse(argc, argv);
    } catch (const CLI::Success& asked) {
      return program.exit(asked);
    } catch (const CLI::ParseError& error) {
      std::fprintf(stderr, "check_certificate: %s (see check_certificate --help)\n", error.what());
      return refused;
    }
    const Exit code = run(files, json);
    if (code == output_error) std::fprintf(stderr, "check_certificate: standard output: cannot be written\n");
    return code;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "check_certificate: internal error: %s\n", error.what());
    return internal_error;
  }
}
