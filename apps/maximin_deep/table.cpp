#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin_deep/commands.hpp>
#include <maximin/apps/maximin_deep/table_plan.hpp>
#include <maximin/apps/maximin_deep/workers.hpp>
#include <maximin/deep/attacks/director_training.hpp>
#include <maximin/deep/attacks/named_attack.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/report/results_file.hpp>
#include <maximin/deep/report/results_page.hpp>
#include <maximin/deep/report/results_text.hpp>
#include <maximin/deep/sure_agent.hpp>
#include <maximin/gridworld/hull_control.hpp>
#include <maximin/models/files/output_file.hpp>

namespace maximin::apps {

namespace {

namespace fs = std::filesystem;

struct TableCommand {
  std::string kind;
  fs::path folder = "runs";
  fs::path output = "results";
  int seeds = 0;                            ///< unless given: 3; 1 where it is quick
  std::optional<std::uint64_t> first_seed;  ///< unless given: 1 for the table, 101 for the choice of an aggregator
  long episodes = 0;                        ///< unless given: 100; 5 where it is quick
  std::vector<std::string> only, attacks;   ///< what is left in; empty: all
  int jobs = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  bool quick = false;
  long frames = 0;  ///< of each training; 0: what the recipes say

  /// What was not given.
  void complete() {
    if (seeds == 0) seeds = quick ? 1 : 3;
    if (episodes == 0) episodes = quick ? 5 : 100;
    if (quick && frames == 0) frames = 2000;
  }
  deep::Effort effort() const { return {quick, frames}; }
  std::uint64_t seed(int k) const {
    return first_seed.value_or(kind == "aggregators" ? 101 : 1) + static_cast<std::uint64_t>(k);
  }
};

/// The work of one table: trainings, then evaluations, each of them a job; what is done already is left out.
class TableMaker {
 public:
  /// Makes those cells of the whole table that `left_in` says.
  TableMaker(const TableCommand& command, const std::vector<PlannedCell>& whole,
             const std::function<bool(const PlannedCell&)>& left_in)
      : command_(command), whole_(whole), line_(command.kind), stop_(stop_on_interrupt()) {
    std::copy_if(whole.begin(), whole.end(), std::back_inserter(plan_), left_in);
    if (plan_.empty()) throw InputError("--only, --attacks: no such cell in the table, expected e.g. --only bp-dqn");
  }

  int run() {
    deep::ResultFile file = deep::ResultFile::open(command_.output / (command_.kind + ".json"), planned_table());
    expect_runs_of_this_table(file.table());
    train_all();
    evaluate_all(file);
    if (!stop_) write_pages(file.table());
    if (stop_) note("interrupted; the same command goes on where it stopped");
    return stop_ ? ExitCode::interrupted : ExitCode::success;
  }

 private:
  static std::uint64_t evaluation_seed(std::uint64_t training_seed) { return 1000 + training_seed; }

  /// The file's configuration is this table's: so must its runs be.
  void expect_runs_of_this_table(const deep::ResultTable& table) const {
    for (const deep::ResultBlock& block : table.blocks) {
      for (const deep::ResultCell& cell : block.cells) {
        for (const deep::SeedRun& run : cell.runs) {
          if (run.returns.size() == static_cast<std::size_t>(command_.episodes) &&
              run.evaluation_seed == evaluation_seed(run.training_seed)) {
            continue;
          }
          throw InputError(fmt::format("{}.json: {} / {}: a run of {} episodes from seed {}, expected {} from {}",
                                       (command_.output / command_.kind).string(), cell.agent, cell.attack,
                                       run.returns.size(), run.evaluation_seed, command_.episodes,
                                       evaluation_seed(run.training_seed)));
        }
      }
    }
  }

  /// Its radius is never asked for.
  deep::AgentSpec vanilla_spec(std::uint64_t seed) const { return deep::recipe("dqn", 0, seed, command_.effort()); }

