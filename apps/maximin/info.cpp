#include <fmt/format.h>
#include <algorithm>
#include <memory>

#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/transition_graph.hpp>
#include <maximin/theory/bounds.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin::apps {

namespace {

struct InfoOptions {
  ModelOptions model;
  OutputOptions output;
};

/// What is found out about a model.
struct Info {
  ModelConstants<double> constants;
  StrongComponents components;
  std::vector<State> reachable;  ///< from the start
  std::vector<long> ball_sizes;  ///< ball_sizes[k]: balls of k states
};

Info examine_model(const Problem& problem) {
  const Model<double>& model = problem.model;
  Info info;
  info.constants = model_constants(model.mdp, problem.perturbation.metric());
  const Adjacency graph = transition_graph(model.mdp);
  info.components = strong_components(graph);
  std::vector<State> starts;
  for (State s = 0; s < model.mdp.states(); ++s) {
    if (model.start.empty() || model.start[static_cast<std::size_t>(s)] > 0) starts.push_back(s);
  }
  info.reachable = reachable_states(graph, starts);
  info.ball_sizes.resize(static_cast<std::size_t>(problem.perturbation.largest_ball()) + 1);
  for (State s = 0; s < model.mdp.states(); ++s) ++info.ball_sizes[problem.perturbation.ball(s).size()];
  return info;
}

std::size_t largest_component(const StrongComponents& components) {
  std::size_t largest = 0;
  for (const auto& members : components.members) largest = std::max(largest, members.size());
  return largest;
}

std::string constants_text(const Model<double>& model, const ModelConstants<double>& constants) {
  Table table;
  table.column("constant", Align::left).column("value", Align::point).column("attained by", Align::left);
  const auto add = [&](const char* name, const LipschitzConstant<double>& c) {
    std::string witness = "every difference is 0";
    if (c.s1 != c.s2) {
      witness = fmt::format("{} and {}, action {}", model.state_name(c.s1), model.state_name(c.s2),
                            model.action_name(c.action));
      if (c.target >= 0) witness += fmt::format(", to {}", model.state_name(c.target));
    }
    if (c.infinite) witness += ", which are at distance 0";
    table.row({name, c.infinite ? "inf" : number(c.value), std::move(witness)});
  };
  add("l_r, of the rewards", constants.l_r);
  add("l_p, of each probability", constants.l_p);
  add("K, in total variation", constants.k_tv);
  return table.text();
}

std::string info_text(const Problem& problem, const Info& info) {
  const Model<double>& model = problem.model;
  const auto& c = info.constants;
  std::string text = model_line(problem) + balls_line(problem);
  text += fmt::format("Rewards: {} to {}, span {}; no two policies differ by more than {} in Q.\n", number(c.r_min),
                      number(c.r_max_signed), number(c.span), number(bounds::trivial(model.mdp.discount(), c.span)));
  text += fmt::format(
      "Transition graph: {} strongly connected component{}, the largest of {} states; {} of {} states are "
      "reached from the start{}.\n",
      info.components.count(), info.components.count() == 1 ? "" : "s", largest_component(info.components),
      info.reachable.size(), model.mdp.states(), model.start.empty() ? " (uniform)" : "");
  text += "\nLipschitz constants under this metric:\n\n" + constants_text(model, c) + "\nBall sizes:\n\n";
  Table table;
  table.column("states in the ball").column("balls");
  for (std::size_t k = 1; k < info.ball_sizes.size(); ++k) {
    if (info.ball_sizes[k] > 0) table.row({std::to_string(k), std::to_string(info.ball_sizes[k])});
  }
  return text + table.text();
}

Json constant_json(const LipschitzConstant<double>& c) {
  Json json;
  json["value"] = c.infinite ? Json(nullptr) : Json(c.value);
  json["infinite"] = c.infinite;
  json["s1"] = c.s1;
  json["s2"] = c.s2;
  json["action"] = c.action;
  if (c.target >= 0) json["target"] = c.target;
  return json;
}

Json info_json(const Problem& problem, const Info& info) {
  const auto& c = info.constants;
  Json json;
  json["command"] = "info";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(problem.model);
  json["balls"] = balls_json(problem);
  json["r_min"] = c.r_min;
  json["r_max"] = c.r_max_signed;
  json["r_max_absolute"] = c.r_max;
  json["span"] = c.span;
  json["l_r"] = constant_json(c.l_r);
  json["l_p"] = constant_json(c.l_p);
  json["k_tv"] = constant_json(c.k_tv);
  json["strong_components"] = info.components.count();
  json["largest_component"] = largest_component(info.components);
  json["component_of_state"] = info.components.component;
  json["reachable_states"] = info.reachable.size();
  return json;
}

int info(const InfoOptions& options) {
  const Problem problem = load_problem(options.model);
  const Info found = examine_model(problem);
  print(options.output.json ? json_text(info_json(problem, found)) : info_text(problem, found));
  return ExitCode::success;
}

}  // namespace

void add_info(CLI::App& app, Task& task) {
  auto options = std::make_shared<InfoOptions>();
  auto* sub = app.add_subcommand("info", "sizes, Lipschitz constants with the pairs that attain them, balls, graph");
  declare(*sub, options->model);
  declare(*sub, options->output);
  sub->footer(
      "Examples:\n"
      "  maximin info model.json\n"
      "  maximin info FrozenLake.json --metric hops --eps 2 --json");
  sub->callback([options, &task] { task = [options] { return info(*options); }; });
}

}  // namespace maximin::apps
