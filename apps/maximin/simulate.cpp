#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/agents.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/belief_game_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/simulation.hpp>

namespace maximin::apps {

namespace {

struct SimulateOptions {
  ModelOptions model;
  AgentOptions agent;
  OutputOptions output;
  std::string attack = "all";
  std::string start;
  SimulationOptions simulation;
  long max_positions = 200'000;
};

/// One attack: what was seen, and what is known.
struct Row {
  std::string attack;
  Evaluation seen;
  std::optional<double> exact;  ///< where it can be calculated
  long empty = 0;               ///< empty intersections of prediction and ball
};

class Simulator {
 public:
  Simulator(const SimulateOptions& options, const Problem& problem)
      : options_(options),
        problem_(problem),
        start_(start_of(options, problem.model)),
        environment_(problem.model.mdp, start_),
        optimal_(policy_iteration(problem.model.mdp)) {}

  std::vector<Row> run() {
    std::vector<std::string> attacks{options_.attack};
    if (options_.attack == "all") attacks = {"none", "random", "myopic", "optimal"};
    return options_.agent.agent == "belief" ? run_belief(attacks) : run_stationary(attacks);
  }

  const std::string& about() const { return about_; }

 private:
  static std::vector<double> start_of(const SimulateOptions& options, const Model<double>& model) {
    const auto n = static_cast<std::size_t>(model.mdp.states());
    if (options.start.empty()) {
      return model.start.empty() ? std::vector<double>(n, 1.0 / static_cast<double>(n)) : model.start;
    }
    std::vector<double> start(n, 0.0);
    start[static_cast<std::size_t>(find_state(model, options.start, "--start"))] = 1;
    return start;
  }

  double mean(const Values<double>& v) const {
    double sum = 0;
    for (Eigen::Index s = 0; s < v.size(); ++s) sum += start_[static_cast<std::size_t>(s)] * v[s];
    return sum;
  }

  template <class AgentT, class AttackT>
  Evaluation play(AgentT& agent, AttackT attack) {
    return simulate(environment_, agent, attack, problem_.perturbation, options_.simulation);
  }

  std::vector<Row> run_stationary(const std::vector<std::string>& attacks) {
    const auto choice = make_agent(options_.agent, problem_.model, problem_.perturbation, optimal_);
    about_ = choice.about;
    const auto values = attacked_values(problem_.model.mdp, problem_.perturbation, choice);
    std::vector<Row> rows;
    for (const std::string& attack : attacks) {
      TabularAgent agent(choice.policy);
      if (attack == "none") rows.push_back({attack, play(agent, NoAttack{}), mean(values.none)});
      if (attack == "random")
        rows.push_back({attack, play(agent, RandomAttack<double>(problem_.perturbation)), mean(values.random)});
      if (attack == "myopic")
        rows.push_back({attack, play(agent, FixedAttack(values.myopic_attack)), mean(values.myopic)});
      if (attack == "optimal")
        rows.push_back({attack, play(agent, FixedAttack(values.optimal_attack)), mean(values.optimal)});
    }
    return rows;
  }

  std::vector<Row> run_belief(const std::vector<std::string>& attacks) {
    about_ = "belief: the action of Q* whose worst value over the exact belief is best";
    std::vector<Row> rows;
    for (const std::string& attack : attacks) {
      BeliefAgent<double, BeliefFilter<double>> agent(optimal_.q,
                                                      BeliefFilter<double>(problem_.model.mdp, problem_.perturbation));
      Row row{attack, {}, std::nullopt};
      if (attack == "none") row.seen = play(agent, NoAttack{});
      if (attack == "random") row.seen = play(agent, RandomAttack<double>(problem_.perturbation));
      if (attack == "myopic") row.seen = play(agent, MyopicAttack<double>(optimal_.q, problem_.perturbation));
      if (attack == "optimal") {
        BeliefGameOptions game;
        game.max_positions = options_.max_positions;
        game.keep_positions = true;
        auto value =
            solve_belief_game(problem_.model.mdp, problem_.perturbation, maximin_belief_policy(optimal_.q), game);
        row.exact = mean(value.v);
        row.seen = play(agent, BeliefGameAttack<double>(std::move(value), problem_.perturbation));
      }
      row.empty = agent.belief_model().empty_intersections();
      rows.push_back(std::move(row));
    }
    return rows;
  }