  fs::path agent_file(const deep::AgentSpec& spec) const { return command_.folder / (spec.name() + ".agent"); }

  deep::ResultTable planned_table() const {
    deep::ResultTable table;
    table.title = command_.kind == "aggregators" ? "Which aggregator BP-DQN acts by" : "Continuous Gridworld";
    table.version = MAXIMIN_VERSION;
    table.command = fmt::format("maximin_deep table {} --seeds {} --episodes {}{}", command_.kind, command_.seeds,
                                command_.episodes, command_.quick ? " --quick" : "");
    if (command_.frames > 0) table.command += fmt::format(" --frames {}", command_.frames);
    if (command_.first_seed) table.command += fmt::format(" --first-seed {}", *command_.first_seed);
    if (!command_.only.empty()) table.command += fmt::format(" --only {}", fmt::join(command_.only, " "));
    if (!command_.attacks.empty()) table.command += fmt::format(" --attacks {}", fmt::join(command_.attacks, " "));
    table.configuration["episodes"] = command_.episodes;
    table.configuration["quick"] = command_.quick;
    table.configuration["director_frames"] = deep::DirectorTraining().frames;
    if (command_.frames > 0) table.configuration["frames"] = command_.frames;
    // Of the whole table, whatever is left in: its parts may be made one by one.
    std::set<std::string> names;
    for (const PlannedCell& cell : whole_) {
      if (!cell.is_trained()) continue;
      const deep::AgentSpec spec = spec_of(cell, command_.seed(0), command_.effort());
      if (names.insert(spec.name()).second) table.configuration["agents"][spec.name()] = deep::to_json(spec);
    }
    for (const PlannedCell& cell : plan_) {
      deep::ResultBlock* block = table.find(cell.block);
      if (!block)
        block =
            &table.blocks.emplace_back(deep::ResultBlock{cell.block, block_note(cell.block, command_.effort()), {}});
      block->cells.push_back(cell.cell);
    }
    return table;
  }

  /// The agents of the table, and vanilla ones, by whose values adaptive attacks go.
  void train_all() {
    std::vector<deep::AgentSpec> specs;
    for (int k = 0; k < command_.seeds; ++k) {
      for (const PlannedCell& cell : plan_) {
        if (!cell.is_trained()) continue;
        specs.push_back(spec_of(cell, command_.seed(k), command_.effort()));
        if (cell.filter_of.empty()) continue;
        specs.push_back(deep::recipe(cell.filter_of, cell.trained_eps, command_.seed(k), command_.effort()));
      }
      specs.push_back(vanilla_spec(command_.seed(k)));
      specs.push_back(vanilla_spec(deep::judge_seed(command_.seed(k))));
    }
    train_side_by_side(std::move(specs), command_.folder, torch::kCPU, command_.effort(), command_.jobs, line_, stop_);
  }

  void evaluate_all(deep::ResultFile& file) {
    std::mutex mutex;
    std::atomic<long> done = 0;
    std::vector<std::function<void()>> jobs;
    const long all = static_cast<long>(plan_.size()) * command_.seeds;
    for (int k = 0; k < command_.seeds; ++k) {
      for (const PlannedCell& cell : plan_) {
        if (file.has(cell.block, cell.cell, command_.seed(k))) {
          ++done;
          continue;
        }
        jobs.emplace_back([&, k, cell] {
          line_.say(fmt::format("{} / {} {:g}", cell.cell.agent, cell.cell.attack, cell.attack_eps));
          deep::ResultCell measured = cell.cell;
          const auto run = evaluate_cell(cell, command_.seed(k), measured);
          line_.say("");
          line_.done(++done, all);
          if (!run) return;
          const std::lock_guard lock(mutex);
          file.put(cell.block, measured, *run);
        });
      }
    }
    run_in_parallel(jobs, command_.jobs, stop_);
  }

