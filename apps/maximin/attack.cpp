#include <fmt/format.h>
#include <algorithm>
#include <memory>

#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/agents.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin::apps {

namespace {

struct AttackOptions {
  ModelOptions model;
  AgentOptions agent;
  OutputOptions output;
};

std::string summary_text(const Problem& problem, const CertifiedSolution<double>& optimal,
                         const AttackedValues& values) {
  Table table;
  table.column("attack", Align::left).column("value from start", Align::point).column("most lost of V*", Align::point);
  const auto add = [&](const char* name, const Values<double>& v) {
    table.row({name, number(start_mean(problem.model, v), values.error),
               number((optimal.v - v).maxCoeff(), values.error + optimal.error)});
  };
  add("none", values.none);
  add("random", values.random);
  add("myopic", values.myopic);
  add("optimal", values.optimal);
  const double excess = (values.myopic - values.optimal).maxCoeff();
  const bool costs_nothing = (values.none - values.optimal).maxCoeff() <= 4 * values.error;
  const bool myopic_is_optimal = excess <= 4 * values.error;
  return table.text() +
         (costs_nothing ? "No attack costs this agent anything.\n"
          : myopic_is_optimal
              ? "The myopic attack is optimal here.\n"
              : fmt::format("Planning gains the attacker up to {} over the myopic attack.\n", number(excess)));
}

std::string state_table(const Problem& problem, const StationaryAgent& agent, const AttackedValues& values,
                        std::size_t rows) {
  const Model<double>& model = problem.model;
  Table table;
  table.column("state", Align::left);
  for (const char* attack : {"none", "random", "myopic", "optimal"}) table.column(attack, Align::point);
  table.column("would do", Align::left).column("is shown", Align::left).column("does", Align::left);
  for (State s = 0; s < model.mdp.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    const State shown = values.optimal_attack[i];
    const Action meant = agent.policy[i];
    const Action provoked = agent.policy[static_cast<std::size_t>(shown)];
    table.row({model.state_name(s), number(values.none[s], values.error), number(values.random[s], values.error),
               number(values.myopic[s], values.error), number(values.optimal[s], values.error),
               model.action_name(meant), shown == s ? "the truth" : model.state_name(shown),
               provoked == meant ? "the same" : model.action_name(provoked)});
  }
  return table.text(rows);
}

Json attack_json(const AttackOptions& options, const Problem& problem, const CertifiedSolution<double>& optimal,
                 const StationaryAgent& agent, const AttackedValues& values) {
  Json json;
  json["command"] = "attack";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(problem.model);
  json["balls"] = balls_json(problem);
  json["agent"] = options.agent.agent;
  json["policy"] = agent.policy;
  json["certified_error"] = values.error;
  json["v_star"] = to_json(optimal.v);
  const auto add = [&](const char* name, const Values<double>& v) {
    Json& one = json["attacks"][name];
    one["v"] = to_json(v);
    one["value_from_start"] = start_mean(problem.model, v);
  };
  add("none", values.none);
  add("random", values.random);
  add("myopic", values.myopic);
  add("optimal", values.optimal);
  const auto shown = [&](const char* name, const AttackPolicy& attack) {
    Policy provoked;
    compose(agent.policy, attack, provoked);
    json["attacks"][name]["shown"] = attack;
    json["attacks"][name]["provoked"] = provoked;
  };
  shown("myopic", values.myopic_attack);
  shown("optimal", values.optimal_attack);
  return json;
}

int attack(const AttackOptions& options) {
  const Problem problem = load_problem(options.model);
  const auto optimal = policy_iteration(problem.model.mdp);
  const auto agent = make_agent(options.agent, problem.model, problem.perturbation, optimal);
  const auto values = attacked_values(problem.model.mdp, problem.perturbation, agent);
  if (options.output.json) {
    print(json_text(attack_json(options, problem, optimal, agent, values)));
    return ExitCode::success;
  }
  print(model_line(problem) + balls_line(problem));
  print(fmt::format("Agent: {}.\n\n", agent.about));
  print(summary_text(problem, optimal, values));
  print(fmt::format(
      "\nValue by true state under each attack, certified to {}; what the optimal one shows and provokes:\n\n{}",
      error_number(values.error), state_table(problem, agent, values, options.output.rows())));
  return ExitCode::success;
}

}  // namespace

void add_attack(CLI::App& app, Task& task) {
  auto options = std::make_shared<AttackOptions>();
  auto* sub = app.add_subcommand("attack", "the optimal attack on an agent beside the myopic, the random and none");
  declare(*sub, options->model);
  declare(*sub, options->agent, AgentMemory::none);
  declare(*sub, options->output);
  sub->footer(
      "The attacker shows any state of the ball of the true one. The myopic attack provokes the action of least value "
      "in\n"
      "the next step; the optimal one plans ahead, and no attack on a stationary policy is stronger.\n"
      "Examples:\n"
      "  maximin attack model.json --agent greedy --eps 1\n"
      "  maximin attack model.json --policy 0,1,1,0\n"
      "  maximin solve model.json --json > solved.json && maximin attack model.json --policy-file solved.json");
  sub->callback([options, sub, &task] {
    task = [options, sub] {
      check_agent(*sub);
      return attack(*options);
    };
  });
}

}  // namespace maximin::apps
