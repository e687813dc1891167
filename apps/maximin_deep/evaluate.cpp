#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin_deep/attack_options.hpp>
#include <maximin/apps/maximin_deep/commands.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/report/estimate.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

struct EvaluateCommand {
  std::vector<std::filesystem::path> files;
  std::vector<std::string> attacks{"none"};
  AttackedAgent options;
  long episodes = 100;
  std::uint64_t seed = 1000;
  bool json = false;
};

double share(long part, long whole) {
  return static_cast<double>(part) / static_cast<double>(whole);
}

const char* words_of(deep::Knowledge knowledge) {
  switch (knowledge) {
    case deep::Knowledge::truth:
      return "looks at the truth alone";
    case deep::Knowledge::network:
      return "knows the network, not of beliefs";
    case deep::Knowledge::defence:
      break;
  }
  return "knows the whole defence";
}

/// "exact, mean, 2 % random"; a vanilla agent, "what it sees".
std::string acts_by(const deep::Acting& acting) {
  std::string text = acting.belief == "observed" ? "what it sees" : acting.belief + ", " + acting.aggregator;
  if (acting.random_actions > 0) text += fmt::format(", {:g} % random", 100 * acting.random_actions);
  return text;
}

/// An agent that believes in a smaller ball than the attack's believes what is not so.
void note_if_unprepared(const Match& match) {
  const deep::AgentSpec& spec = match.trained->spec;
  if (!spec.knows_eps() || match.eps <= spec.eps) return;
  note(fmt::format("{} was trained for eps {:g}; the attack's is {:g}", spec.name(), spec.eps, match.eps));
}

/// An attacker's file is of one attack on one agent.
void expect_one_attacker(const EvaluateCommand& command) {
  if (command.options.attacker.empty()) return;
  const auto learned = std::count_if(command.attacks.begin(), command.attacks.end(),
                                     [](const std::string& name) { return deep::attack_named(name).learned; });
  if (learned == 1 && command.files.size() == 1) return;
  throw InputError(fmt::format("--attacker: one file for {} learned attacks on {} agents, expected one and one",
                               learned, command.files.size()));
}

int evaluate(const EvaluateCommand& command) {
  expect_options_used(command.options, command.attacks);
  expect_one_attacker(command);
  note_if_quick(command.options);
  std::optional<StageProgress> line("evaluate");
  Table table;
  table.column("agent", Align::left)
      .column("acts by", Align::left)
      .column("attack", Align::left)
      .column("eps", Align::point);
  table.column("return", Align::point)
      .column("+-", Align::point)
      .column("gold")
      .column("bomb")
      .column("truth in belief");
  table.column("belief area", Align::point).column("empty").column("ms/step", Align::point);
  Json all = Json::array();
  std::set<std::string> judges;
  for (const auto& file : command.files) {
    for (const std::string& attack : command.attacks) {
      AttackedAgent options = command.options;
      options.file = file;
      options.attack = deep::attack_named(attack).name;
      const std::string what = fmt::format("{}, {}", file.stem().string(), attack);
      options.progress = [&](const std::string& at) { line->stage(fmt::format("{}: {}", what, at)); };
      line->stage(what);
      const Match match = prepare_match(options);
      if (&attack == &command.attacks.front()) note_if_unprepared(match);
      const deep::AgentEvaluation e = deep::evaluate_agent(*match.agent, *match.attack, ObservationBall(match.eps),
                                                           command.episodes, command.seed, match.acting.world);
      const std::vector<deep::SeedRun> run{{match.trained->spec.training.seed, command.seed, e.returns, e.seconds}};
      const deep::Estimate estimate = deep::estimate(run);
      const double half = estimate.shown() ? estimate.shown()->half_width : std::nan("");
      const std::string name = match.trained->spec.name();
      const bool believes = match.acting.belief != "observed";
      table.row({name, acts_by(match.acting), attack, fmt::format("{:g}", match.eps),
                 fmt::format("{:.1f}", estimate.mean), fmt::format("{:.1f}", half), std::to_string(e.gold),
                 std::to_string(e.bomb), believes ? fmt::format("{:.1f} %", 100 * e.truth_in_belief) : "-",
                 believes ? fmt::format("{:.3f}", e.belief_size) : "-",
                 believes ? std::to_string(e.empty_intersections) : "-",
                 fmt::format("{:.3f}", 1000 * e.seconds / double(e.steps))});
      if (!match.judge.empty()) judges.insert(match.judge);
      all.push_back({{"agent", name},
                     {"belief", match.acting.belief},
                     {"aggregator", match.acting.aggregator},
                     {"random_actions", match.acting.random_actions},
                     {"attack", attack},
                     {"eps", match.eps},
                     {"judge", match.judge.empty() ? Json() : Json(match.judge)},
                     {"mean_return", estimate.mean},
                     {"half_width_95", half},
                     {"gold", share(e.gold, command.episodes)},
                     {"bomb", share(e.bomb, command.episodes)},
                     {"truth_in_belief", e.truth_in_belief},
                     {"belief_area", e.belief_size},
                     {"empty_intersections", e.empty_intersections},
                     {"steps", e.steps},
                     {"seconds", e.seconds},
                     {"returns", e.returns}});
    }
  }
  line.reset();
  if (command.json) {
    print(json_text(Json{
        {"episodes", command.episodes}, {"seed", command.seed}, {"quick", command.options.quick}, {"results", all}}));
    return ExitCode::success;
  }
  print(table.text());
  print(fmt::format("{} episodes each; +- is a 95 percent interval over episodes of these very networks.\n",
                    command.episodes));
  if (!judges.empty()) {
    print(fmt::format("Attacks on the whole defence go by the values of {}.\n", fmt::join(judges, ", ")));
  }
  return ExitCode::success;
}

}  // namespace

void add_evaluate(CLI::App& app, Task& task) {
  auto command = std::make_shared<EvaluateCommand>();
  CLI::App* sub = app.add_subcommand("evaluate", "What trained agents get under attacks");
  sub->add_option("FILE", command->files, "Agent files")->required();
  sub->add_option("--attack", command->attacks, "One or more attacks")
      ->check(one_of(deep::attack_names()))
      ->capture_default_str();
  add_attack_options(*sub, command->options);
  sub->add_option("--episodes", command->episodes, "Episodes of each")
      ->check(whole_number(2, 1'000'000))
      ->capture_default_str();
  sub->add_option("--seed", command->seed, "Episode k is drawn from (seed, k)")
      ->check(seed_number())
      ->capture_default_str();
  sub->add_flag("--json", command->json, "Print the result as JSON");
  std::string listing = "Attacks:\n";
  for (const auto& a : deep::named_attacks()) {
    listing += fmt::format("  {:20} {}: {}{}\n", a.name, a.title, words_of(a.knows), a.learned ? ", learned" : "");
  }
  sub->footer(
      listing +
      "Columns: +- a 95 percent interval; gold and bomb, episodes that ended there, where the others ran out of\n"
      "time; truth in belief, the share of steps in which the agent held the true state possible; belief area;\n"
      "empty, how often nothing that it held possible could have been shown; ms/step of agent, attack and world.\n"
      "Examples:\n"
      "  maximin_deep evaluate runs/bp-dqn-eps0.5-seed1.agent --attack none pgd min-best best-response\n"
      "  maximin_deep evaluate runs/dqn-seed1.agent --belief exact --eps 0.5 --attack pgd");
  sub->callback([command, &task] { task = [command] { return evaluate(*command); }; });
}

}  // namespace maximin::apps