  struct Ready {
    std::function<std::unique_ptr<deep::GridAgent>()> make_agent;
    std::string name;  ///< that tells it from any other agent of the table
    std::shared_ptr<deep::ActionValueModule> values;
    std::string identity;
    double unit = 1;  ///< what one reward is in the values that the agent goes by
    GridworldOptions world = {};
  };

  Ready ready_to_act(const PlannedCell& cell, std::uint64_t seed,
                     const std::shared_ptr<deep::ActionValueModule>& vanilla) {
    if (!cell.is_trained()) {
      const HullControl& control = sure_control(cell.trained_eps);
      return {[&control] { return std::make_unique<deep::SureAgent>(control); },
              fmt::format("sure-eps{:g}-seed{}", cell.trained_eps, seed), vanilla,
              fmt::format("sure {:g}", cell.trained_eps), 1};
    }
    const deep::AgentSpec spec = spec_of(cell, seed, command_.effort());
    auto trained = std::make_shared<deep::TrainedAgent>(deep::read_agent(agent_file(spec)));
    const deep::Acting acting = deep::acting_of(spec, cell.change);
    // A vanilla agent has no radius of its own: its belief, if it is given one, is of the cell's.
    if (!spec.knows_eps()) trained->spec.eps = cell.trained_eps;
    if (!cell.filter_of.empty()) {
      const deep::AgentSpec other = deep::recipe(cell.filter_of, cell.trained_eps, seed, command_.effort());
      trained->particle_filter = deep::read_agent(agent_file(other)).particle_filter;
    }
    return {[trained, acting] { return deep::make_agent(*trained, acting); },
            fmt::format("{}-{}-{}-random{:g}", spec.name(), acting.belief, acting.aggregator, acting.random_actions),
            trained->values_in_rewards(),
            deep::identity_of(*trained, acting),
            spec.training.reward_scale,
            acting.world};
  }

  /// Solved once for each radius, in seconds: by as many squares to a move as bench/gridworld_sure shows to pay.
  const HullControl& sure_control(double eps) {
    const std::lock_guard lock(mutex_);
    const auto found = controls_.find(eps);
    if (found != controls_.end()) return found->second;
    return controls_.emplace(eps, HullControl(ObservationBall(eps), eps < 0.25 ? 10 : 3)).first->second;
  }

  fs::path attacker_file(const Ready& ready, const PlannedCell& cell) const {
    return command_.folder / fmt::format("{}-{}-eps{:g}.attacker", ready.name, cell.attack, cell.attack_eps);
  }

  struct Match {
    std::unique_ptr<deep::GridAgent> agent;
    std::shared_ptr<deep::GridAttack> attack;  ///< empty where its training was interrupted
    GridworldOptions world;
  };

  Match prepare(const PlannedCell& cell, std::uint64_t seed) {
    const auto vanilla = [&](std::uint64_t of) { return deep::read_agent(agent_file(vanilla_spec(of))); };
    const Ready ready = ready_to_act(cell, seed, vanilla(seed).values_in_rewards());
    deep::AttackSetting setting;
    setting.name = cell.attack;
    setting.eps = cell.attack_eps;
    setting.seed = seed;
    setting.quick = command_.quick;
    setting.file = attacker_file(ready, cell);
    setting.progress = [this, &cell](double share, double) {
      line_.say(fmt::format("{} / {} {:g}: learns, {:.0f} %", cell.cell.agent, cell.cell.attack, cell.attack_eps,
                            100 * share));
      return !stop_.load();
    };
    const deep::AttackTarget target{ready.values,   vanilla(deep::judge_seed(seed)).values_in_rewards(),
                                    ready.identity, ready.make_agent,
                                    ready.unit,     ready.world};
    return {ready.make_agent(), deep::make_attack(setting, target), ready.world};
  }

