#include <CLI/CLI.hpp>
#include <string>

#include <maximin/apps/common/program.hpp>
#include <maximin/proofs_check/verdict_text.hpp>

#include "campaign_command.hpp"
#include "certify_command.hpp"
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
  verify_bound --explain                           what lemma-1 to F state, and the symbols

Exit codes: 0 holds, 1 a claim is violated, 2 bad usage or input, 3 undetermined, 4 an assumption of a claim fails)";

constexpr const char* certify_examples =
    R"(The certificate holds everything that a sceptic needs (docs/certificate-format.md); check_certificate verifies it.
Examples:
  verify_bound certify --example one-sided --reading paper -o refuted.json
  verify_bound certify lake.json --metric hops --eps 1 --discount 0.95 -o lake.cert.json)";

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
  return apps::run_program(program, argc, argv, [&]() -> int {
    if (certify_command->parsed()) return verify_bound::run_certify_command(certify);
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
