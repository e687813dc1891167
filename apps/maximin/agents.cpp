#include <maximin/apps/maximin/agents.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <map>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/policy_file.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin::apps {

namespace {

std::string fate_text(const PessimisticQIteration<double>& run) {
  if (run.fate == Fate::settled) return fmt::format("settled from round {}", run.periodic_from);
  if (run.fate == Fate::cycles)
    return fmt::format("cycles with period {} from round {}", run.period, run.periodic_from);
  return fmt::format("neither settled nor cycling after {} rounds", run.iterations);
}

StationaryAgent pessimistic_agent(const Model<double>& model, const Perturbation<double>& perturbation) {
  auto run = pessimistic_q_iteration(model.mdp, perturbation);
  // The last pair used is of the Q before the last.
  StationaryAgent agent;
  std::vector<double> scratch;
  maximin_policy(run.q, perturbation, agent.policy, scratch);
  agent.about = fmt::format("maximin over the ball, by the last Q_n of pessimistic Q-iteration ({})", fate_text(run));
  agent.values = std::move(run.q);
  return agent;
}

Values<double> values_of(const FiniteMdp<double>& mdp, const Policy& action, double& error) {
  const auto solution = evaluate_policy(mdp, action);
  error = std::max(error, solution.error);
  return solution.v;
}

}  // namespace

void declare(CLI::App& app, AgentOptions& options, AgentMemory memory) {
  std::vector<std::string> agents{"greedy", "maximin", "pessimistic", "policy"};
  std::string text =
      "greedy: best action of Q* for what is seen; maximin: best worst\naction of Q* over the ball; pessimistic: the "
      "same by "
      "pessimistic\nQ-iteration; policy: as given";
  if (memory == AgentMemory::belief) {
    agents.emplace_back("belief");
    text += "; belief: maximin of Q*\nover the exact belief";
  }
  app.add_option("--agent", options.agent, text)
      ->check(one_of(agents))
      ->type_name("WORD")
      ->capture_default_str()
      ->group("Agent");
  const auto by_policy = [&options](std::string& target) {
    return [&options, &target](const std::string& value) {
      options.agent = "policy";
      target = value;
    };
  };
  auto* list = app.add_option_function<std::string>("--policy", by_policy(options.policy),
                                                    "actions, names or indices, one for each observed state: 0,1,1")
                   ->type_name("LIST")
                   ->group("Agent");
  app.add_option_function<std::string>("--policy-file", by_policy(options.policy_file),
                                       "the same from a file, or from the JSON of maximin solve")
      ->type_name("FILE")
      ->group("Agent")
      ->excludes(list);
}

void check_agent(const CLI::App& app) {
  const CLI::Option& agent = *app.get_option("--agent");
  if (agent.count() == 0 || agent.as<std::string>() == "policy") return;
  refuse_given(app, {"--policy", "--policy-file"}, "beside --agent " + agent.as<std::string>(), "one of the two");
}

StationaryAgent make_agent(const AgentOptions& options, const Model<double>& model,
                           const Perturbation<double>& perturbation, const CertifiedSolution<double>& optimal) {
  if (options.agent == "pessimistic") return pessimistic_agent(model, perturbation);
  StationaryAgent agent;
  agent.values = optimal.q;
  if (options.agent == "greedy") {
    greedy_policy(optimal.q, agent.policy);
    agent.about = "greedy: the best action of Q* for the state it sees";
  } else if (options.agent == "maximin") {
    std::vector<double> scratch;
    maximin_policy(optimal.q, perturbation, agent.policy, scratch);
    agent.about = "maximin: the action of Q* whose worst value over the ball of what it sees is best";
  } else if (options.policy.empty() && options.policy_file.empty()) {
    throw InputError("--agent: policy, expected --policy LIST or --policy-file FILE with it");
  } else {
    agent.policy = options.policy_file.empty() ? policy_of_list(options.policy, model, "--policy")
                                               : read_policy_file(options.policy_file, model);
    agent.about = "the policy given";
  }
  return agent;
}

FiniteMdp<double> under_random_attack(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                                      const Policy& policy) {
  FiniteMdpBuilder<double> builder(mdp.states(), 1, mdp.discount());
  for (State s = 0; s < mdp.states(); ++s) {
    const auto ball = perturbation.ball(s);
    const auto n = static_cast<double>(ball.size());
    std::map<Action, double> chance;
    for (const State t : ball) chance[policy[static_cast<std::size_t>(t)]] += 1;
    std::map<State, double> row;
    double reward = 0;
    for (const auto& [action, count] : chance) {
      reward += count / n * mdp.reward(s, action);
      for (const auto& next : mdp.successors(s, action)) row[next.target] += count / n * next.probability;
    }
    builder.reward(s, 0, reward);
    for (const auto& [target, probability] : row) builder.transition(s, 0, target, probability);
  }
  return std::move(builder).build();
}

AttackedValues attacked_values(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                               const StationaryAgent& agent) {
  AttackedValues result;
  Policy composed;
  result.none = values_of(mdp, agent.policy, result.error);
  const Policy only(agent.policy.size(), 0);
  result.random = values_of(under_random_attack(mdp, perturbation, agent.policy), only, result.error);
  best_response_attack(agent.values, agent.policy, perturbation, result.myopic_attack);
  compose(agent.policy, result.myopic_attack, composed);
  result.myopic = values_of(mdp, composed, result.error);
  auto robust = evaluate_against_optimal_attack(mdp, perturbation, agent.policy);
  result.optimal = std::move(robust.v);
  result.optimal_attack = std::move(robust.attack);
  result.error = std::max(result.error, robust.error);
  return result;
}

}  // namespace maximin::apps