  std::optional<deep::SeedRun> evaluate_cell(const PlannedCell& cell, std::uint64_t seed, deep::ResultCell& measured) {
    const auto start = std::chrono::steady_clock::now();
    const Match match = prepare(cell, seed);
    if (!match.attack) return std::nullopt;
    const deep::AgentEvaluation e = deep::evaluate_agent(*match.agent, *match.attack, ObservationBall(cell.attack_eps),
                                                         command_.episodes, evaluation_seed(seed), match.world);
    measured.measures = {{"truth in belief", e.truth_in_belief},
                         {"belief area", e.belief_size},
                         {"empty intersections", static_cast<double>(e.empty_intersections)}};
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return deep::SeedRun{seed, evaluation_seed(seed), e.returns, seconds};
  }

  std::vector<deep::TrainingCurve> curves() const {
    std::vector<deep::TrainingCurve> out;
    std::set<std::string> names;
    for (int k = 0; k < command_.seeds; ++k) {
      for (const PlannedCell& cell : plan_) {
        if (!cell.is_trained()) continue;
        const deep::AgentSpec spec = spec_of(cell, command_.seed(k), command_.effort());
        const fs::path log = command_.folder / (spec.name() + ".csv");
        if (!names.insert(spec.name()).second || !fs::exists(log)) continue;
        const std::string title = spec.knows_eps() ? fmt::format("{} {:g}", cell.kind, spec.eps) : cell.kind;
        out.push_back({title, spec.training.seed, deep::read_training_log(log)});
      }
    }
    return out;
  }

  /// Whether its attack is there to play: no picture is worth the minutes that a lost one takes to learn anew.
  bool can_play(const PlannedCell& cell) {
    return !deep::attack_named(cell.attack).learned ||
           fs::exists(attacker_file(ready_to_act(cell, command_.seed(0), nullptr), cell));
  }

  /// One episode of each of a few cells at the larger radius.
  std::vector<deep::EpisodeTrace> traces() {
    const std::set<std::string> kinds{"dqn", "bp-dqn", "bp-dqn-printed", "sure"};
    const std::set<std::string> attacks{"pgd", "best-response", "director"};
    std::vector<deep::EpisodeTrace> out;
    for (const PlannedCell& cell : plan_) {
      const bool shown = kinds.contains(cell.kind) && attacks.contains(cell.attack) && cell.change.belief.empty() &&
                         cell.attack_eps > 0.3 && cell.block != "ablation";
      if (!shown || !can_play(cell)) continue;
      const Match match = prepare(cell, command_.seed(0));
      if (!match.attack) continue;
      deep::EpisodeTrace trace = deep::trace_episode(*match.agent, *match.attack, ObservationBall(cell.attack_eps),
                                                     evaluation_seed(command_.seed(0)), 3, match.world);
      trace.agent = cell.cell.agent;
      trace.attack = cell.cell.attack;
      trace.training_seed = command_.seed(0);
      out.push_back(std::move(trace));
    }
    return out;
  }

  void write_pages(deep::ResultTable table) {
    add_strongest(table);
    const fs::path base = command_.output / command_.kind;
    // Both or neither: what they are drawn from may be damaged.
    const std::string page = deep::results_page(table, curves(), traces());
    write_file(base.string() + ".md", deep::markdown(table), Overwrite::replace);
    write_file(base.string() + ".html", page, Overwrite::replace);
    print(overview(table).text());
    print(fmt::format("All of it: {0}.html to look at, {0}.md to read, {0}.json for programs.\n", base.string()));
  }

  /// What each agent gets at best and at worst, and the targets.
  static Table overview(const deep::ResultTable& table) {
    Table out;
    out.column("agent", Align::left).column("attack", Align::left).column("return", Align::left);
    out.column("target", Align::left);
    for (const deep::ResultBlock& block : table.blocks) {
      for (const deep::ResultCell& cell : block.cells) {
        if (cell.eps > 0 && !cell.target && !block.derived) continue;
        const std::string by = cell.note.empty() ? "" : " (" + cell.note + ")";
        const std::string target =
            cell.target ? fmt::format("{:g}: {}", cell.target->value, deep::verdict_word(deep::verdict(cell))) : "";
        out.row({cell.agent, deep::column_title({cell.attack, cell.eps}) + by, deep::cell_text(cell), target});
      }
    }
    return out;
  }