  const SimulateOptions& options_;
  const Problem& problem_;
  std::vector<double> start_;
  TabularEnvironment<double> environment_;
  CertifiedSolution<double> optimal_;
  std::string about_;
};

Json rows_json(const SimulateOptions& options, const Problem& problem, const std::vector<Row>& rows) {
  Json json;
  json["command"] = "simulate";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(problem.model);
  json["balls"] = balls_json(problem);
  json["agent"] = options.agent.agent;
  json["episodes"] = options.simulation.episodes;
  json["horizon"] = simulation_horizon(problem.model.mdp, options.simulation);
  json["seed"] = options.simulation.seed;
  Json attacks = Json::object();
  for (const Row& row : rows) {
    Json one;
    one["mean_discounted_return"] = row.seen.mean;
    one["half_width_95"] = row.seen.half_width;
    one["exact"] = row.exact ? Json(*row.exact) : Json(nullptr);
    one["empty_intersections"] = row.empty;
    attacks[row.attack] = std::move(one);
  }
  json["attacks"] = std::move(attacks);
  return json;
}

/// Near a discount of 1 the default horizon is longer than anybody would wait for, and a shorter one must be asked for:
/// the returns would silently be those of cut episodes.
void check_horizon(const SimulateOptions& options, const FiniteMdp<double>& mdp) {
  constexpr long most = 1'000'000;
  const long horizon = simulation_horizon(mdp, options.simulation);
  if (options.simulation.horizon > 0 || horizon <= most) return;
  throw InputError(
      fmt::format("--horizon: none given, and at discount {} an episode takes {} steps, expected --horizon N",
                  mdp.discount(), horizon));
}

int run_simulation(const SimulateOptions& options) {
  const Problem problem = load_problem(options.model);
  check_horizon(options, problem.model.mdp);
  Simulator simulator(options, problem);
  const std::vector<Row> rows = simulator.run();
  if (options.output.json) {
    print(json_text(rows_json(options, problem, rows)));
    return ExitCode::success;
  }
  Table table;
  table.column("attack", Align::left).column("mean return", Align::point).column("+/- 95%", Align::point);
  table.column("exact", Align::point);
  long empty = 0;
  for (const Row& row : rows) {
    table.row({row.attack, number(row.seen.mean), number(row.seen.half_width), row.exact ? number(*row.exact) : ""});
    empty += row.empty;
  }
  print(model_line(problem) + balls_line(problem));
  print(fmt::format("Agent: {}.\n{} episodes of at most {} steps, seed {}; discounted returns:\n\n{}",
                    simulator.about(), options.simulation.episodes,
                    simulation_horizon(problem.model.mdp, options.simulation), options.simulation.seed, table.text()));
  if (options.agent.agent == "belief") print(fmt::format("Prediction and ball did not meet {} times.\n", empty));
  return ExitCode::success;
}

void declare(CLI::App& app, SimulateOptions& options) {
  app.add_option("--attack", options.attack, "none, random, myopic, optimal, or all of them one after the other")
      ->check(one_of({"none", "random", "myopic", "optimal", "all"}))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--episodes", options.simulation.episodes, "episodes per attack")
      ->check(whole_number(1, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--horizon", options.simulation.horizon,
                 "steps per episode; 0: until the rest of the return cannot matter")
      ->check(whole_number(0, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--start", options.start, "state to start in, by name or index; else drawn from the model's start")
      ->type_name("STATE");
  app.add_option("--seed", options.simulation.seed, "seed; episode k is the same whatever the number of episodes")
      ->check(seed_number())
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--max-positions", options.max_positions,
                 "positions (truth, belief) that the optimal attack on a belief\nmay plan over")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace

void add_simulate(CLI::App& app, Task& task) {
  auto options = std::make_shared<SimulateOptions>();
  auto* sub = app.add_subcommand("simulate", "episodes of an agent under attacks, beside the exact values");
  declare(*sub, options->model);
  declare(*sub, options->agent, AgentMemory::belief);
  declare(*sub, *options);
  declare(*sub, options->output);
  sub->footer(
      "Examples:\n"
      "  maximin simulate model.json --agent greedy --episodes 10000\n"
      "  maximin simulate model.json --agent belief --attack optimal --json");
  sub->callback([options, sub, &task] {
    task = [options, sub] {
      check_agent(*sub);
      return run_simulation(*options);
    };
  });
}

}  // namespace maximin::apps
