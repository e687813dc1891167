#include <fmt/format.h>
#include <functional>
#include <map>
#include <memory>
#include <sstream>

#include <maximin/apps/common/model_options.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/apps/maximin/robust.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/tabular/graphviz.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/topological_value_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>

namespace maximin::apps {

namespace {

struct SolveOptions {
  ModelOptions model;
  OutputOptions output;
  std::string method = "policy-iteration";
  double tolerance = 0;
  long max_sweeps = SolverOptions().max_sweeps;
  bool robust = false;
  RobustOptions limits;
  std::string graph;
  bool force = false;
};

using Solver = std::function<CertifiedSolution<double>(const FiniteMdp<double>&, const SolverOptions&)>;

const std::map<std::string, Solver>& solvers() {
  static const std::map<std::string, Solver> all{
      {"policy-iteration", [](const auto& mdp, const auto& options) { return policy_iteration(mdp, options); }},
      {"value-iteration", [](const auto& mdp, const auto& options) { return value_iteration(mdp, options); }},
      {"modified-policy-iteration",
       [](const auto& mdp, const auto& options) { return modified_policy_iteration(mdp, options); }},
      {"topological-value-iteration",
       [](const auto& mdp, const auto& options) { return topological_value_iteration(mdp, options); }},
  };
  return all;
}

/// V* and the greedy action by state; Q* as well, where its columns fit.
std::string optimal_text(const Model<double>& model, const CertifiedSolution<double>& optimal, std::size_t rows) {
  constexpr Action most_columns = 8;
  const bool with_q = model.mdp.actions() <= most_columns;
  Table table;
  table.column("state", Align::left).column("V*", Align::point).column("best action", Align::left);
  for (Action a = 0; with_q && a < model.mdp.actions(); ++a) {
    table.column(fmt::format("Q*({})", model.action_name(a)), Align::point);
  }
  for (State s = 0; s < model.mdp.states(); ++s) {
    std::vector<std::string> cells{model.state_name(s), number(optimal.v[s], optimal.error),
                                   model.action_name(optimal.policy[static_cast<std::size_t>(s)])};
    for (Action a = 0; with_q && a < model.mdp.actions(); ++a) cells.push_back(number(optimal.q(s, a), optimal.error));
    table.row(std::move(cells));
  }
  return table.text(rows);
}

void write_graph(const SolveOptions& options, const Model<double>& model, const CertifiedSolution<double>& optimal) {
  GraphvizOptions drawing;
  drawing.title = model.name;
  drawing.state_names = model.state_names;
  drawing.action_names = model.action_names;
  drawing.values.assign(optimal.v.data(), optimal.v.data() + optimal.v.size());
  drawing.policy = optimal.policy;
  std::ostringstream dot;
  write_graphviz(dot, model.mdp, drawing);
  write_file(options.graph, dot.str(), options.force ? Overwrite::replace : Overwrite::refuse);
  note(fmt::format("{} written; dot -Tsvg draws it", options.graph));
}

Json solution_json(const SolveOptions& options, const Model<double>& model, const CertifiedSolution<double>& optimal) {
  Json json;
  json["command"] = "solve";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(model);
  json["method"] = options.method;
  json["sweeps"] = optimal.sweeps;
  json["certified_error"] = optimal.error;
  json["value_from_start"] = start_mean(model, optimal.v);
  json["v"] = to_json(optimal.v);
  json["q"] = to_json(optimal.q);
  json["policy"] = optimal.policy;
  return json;
}

CertifiedSolution<double> optimal_solution(const SolveOptions& options, const FiniteMdp<double>& mdp) {
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  solver.max_sweeps = options.max_sweeps;
  return solvers().at(options.method)(mdp, solver);
}

/// Q* alone, without balls.
int solve_plain(const SolveOptions& options) {
  const Model<double> model = load(options.model);
  const auto optimal = optimal_solution(options, model.mdp);
  if (!options.graph.empty()) write_graph(options, model, optimal);
  if (options.output.json) {
    print(json_text(solution_json(options, model, optimal)));
    return ExitCode::success;
  }
  print(model_line(model, title(model.name, options.model)));
  print(fmt::format("V* from the start: {}, by {}, certified to {}.\n\n",
                    number(start_mean(model, optimal.v), optimal.error), options.method, error_number(optimal.error)));
  print(optimal_text(model, optimal, options.output.rows()));
  return ExitCode::success;
}

int solve_robustly(const SolveOptions& options) {
  const Problem problem = load_problem(options.model);
  const auto optimal = optimal_solution(options, problem.model.mdp);
  const auto robust = solve_robust(problem, optimal, options.limits);
  if (!options.graph.empty()) write_graph(options, problem.model, optimal);
  if (options.output.json) {
    Json json = solution_json(options, problem.model, optimal);
    json["robust"] = robust_json(problem, robust);
    print(json_text(json));
    return ExitCode::success;
  }
  print(model_line(problem));
  print(robust_text(problem, optimal, robust, options.output.rows()));
  return ExitCode::success;
}

void declare(CLI::App& app, SolveOptions& options) {
  std::vector<std::string> methods;
  for (const auto& [name, solver] : solvers()) methods.push_back(name);
  app.add_option("--method", options.method,
                 "policy-iteration, value-iteration, modified-policy-iteration or\ntopological-value-iteration")
      ->check(one_of(methods))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--tolerance", options.tolerance,
                 "certified error to reach, as a fraction of max|R|/(1-gamma);\n0: 1e-12, or what rounding allows")
      ->check(real_number({.low = 0, .high = 1, .below = true}))
      ->type_name("X")
      ->capture_default_str();
  app.add_option("--max-sweeps", options.max_sweeps, "passes over the transitions before giving up (exit code 3)")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
  app.add_flag("--robust,--pessimistic", options.robust,
               "also what pessimism, beliefs and attacks come to: pessimistic Q-iteration,\nworst-case values, the "
               "belief game, Stackelberg values");
  app.add_option("--max-iterations", options.limits.max_iterations, "rounds of pessimistic Q-iteration")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--max-positions", options.limits.max_positions, "positions of the belief game")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--max-policies", options.limits.max_policies, "policies of the Stackelberg enumeration")
      ->check(whole_number(1))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--graph", options.graph, "write the model with V* and the best actions as a Graphviz drawing")
      ->type_name("FILE.dot");
  app.add_flag("--force", options.force, "replace FILE.dot if it exists");
}

}  // namespace

void add_solve(CLI::App& app, Task& task) {
  auto options = std::make_shared<SolveOptions>();
  auto* sub =
      app.add_subcommand("solve", "Q*, V* and the best actions; with --robust, what pessimism and attacks cost");
  declare(*sub, options->model);
  declare(*sub, *options);
  declare(*sub, options->output);
  sub->footer(
      "Examples:\n"
      "  maximin solve model.json\n"
      "  maximin solve tiger.POMDP --discount 0.9 --method value-iteration --json\n"
      "  maximin solve model.json --robust --eps 0.5 --norm linf\n"
      "  maximin solve model.json --graph model.dot && dot -Tsvg model.dot -o model.svg");
  sub->callback([options, sub, &task] {
    task = [options, sub] {
      if (options->robust) return solve_robustly(*options);
      refuse_given(*sub, {"--metric", "--norm", "--eps", "--max-iterations", "--max-positions", "--max-policies"},
                   "without --robust", "--robust beside it");
      return solve_plain(*options);
    };
  });
}

}  // namespace maximin::apps
