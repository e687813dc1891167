#include <CLI/CLI.hpp>
#include <string>

#include <maximin/apps/common/program.hpp>
#include <maximin/proofs_check/verdict_text.hpp>
#include <maximin/theory/error.hpp>

#include "campaign_command.hpp"
#include "certify_command.hpp"
#include "check_command.hpp"
#include "falsify_command.hpp"
#include "model_command.hpp"
#include "options.hpp"

namespace {

constexpr const char* examples = R"(Examples:
  verify_bound                                     5000 random models, a progress bar, a verdict
  verify_bound --report bound.html                 the same, drawn
  verify_bound --trials 100000 --seed 7 --trials-out t.jsonl --resume
                                                   a long run that survives a kill
  verify_bound --family informative --gamma 0.5 --eps 0.1
  verify_bound --seed 1 --replay 17                one trial of a campaign, in full
  verify_bound lake.json --metric hops --eps 1 --discount 0.95
  verify_bound --example one-sided --reading paper Theorem 1 as printed fails
  verify_bound --exact --trials 200 --states 5:60  every verdict proved, in rational numbers
  verify_bound --explain                           what lemma-1 to F state, and the symbols

Exit codes: 0 holds, 1 a claim is violated, 2 bad usage or input, 3 undetermined, 4 an assumption of a claim fails)";

constexpr const char* certify_examples =
    R"(The certificate holds everything that a sceptic needs (docs/certificate-format.md); verify_bound check verifies it.
Examples:
  verify_bound certify --example one-sided --reading paper -o refuted.json
  verify_bound certify lake.json --metric hops --eps 1 --discount 0.95 -o lake.cert.json)";

constexpr const char* check_examples =
    R"(The checker shares no code with certify. Exit codes: 0 all that is claimed is proved, 1 a claim is violated and that is
proved, 2 not a certificate (one line says where), 3 a claim is open; of several the worst, in the order 2, 1, 3, 0. An
independent one in plain Python: proofs_check/check_certificate.py.
Examples:
  verify_bound check lake.cert.json
  verify_bound certify --example cycling -o - | verify_bound check -
  verify_bound check *.cert.json --json)";

constexpr const char* falsify_examples =
    R"(Random starts, hill climbing, shrinking; the best model of each goal is tried on the others too. Exit codes: 0 no claim
was refuted, 1 one was, 3 the search ended before every goal had a model.
Examples:
  verify_bound falsify                                   a minute for all goals: how tight is each bound?
  verify_bound falsify --goal theorem-1 --reading paper  the printed theorem falls in seconds
  verify_bound falsify --goal settling,sharper-belief --seconds 30
  verify_bound falsify --goal D --seconds 3600 --trials-out night --resume)";

/// An option of the program itself would be ignored by a command.
void refuse_options_before_a_command(const CLI::App& program) {
  if (program.get_subcommands().empty()) return;
  const std::string command = program.get_subcommands().front()->get_name();
  for (const CLI::Option* option : program.get_options()) {
    if (option->count() == 0) continue;
    throw maximin::InputError(option->get_name() + ": has no effect before " + command + ", expected it behind " +
                              command + ", if at all");
  }
}

int run(int argc, char** argv) {
  using namespace maximin;
  CLI::App program(
      "Checks what pessimism costs: every bound of the theory, on random Lipschitz MDPs or on a model of yours.",
      "verify_bound");
  program.set_version_flag("--version", std::string("verify_bound ") + MAXIMIN_VERSION);
  program.footer(examples);
  verify_bound::Options options;
  verify_bound::declare(program, options);
  verify_bound::CertifyCommand certify;
  CLI::App* certify_command = program.add_subcommand("certify", "prove the claims on one model, in exact arithmetic");
  certify_command->footer(certify_examples);
  verify_bound::declare(*certify_command, certify);
  verify_bound::CheckCommand check;
  CLI::App* check_command = program.add_subcommand("check", "verify certificates by substitution alone");
  check_command->footer(check_examples);
  verify_bound::declare(*check_command, check);
  verify_bound::FalsifyCommand falsify;
  CLI::App* falsify_command = program.add_subcommand("falsify", "search for models that break a claim, or nearly so");
  falsify_command->footer(falsify_examples);
  verify_bound::declare(*falsify_command, falsify);
  return apps::run_program(program, argc, argv, [&]() -> int {
    refuse_options_before_a_command(program);
    if (certify_command->parsed()) return verify_bound::run_certify_command(certify);
    if (check_command->parsed()) return verify_bound::run_check_command(check);
    if (falsify_command->parsed()) return verify_bound::run_falsify_command(falsify);
    if (options.explain) {
      apps::print(claims_text());
      return apps::ExitCode::success;
    }
    verify_bound::check_combination(program, options);
    if (options.model.given()) return verify_bound::run_model_command(options);
    if (options.replay) return verify_bound::run_replay_command(options);
    return verify_bound::run_campaign_command(options);
  });
}

}  // namespace

/// verify_bound: does the bound hold, on which models is it informative, how tight is it?
int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    maximin::apps::complain("verify_bound", error.what());
    return maximin::apps::ExitCode::internal_error;
  }
}