  TableCommand command_;
  std::vector<PlannedCell> whole_, plan_;
  WorkLine line_;
  const std::atomic<bool>& stop_;
  std::mutex mutex_;                        ///< of what follows
  std::map<double, HullControl> controls_;  ///< by radius
};

std::vector<std::string> kinds_in_tables() {
  std::vector<std::string> kinds = deep::agent_kinds();
  kinds.emplace_back("sure");
  return kinds;
}

int make_table(const TableCommand& command) {
  const std::vector<PlannedCell> whole = command.kind == "aggregators" ? aggregators_plan() : gridworld_plan();
  const auto listed = [](const std::vector<std::string>& names, const std::string& name) {
    return names.empty() || std::find(names.begin(), names.end(), name) != names.end();
  };
  TableMaker maker(command, whole, [&](const PlannedCell& c) {
    const bool whole_agent = c.filter_of.empty() || listed(command.only, c.filter_of);
    if (command.quick && !is_in_quick_table(c)) return false;
    return listed(command.only, c.kind) && listed(command.attacks, c.attack) && whole_agent;
  });
  if (command.quick)
    note("--quick: everything in small and at the larger radius alone, to see that it works; the numbers mean nothing");
  make_folder(command.folder);
  make_folder(command.output);
  return maker.run();
}

}  // namespace

void add_table(CLI::App& app, Task& task) {
  auto command = std::make_shared<TableCommand>();
  CLI::App* sub =
      app.add_subcommand("table", "Every agent under every attack: JSON, Markdown and a page with pictures");
  sub->add_option("TABLE", command->kind, "gridworld: the paper's; aggregators: how BP-DQN's was chosen")
      ->required()
      ->check(one_of({"gridworld", "aggregators"}));
  sub->add_option("--folder", command->folder, "Trained agents and attackers; what is missing is trained")
      ->capture_default_str();
  sub->add_option("--output", command->output, "Folder for the table")->capture_default_str();
  sub->add_option("--seeds", command->seeds, "Training seeds: 3 unless given, 1 if quick")
      ->check(whole_number(1, 1000));
  sub->add_option("--first-seed", command->first_seed, "The first of them; 1, or 101 for aggregators")
      ->check(seed_number());
  sub->add_option("--episodes", command->episodes, "Episodes of each cell and seed: 100 unless given, 5 if quick")
      ->check(whole_number(2, 1'000'000));
  sub->add_option("--only", command->only, "Agents to leave in, e.g. dqn bp-dqn")->check(one_of(kinds_in_tables()));
  sub->add_option("--attacks", command->attacks, "Attacks to leave in, e.g. none pgd")
      ->check(one_of(deep::attack_names()));
  sub->add_option("--jobs", command->jobs, "Trainings and evaluations side by side")
      ->check(whole_number(1, 256))
      ->capture_default_str();
  sub->add_flag("--quick", command->quick, "In small, some two minutes: to see that it works");
  sub->add_option("--frames", command->frames, "So many frames of each training, in place of the recipes'")
      ->check(whole_number(1, 1'000'000'000));
  sub->footer(
      "A table that was cut goes on where it stopped.\n"
      "Examples:\n"
      "  maximin_deep table gridworld --quick --output /tmp/quick --folder /tmp/quick/agents\n"
      "  maximin_deep table gridworld --folder results/gridworld/agents --output results/gridworld");
  sub->callback([command, &task] {
    command->complete();
    task = [command] { return make_table(*command); };
  });
}

}  // namespace maximin::apps
