#include <fmt/format.h>
#include <memory>
#include <optional>
#include <vector>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/apps/maximin/grid_map.hpp>
#include <maximin/tabular/belief_game_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/simulation.hpp>

namespace maximin::apps {

namespace {

struct BeliefOptions {
  ModelOptions model;
  OutputOptions output;
  std::string attack = "myopic";
  std::string start;
  long steps = 8;
  long max_positions = 200'000;
  std::uint64_t seed = 1;
};

using Walker = BeliefAgent<double, BeliefFilter<double>>;

/// One step of the walk, as the agent lived it.
struct Stage {
  StepRecord<State, State, Action> record;
  Belief predicted;  ///< M'_{t-1}; empty at the start
  Belief belief;     ///< M_t
  bool met = true;   ///< whether prediction and ball met
  Action by_ball;    ///< what maximin over the ball alone would have done
};

struct Walk {
  std::vector<Stage> stages;
  Episode episode;
  long empty = 0;
};

template <class AttackT>
Walk walk(const BeliefOptions& options, const Problem& problem, const QTable<double>& q, AttackT attack) {
  const auto& mdp = problem.model.mdp;
  const auto env = !options.start.empty()
                       ? TabularEnvironment<double>(mdp, find_state(problem.model, options.start, "--start"))
                   : problem.model.start.empty() ? TabularEnvironment<double>(mdp)
                                                 : TabularEnvironment<double>(mdp, problem.model.start);
  TabularEnvironment<double> environment = env;
  Walker agent(q, BeliefFilter<double>(mdp, problem.perturbation));
  SimulationOptions simulation;
  simulation.horizon = options.steps;
  simulation.seed = options.seed;
  Walk result;
  std::vector<double> scratch;
  const auto observe = [&](const auto& record, const Walker& at) {
    const auto& filter = at.belief_model();
    const Action by_ball = belief_action(q, problem.perturbation.ball(record.shown), scratch);
    result.stages.push_back({record, record.time == 0 ? Belief{} : filter.predicted(), filter.belief(),
                             filter.empty_intersections() == result.empty, by_ball});
    result.empty = filter.empty_intersections();
  };
  result.episode = simulate_episode(environment, agent, attack, problem.perturbation, simulation, 0, observe);
  return result;
}

Walk walk(const BeliefOptions& options, const Problem& problem, const QTable<double>& q) {
  if (options.attack == "none") return walk(options, problem, q, NoAttack{});
  if (options.attack == "random") return walk(options, problem, q, RandomAttack<double>(problem.perturbation));
  if (options.attack == "myopic") return walk(options, problem, q, MyopicAttack<double>(q, problem.perturbation));
  BeliefGameOptions game;
  game.max_positions = options.max_positions;
  game.keep_positions = true;
  auto value = solve_belief_game(problem.model.mdp, problem.perturbation, maximin_belief_policy(q), game);
  return walk(options, problem, q, BeliefGameAttack<double>(std::move(value), problem.perturbation));
}

std::string stage_text(const Problem& problem, const Stage& stage, const std::optional<GridMap>& map) {
  const Model<double>& model = problem.model;
  const auto& record = stage.record;
  const auto ball = problem.perturbation.ball(record.shown);
  const auto name = [&](State s) { return printable(model.state_name(s)); };
  std::string text = fmt::format("\nstep {}: true {}, shown {}\n", record.time, name(record.truth),
                                 record.shown == record.truth ? "the truth" : name(record.shown));
  if (map) text += map->draw({record.truth, record.shown, ball, stage.belief});
  if (record.time > 0) text += fmt::format("  may be now  {}\n", set_text(model, stage.predicted));
  text += fmt::format("  ball        {}\n", set_text(model, ball));
  text += fmt::format("  belief      {}{}\n", set_text(model, stage.belief),
                      stage.met ? "" : "  (prediction and ball do not meet: the ball is believed)");
  text += fmt::format("  does        {}", printable(model.action_name(record.action)));
  if (stage.by_ball != record.action)
    text += fmt::format(" (over the ball alone: {})", printable(model.action_name(stage.by_ball)));
  return text + fmt::format(", reward {}\n", number(record.reward));
}

std::string walk_text(const BeliefOptions& options, const Problem& problem, const Walk& walk) {
  const auto map = GridMap::of(problem.model);
  std::string text = model_line(problem) + balls_line(problem);
  text += fmt::format("Agent: maximin of Q* over its belief. Attack: {}. Seed {}.\n", options.attack, options.seed);
  if (map) text += GridMap::legend();
  for (const Stage& stage : walk.stages) text += stage_text(problem, stage, map);
  text += fmt::format("\n{} after {} steps in {}; discounted return {}.\n",
                      walk.episode.terminal ? "The episode is over" : "Stopped", walk.episode.steps,
                      printable(problem.model.state_name(walk.stages.back().record.next)),
                      number(walk.episode.discounted_return));
  if (walk.empty > 0) text += fmt::format("Prediction and ball did not meet {} times.\n", walk.empty);
  return text;
}

Json walk_json(const BeliefOptions& options, const Problem& problem, const Walk& walk) {
  Json json;
  json["command"] = "belief";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(problem.model);
  json["balls"] = balls_json(problem);
  json["attack"] = options.attack;
  json["seed"] = options.seed;
  Json steps = Json::array();
  for (const Stage& stage : walk.stages) {
    const auto ball = problem.perturbation.ball(stage.record.shown);
    Json step;
    step["time"] = stage.record.time;
    step["truth"] = stage.record.truth;
    step["shown"] = stage.record.shown;
    step["predicted"] = stage.record.time == 0 ? Json(nullptr) : Json(stage.predicted);
    step["ball"] = std::vector<State>(ball.begin(), ball.end());
    step["belief"] = stage.belief;
    step["met"] = stage.met;
    step["action"] = stage.record.action;
    step["action_by_ball"] = stage.by_ball;
    step["reward"] = stage.record.reward;
    step["next"] = stage.record.next;
    steps.push_back(std::move(step));
  }
  json["steps"] = std::move(steps);
  json["terminal"] = walk.episode.terminal;
  json["discounted_return"] = walk.episode.discounted_return;
  json["empty_intersections"] = walk.empty;
  return json;
}

int belief(BeliefOptions options) {
  if (!options.model.given()) options.model.example = "grid";
  const Problem problem = load_problem(options.model);
  const auto optimal = policy_iteration(problem.model.mdp);
  const Walk result = walk(options, problem, optimal.q);
  print(options.output.json ? json_text(walk_json(options, problem, result)) : walk_text(options, problem, result));
  return ExitCode::success;
}

void declare(CLI::App& app, BeliefOptions& options) {
  app.add_option("--attack", options.attack,
                 "none, random, myopic (least Q* in the next step) or optimal (plans to\nmislead the belief)")
      ->check(one_of({"none", "random", "myopic", "optimal"}))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--steps", options.steps, "steps to walk, fewer if the episode ends")
      ->check(whole_number(1, 1'000'000))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--start", options.start, "state to start in, by name or index; else drawn from the model's start")
      ->type_name("STATE");
  app.add_option("--seed", options.seed, "seed of all randomness")
      ->check(seed_number())
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--max-positions", options.max_positions,
                 "positions (truth, belief) that the optimal attack may plan over")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace

void add_belief(CLI::App& app, Task& task) {
  auto options = std::make_shared<BeliefOptions>();
  auto* sub = app.add_subcommand("belief", "a walk, step by step: truth, what is shown, ball, belief, maximin action");
  declare(*sub, options->model);
  declare(*sub, *options);
  declare(*sub, options->output);
  sub->footer(
      "Without a model a small grid is walked. The agent knows the model and eps, keeps the set of states that it may "
      "be\n"
      "in, and does the action of Q* whose worst value over that set is best.\n"
      "Examples:\n"
      "  maximin belief\n"
      "  maximin belief --attack optimal --steps 20\n"
      "  maximin belief FrozenLake.json --metric hops --eps 1 --seed 7 --json");
  sub->callback([options, &task] { task = [options] { return belief(*options); }; });
}

}  // namespace maximin::apps
