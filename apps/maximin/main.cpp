#include <exception>

#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/commands.hpp>

namespace maximin::apps {

namespace {

int run_maximin(int argc, char** argv) {
  CLI::App app("Pessimism under adversarial state perturbation, computed exactly on finite models.", "maximin");
  app.set_version_flag("--version", "maximin " MAXIMIN_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  maximin belief                                  walk a small grid step by step\n"
      "  maximin solve --example grid --robust           what pessimism and attacks cost\n"
      "  maximin attack FrozenLake.json --agent greedy   who shows what, and what it provokes\n"
      "  maximin convert model.drn -o model.json         any model file to the project's own format\n"
      "maximin COMMAND --help tells the options of a command.\n"
      "Exit codes: 0 done, 2 bad usage or input, 3 a budget ran out, 4 an assumption fails.");
  Task task;
  add_solve(app, task);
  add_attack(app, task);
  add_belief(app, task);
  add_simulate(app, task);
  add_learn(app, task);
  add_convert(app, task);
  add_info(app, task);
  add_examples(app, task);
  add_counterexample(app, task);
  return run_program(app, argc, argv, [&task] { return task(); });
}

}  // namespace

}  // namespace maximin::apps

/// maximin: solves, attacks and walks through finite models, for people (tables) and programs (--json).
int main(int argc, char** argv) {
  try {
    return maximin::apps::run_maximin(argc, argv);
  } catch (const std::exception& error) {
    maximin::apps::complain("maximin", error.what());
    return maximin::apps::ExitCode::internal_error;
  }
}
