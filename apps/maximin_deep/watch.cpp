#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/apps/maximin_deep/attack_options.hpp>
#include <maximin/apps/maximin_deep/commands.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/report/animation.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

struct WatchCommand {
  AttackedAgent options;
  std::uint64_t seed = 1000;
  long episode = 0;
  std::filesystem::path output = "episode.svg";
  std::filesystem::path trace;
  bool force = false;
};

/// No output takes the place of another file of this run.
void expect_files_apart(const WatchCommand& command) {
  namespace fs = std::filesystem;
  const AttackedAgent& o = command.options;
  std::vector<fs::path> files{o.file, o.judge, o.attacker, command.output, command.trace};
  std::erase_if(files, [](const fs::path& file) { return file.empty(); });
  for (const fs::path& output : {command.output, command.trace}) {
    const auto same = [&](const fs::path& file) { return fs::weakly_canonical(file) == fs::weakly_canonical(output); };
    if (!output.empty() && std::count_if(files.begin(), files.end(), same) > 1) {
      throw InputError(output.string() + ": named twice, expected an output of its own");
    }
  }
}

int watch(const WatchCommand& command) {
  expect_options_used(command.options, {command.options.attack});
  expect_files_apart(command);
  if (command.output.extension() != ".svg") {
    throw InputError(fmt::format("--output: {}, expected a name that ends in .svg", command.output.string()));
  }
  // Before the work: an episode may take minutes where an attack has to learn first.
  for (const std::filesystem::path& file : {command.output, command.trace}) {
    const std::filesystem::path folder = file.parent_path();
    if (!folder.empty() && !std::filesystem::is_directory(folder)) {
      throw InputError(
          fmt::format("{}: no such folder, expected one for {}", folder.string(), file.filename().string()));
    }
    if (command.force || file.empty() || !std::filesystem::exists(file)) continue;
    throw InputError(file.string() + ": exists, expected a new file name, or --force to replace it");
  }
  note_if_quick(command.options);
  std::optional<StageProgress> line("watch");
  AttackedAgent options = command.options;
  options.progress = [&](const std::string& at) { line->stage(at); };
  const Match match = prepare_match(options);
  deep::EpisodeTrace trace = deep::trace_episode(*match.agent, *match.attack, ObservationBall(match.eps), command.seed,
                                                 command.episode, match.acting.world);
  trace.agent = match.trained->spec.name();
  trace.attack = command.options.attack;
  trace.training_seed = match.trained->spec.training.seed;
  const Overwrite overwrite = command.force ? Overwrite::replace : Overwrite::refuse;
  write_file(command.output, deep::animated_svg(trace), overwrite);
  if (!command.trace.empty()) deep::write_trace(command.trace, trace);
  line.reset();
  print(fmt::format("{}: {} under {}, eps {:g}, episode {}: {}\n", command.output.string(), trace.agent, trace.attack,
                    match.eps, command.episode, trace.outcome()));
  return ExitCode::success;
}

}  // namespace

void add_watch(CLI::App& app, Task& task) {
  auto command = std::make_shared<WatchCommand>();
  CLI::App* sub = app.add_subcommand("watch", "An episode as a moving picture: truth, what is shown, what is believed");
  sub->add_option("FILE", command->options.file, "Agent file")->required();
  sub->add_option("--attack", command->options.attack, "The attack")
      ->check(one_of(deep::attack_names()))
      ->capture_default_str();
  add_attack_options(*sub, command->options);
  sub->add_option("--seed", command->seed, "Episodes are drawn from (seed, number)")
      ->check(seed_number())
      ->capture_default_str();
  sub->add_option("--episode", command->episode, "Number of the episode")
      ->check(whole_number(0, 100'000))
      ->capture_default_str();
  sub->add_option("-o,--output", command->output, "SVG file, for any browser")->capture_default_str();
  sub->add_option("--trace", command->trace, "Write the steps as JSON too");
  sub->add_flag("--force", command->force, "Replace files that exist");
  sub->footer(
      "Example:\n"
      "  maximin_deep watch runs/bp-dqn-eps0.5-seed1.agent --attack best-response -o episode.svg");
  sub->callback([command, &task] { task = [command] { return watch(*command); }; });
}

}  // namespace maximin::apps
