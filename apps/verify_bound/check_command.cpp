#include "check_command.hpp"

#include <fstream>
#include <iostream>
#include <set>

#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/proofs_check/checker/checker.hpp>

#include "exact_text.hpp"
#include "outcome.hpp"

namespace maximin::verify_bound {
namespace {

checker::Report checked(const std::string& file) {
  if (file == "-") return checker::check(std::cin);
  std::ifstream in(file, std::ios::binary);
  if (!in) throw checker::Refused("cannot be read, expected a certificate");
  return checker::check(in);
}

Outcome outcome_of(const checker::Report& report) {
  if (report.worst() == "violated") return Outcome::violated;
  return report.worst() == "undetermined" ? Outcome::undetermined : Outcome::holds;
}

/// An exact number; in six digits where it is long.
std::string shown(const std::string& number) {
  constexpr std::size_t longest = 24;
  return number.size() <= longest ? number : "~" + six_digits(Rational(number));
}

std::string text(const std::string& file, const checker::Report& report) {
  apps::Table table;
  for (const char* title : {"claim", "verdict", "left", "right"}) table.column(title, apps::Align::left);
  for (const auto& c : report.claims) {
    table.row({c.claim, c.verdict, shown(c.left), c.right.empty() ? "" : "<= " + shown(c.right)});
  }
  const Outcome outcome = outcome_of(report);
  const char* verdict = outcome == Outcome::violated       ? "a claim is violated, and that is proved"
                        : outcome == Outcome::undetermined ? "what holds is proved; a claim is open"
                                                           : "all that it claims is proved";
  const std::string left_out =
      report.left_out.empty() ? "" : fmt::format("not in this certificate: {}\n", fmt::join(report.left_out, ", "));
  return fmt::format("{}: a valid certificate; {}\n\n{}{}\n", apps::printable(file), verdict, table.text(), left_out);
}

nlohmann::ordered_json report_json(const std::string& file, const checker::Report& report) {
  nlohmann::ordered_json json{{"file", file}, {"exit_code", exit_code(outcome_of(report))}};
  for (const auto& c : report.claims) {
    auto& entry = json["claims"][c.claim] = {{"verdict", c.verdict}};
    if (c.left.empty()) continue;
    entry["left"] = c.left;
    entry["right"] = c.right;
  }
  json["left_out"] = report.left_out;
  return json;
}

}  // namespace

void declare(CLI::App& command, CheckCommand& o) {
  command.add_option("CERTIFICATE", o.files, "certificates written by verify_bound certify; - is standard\ninput")
      ->required()
      ->type_name("FILE");
  command.add_flag("--json", o.json, "one JSON object on standard output, nothing else");
}

int run_check_command(const CheckCommand& options) {
  nlohmann::ordered_json all{{"format", "maximin-check"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}};
  std::set<int> codes;
  for (const std::string& file : options.files) {
    try {
      const checker::Report report = checked(file);
      codes.insert(exit_code(outcome_of(report)));
      if (options.json) {
        all["certificates"].push_back(report_json(file, report));
      } else {
        apps::print(text(file, report));
      }
    } catch (const checker::Refused& refused) {
      codes.insert(apps::ExitCode::bad_input);
      apps::complain("verify_bound check", fmt::format("{}: {}", file, refused.what()));
      all["certificates"].push_back(
          {{"file", file}, {"exit_code", apps::ExitCode::bad_input}, {"refused", refused.what()}});
    }
  }
  if (options.json) apps::print(apps::json_text(all));
  for (const int worst : {apps::ExitCode::bad_input, apps::ExitCode::violated, apps::ExitCode::undetermined}) {
    if (codes.contains(worst)) return worst;
  }
  return apps::ExitCode::success;
}

}  // namespace maximin::verify_bound
