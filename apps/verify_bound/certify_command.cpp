#include "certify_command.hpp"

#include <filesystem>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/proofs_check/trial_record.hpp>

#include "exact_text.hpp"
#include "options.hpp"
#include "outcome.hpp"
#include "shared_options.hpp"

namespace maximin::verify_bound {
namespace {

/// x in six digits, and exactly where that is as short.
std::string shown(const Rational& x) {
  const std::string exact = x.str();
  const std::string rounded = six_digits(x);
  return exact == rounded || exact.size() > 14 ? rounded : fmt::format("{} = {}", rounded, exact);
}

std::string limit_text(const Certificate& c) {
  const auto rounds = c.rounds.size();
  if (c.boxes) {
    return fmt::format("Q_n: enclosed from n = {} on{}", rounds,
                       c.ties_open ? ": choices tie in the limit but for differences that vanish" : "");
  }
  if (!c.limit) return fmt::format("Q_n: undetermined after {} exact rounds (--max-rounds, --max-period)", rounds);
  const std::string ties = c.limit->all_attained() ? "" : "; choices tie on it that lead to the same backups";
  return c.limit->period == 1
             ? fmt::format("Q_n: settles, proved from n = {} on{}", rounds, ties)
             : fmt::format("Q_n: cycles with period {}, proved from n = {} on{}", c.limit->period, rounds, ties);
}

std::string limit_text(const BoundsCertificate& c) {
  return c.limit ? fmt::format("Q_n: enclosed, from n = {} on for ever", c.rounds.size())
                 : fmt::format("Q_n: enclosed for {} rounds only (--max-rounds)", c.rounds.size());
}

std::string verdicts_text(const std::vector<CertifiedClaim>& claims) {
  apps::Table table;
  table.column("claim", apps::Align::left).column("", apps::Align::left).column("verdict", apps::Align::left);
  table.column("left", apps::Align::left).column("right", apps::Align::left);
  for (const CertifiedClaim& v : claims) {
    const Claim& about = claim(v.id);
    if (v.verdict == Verdict::undetermined) {
      table.row({std::string(about.name), std::string(about.title), "undetermined", "", ""});
    } else {
      table.row({std::string(about.name), std::string(about.title), std::string(to_string(v.verdict)), shown(v.left),
                 "<= " + shown(v.right)});
    }
  }
  return table.text();
}

template <class Any>
Outcome outcome_of(const Any& c) {
  if (c.any(Verdict::violated)) return Outcome::violated;
  return c.any(Verdict::undetermined) ? Outcome::undetermined : Outcome::holds;
}

long period_of(const Certificate& c) {
  return c.limit ? c.limit->period : 0;
}

/// A period is not known by bounds.
long period_of(const BoundsCertificate&) {
  return 0;
}

std::string conclusion(Outcome outcome) {
  switch (outcome) {
    case Outcome::violated:
      return "VIOLATED, and that is proved: a claim above fails on this model.\n";
    case Outcome::undetermined:
      return "UNDETERMINED: what holds above is proved; a claim is open.\n";
    default:
      return "HOLDS, proved in exact arithmetic for this model.\n";
  }
}

template <class Any>
nlohmann::ordered_json summary_json(const CertifyCommand& options, const Any& c, Outcome outcome) {
  nlohmann::ordered_json json{{"format", "maximin-certify"}, {"version", 1}, {"maximin", MAXIMIN_VERSION}};
  json["certificate"] = options.output;
  json["rounds"] = c.rounds.size();
  json["arith"] = options.arith;
  json["period"] = period_of(c) > 0 ? nlohmann::ordered_json(period_of(c)) : nlohmann::ordered_json(nullptr);
  for (const CertifiedClaim& v : c.claims) {
    auto& entry = json["claims"][std::string(claim(v.id).name)];
    entry["verdict"] = to_string(v.verdict);
    if (v.verdict == Verdict::undetermined) continue;
    entry["left"] = v.left.str();
    entry["right"] = v.right.str();
  }
  json["exit_code"] = exit_code(outcome);
  return json;
}

/// Writes the certificate and prints the verdicts. Returns the exit code.
template <class Any>
int tell(const CertifyCommand& options, const Any& certificate) {
  const Outcome outcome = outcome_of(certificate);
  if (options.output == "-") {
    apps::print(certificate_json(certificate));
    apps::note(conclusion(outcome));
    return exit_code(outcome);
  }
  write_file(options.output, certificate_json(certificate), options.force ? Overwrite::replace : Overwrite::refuse);
  if (options.json) {
    apps::print(apps::json_text(summary_json(options, certificate, outcome)));
  } else {
    const auto& model = certificate.model;
    apps::print(fmt::format("{}: {} states, {} actions; certificate in {}\n{}\n\n{}\n{}",
                            apps::printable(apps::title(model.name, options.model)), model.mdp.states(),
                            model.mdp.actions(), options.output, limit_text(certificate),
                            verdicts_text(certificate.claims), conclusion(outcome)));
  }
  return exit_code(outcome);
}

CertifyOptions certify_options(const CertifyCommand& options) {
  CertifyOptions asked = options.budgets;
  asked.reading = reading_named(options.reading);
  asked.tie = tie_named(options.tie);
  asked.only = claims_named(options.claims);
  asked.stop = &apps::stop_on_interrupt();
  return asked;
}

void refuse_output(const CertifyCommand& options) {
  if (options.output == "-") {
    if (options.json) throw InputError("--json: standard output takes the certificate (-o -), expected a file");
  } else if (!options.force && std::filesystem::exists(options.output)) {
    throw InputError(fmt::format("--output: {} exists, expected a new name or --force", options.output));
  }
}

}  // namespace

void declare(CLI::App& command, CertifyCommand& o) {
  apps::declare(command, o.model);
  const std::string group = "Proof";
  command
      .add_option(
          "-o,--output", o.output,
          "write the certificate to this file; - is standard output, and\nthe verdict then a note on standard error")
      ->required()
      ->type_name("FILE")
      ->group(group);
  command.add_flag("--force", o.force, "replace the file if it exists")->group(group);
  command
      .add_option("--arith", o.arith,
                  "exact, rational numbers (the default); or certified, bounds in\n"
                  "their place: for thousands of states; never says violated,\n"
                  "leaves open what holds with nothing to spare, leaves out\n"
                  "lemma-3, and lemma-1 too above 1,000 states")
      ->check(apps::one_of({"exact", "certified"}))
      ->type_name("WORD")
      ->group(group);
  add_reading(command, o.reading)->group(group);
  add_tie(command, o.tie)->group(group);
  command.add_option("--claims", o.claims, "claims to prove, separated by commas (default: all)")
      ->delimiter(',')
      ->type_name("LIST")
      ->group(group);
  const auto budget = [&](const char* name, long& value, long most, const char* description) {
    command.add_option(name, value, fmt::format("{} (default: {})", description, value))
        ->check(apps::whole_number(1, most))
        ->type_name("N")
        ->group(group);
  };
  budget("--max-rounds", o.budgets.max_rounds, 10'000'000, "rounds before the limit is undetermined");
  budget("--max-period", o.budgets.max_period, 10'000, "longest cycle that is looked for");
  budget("--max-positions", o.budgets.max_positions, 10'000'000,
         "(state, belief) pairs of claim F that are listed; others count\nfor the least value there is");
  command.add_flag("--json", o.json, "one JSON object on standard output, nothing else")->group(group);
  command.add_flag("--quiet", o.quiet, "no progress line")->group(group);
}

int run_certify_command(const CertifyCommand& options) {
  CertifyOptions asked = certify_options(options);
  refuse_output(options);
  const Model<Rational> model = apps::load_exactly(options.model);
  const auto overrides = apps::exact_overrides(options.model);
  try {
    std::optional<apps::StageProgress> progress(std::in_place, "certify", options.quiet || options.json);
    asked.progress = [&progress](const char* stage, long n) { progress->stage(stage, n); };
    const auto told = [&](const auto& certificate) {
      progress.reset();
      return tell(options, certificate);
    };
    return options.arith == "certified" ? told(certify_by_bounds(model, overrides, asked))
                                        : told(certify(model, overrides, asked));
  } catch (const Interrupted&) {
    apps::complain("verify_bound certify", "interrupted; nothing was written");
    return apps::ExitCode::interrupted;
  } catch (const BudgetExhausted& too_large) {
    if (options.arith == "certified") throw;
    throw BudgetExhausted(fmt::format("{}; --arith certified takes larger models", too_large.what()));
  }
}

}  // namespace maximin::verify_bound
