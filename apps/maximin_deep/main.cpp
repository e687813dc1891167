#include <exception>

#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin_deep/commands.hpp>
#include <maximin/deep/runtime.hpp>

namespace maximin::apps {

namespace {

int run_maximin_deep(int argc, char** argv) {
  CLI::App app("Deep agents and attacks in the continuous Gridworld: train, evaluate, compare, watch.", "maximin_deep");
  app.set_version_flag("--version", "maximin_deep " MAXIMIN_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  maximin_deep watch results/gridworld/agents/bp-dqn-eps0.5-seed1.agent --attack pgd -o episode.svg\n"
      "                                                  an episode that moves, for a browser\n"
      "  maximin_deep evaluate results/gridworld/agents/bp-dqn-eps0.5-seed1.agent --attack best-response\n"
      "  maximin_deep train bp-dqn --eps 0.5             some minutes; --quick: two\n"
      "  maximin_deep table gridworld --quick            every agent under every attack, in small\n"
      "maximin_deep COMMAND --help tells the options of a command.\n"
      "Exit codes: 0 done, 2 bad usage or input, 74 standard output cannot be written, 130 interrupted (the same "
      "command\n"
      "goes on).");
  Task task;
  add_train(app, task);
  add_evaluate(app, task);
  add_table(app, task);
  add_watch(app, task);
  return run_program(app, argc, argv, [&task] { return task(); });
}

}  // namespace

}  // namespace maximin::apps

/// maximin_deep: what needs LibTorch.
int main(int argc, char** argv) {
  maximin::deep::prepare_runtime();
  try {
    return maximin::apps::run_maximin_deep(argc, argv);
  } catch (const std::exception& error) {
    maximin::apps::complain("maximin_deep", error.what());
    return maximin::apps::ExitCode::internal_error;
  }
}
