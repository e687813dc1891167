#include <algorithm>
#include <atomic>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin_deep/commands.hpp>
#include <maximin/apps/maximin_deep/device.hpp>
#include <maximin/apps/maximin_deep/workers.hpp>
#include <maximin/deep/report/json_fields.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

struct TrainCommand {
  std::vector<std::string> kinds;
  double eps = 0.1;
  std::uint64_t seed = 1;
  int seeds = 1;
  std::filesystem::path folder = "runs";
  std::filesystem::path config;
  std::string device = "cpu";
  int jobs = 1;
  std::vector<std::string> given;  ///< fields of a specification that the command line says itself
  bool quick = false, print_config = false, json = false;
  long frames = 0;

  deep::Effort effort() const { return {quick, frames}; }
};

/// What is asked for.
std::vector<deep::AgentSpec> planned(const TrainCommand& command) {
  std::vector<deep::AgentSpec> specs;
  std::set<std::string> names;
  const auto add = [&](const deep::AgentSpec& spec) {
    if (!names.insert(spec.name()).second) {
      throw InputError(spec.name() +
                       ": asked for twice, expected trainings of different names; does --config set the kind "
                       "or the seed of all?");
    }
    specs.push_back(spec);
  };
  const bool configured = !command.config.empty();
  const nlohmann::ordered_json config =
      configured ? deep::read_json_file(command.config, "JSON with fields of a specification") : Json::object();
  for (const std::string& field : command.given) {
    if (!config.is_object() || !config.contains(Json::json_pointer(field))) continue;
    throw InputError(fmt::format("{}: sets {}, which an option sets too, expected one of them", command.config.string(),
                                 field.substr(1)));
  }
  if (command.seed + static_cast<std::uint64_t>(command.seeds - 1) < command.seed) {
    throw InputError(
        fmt::format("--seed, --seeds: {} seeds from {} on, expected seeds below 2^64", command.seeds, command.seed));
  }
  for (int k = 0; k < command.seeds; ++k) {
    for (const std::string& kind : command.kinds) {
      deep::AgentSpec spec =
          deep::recipe(kind, command.eps, command.seed + static_cast<std::uint64_t>(k), command.effort());
      deep::merge_json(spec, config, configured ? command.config.string() : "configuration");
      add(spec);
    }
  }
  return specs;
}

int train(const TrainCommand& command) {
  const std::vector<deep::AgentSpec> specs = planned(command);
  if (command.print_config) {
    Json all = Json::array();
    for (const deep::AgentSpec& spec : specs) all.push_back(deep::to_json(spec));
    print(json_text(specs.size() == 1 ? all[0] : Json{{"agents", all}}));
    return ExitCode::success;
  }
  const torch::Device device = device_named(command.device);
  if (command.quick) note("--quick: a training of seconds, which shows that it works; what comes of it is no result");
  const std::atomic<bool>& stop = stop_on_interrupt();
  WorkLine line("train");
  const auto trained = train_side_by_side(specs, command.folder, device, command.effort(), command.jobs, line, stop);
  Table table;
  table.column("agent", Align::left).column("seconds").column("belief model, s").column("file", Align::left);
  Json all = Json::array();
  bool complete = true;
  for (const auto& agent : trained) {
    complete = complete && agent.has_value();
    if (!agent) continue;
    const std::string file = (command.folder / (agent->spec.name() + ".agent")).string();
    table.row({agent->spec.name(), fmt::format("{:.0f}", agent->training_seconds),
               fmt::format("{:.0f}", agent->belief_seconds), file});
    all.push_back({{"agent", agent->spec.name()},
                   {"training_seconds", agent->training_seconds},
                   {"belief_seconds", agent->belief_seconds},
                   {"file", file}});
  }
  print(command.json ? json_text(Json{{"agents", all}}) : table.text());
  if (complete) return ExitCode::success;
  note("interrupted; the same command goes on where it stopped");
  return ExitCode::interrupted;
}

}  // namespace

void add_train(CLI::App& app, Task& task) {
  auto command = std::make_shared<TrainCommand>();
  CLI::App* sub = app.add_subcommand("train", "Train agents; what is there already is taken, what was cut goes on");
  sub->add_option("AGENT", command->kinds, "Which, of those below")->required()->check(one_of(deep::agent_kinds()));
  sub->add_option("--eps", command->eps, "Radius of the ball to withstand")
      ->check(real_number({.low = 0, .high = 5}))
      ->capture_default_str();
  sub->add_option("--seed", command->seed, "Training seed")->check(seed_number())->capture_default_str();
  sub->add_option("--seeds", command->seeds, "So many seeds, from --seed on")
      ->check(whole_number(1, 1000))
      ->capture_default_str();
  sub->add_option("--folder", command->folder, "Where agents, curves and checkpoints stand")->capture_default_str();
  sub->add_option("--config", command->config, "JSON that changes fields of the specification");
  sub->add_flag("--print-config", command->print_config, "Print the specification and stop");
  sub->add_option("--device", command->device, "cpu, cuda or cuda:N")->capture_default_str();
  sub->add_option("--jobs", command->jobs, "Trainings side by side, one core each")
      ->check(whole_number(1, 256))
      ->capture_default_str();
  sub->add_flag("--quick", command->quick,
                "In small, at most some two minutes: to see that it works; what comes of it is no agent");
  sub->add_option("--frames", command->frames, "So many frames of each training, in place of the recipes'")
      ->check(whole_number(1, 1'000'000'000));
  sub->add_flag("--json", command->json, "Print the result as JSON");
  std::string listing = "Agents:\n";
  for (const std::string& kind : deep::agent_kinds()) listing += fmt::format("  {:16} {}\n", kind, deep::what_is(kind));
  sub->footer(listing +
              "Examples:\n"
              "  maximin_deep train dqn --quick\n"
              "  maximin_deep train bp-dqn --eps 0.5 --seeds 3 --jobs 2\n"
              "  maximin_deep train bp-dqn --print-config > mine.json      then: --config mine.json");
  sub->callback([command, sub, &task] {
    for (const auto& [option, field] : {std::pair{"--eps", "/eps"}, std::pair{"--seed", "/training/seed"},
                                        std::pair{"--frames", "/training/frames"}}) {
      if (sub->count(option) > 0) command->given.emplace_back(field);
    }
    task = [command] { return train(*command); };
  });
}

}  // namespace maximin::apps
