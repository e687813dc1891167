#include <maximin/apps/maximin/agents.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin::apps {

namespace {

constexpr std::size_t largest_policy_file = std::size_t{64} << 20;

/// The words of a list: separated by commas, spaces or line breaks, brackets and quotes left out.
std::vector<std::string> words(const std::string& text) {
  std::vector<std::string> result(1);
  for (const char c : text) {
    if (std::string_view(", \t\r\n[]\"").find(c) == std::string_view::npos) {
      result.back() += c;
    } else if (!result.back().empty()) {
      result.emplace_back();
    }
  }
  if (result.back().empty()) result.pop_back();
  return result;
}

std::string read_text(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::string text;
  text.resize(largest_policy_file + 1);
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (in.bad() || (text.empty() && !in.eof())) throw InputError(path + ": cannot be read, expected a list of actions");
  if (text.size() > largest_policy_file) throw InputError(path + ": larger than 64 MiB, expected a list of actions");
  return text;
}

/// A list of actions, or the "policy" of a JSON object.
std::vector<std::string> policy_words(const std::string& path) {
  const std::string text = read_text(path);
  const auto first = text.find_first_not_of(" \t\r\n");
  if (first == std::string::npos || text[first] != '{') return words(text);
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (json.is_discarded())
    throw InputError(path + ": not valid JSON, expected a list of actions or an object with \"policy\"");
  const auto policy = json.find("policy");
  if (policy == json.end() || !policy->is_array())
    throw InputError(path + ": $.policy: missing, expected a list of actions");
  std::vector<std::string> result;
  for (const auto& action : *policy) result.push_back(action.is_string() ? action.get<std::string>() : action.dump());
  return result;
}

Policy given_policy(const AgentOptions& options, const Model<double>& model) {
  const bool in_file = !options.policy_file.empty();
  const std::string where = in_file ? options.policy_file : "--policy";
  const auto list = in_file ? policy_words(options.policy_file) : words(options.policy);
  if (list.size() != static_cast<std::size_t>(model.mdp.states())) {
    throw InputError(fmt::format("{}: {} actions, expected {}, one for each state that may be observed", where,
                                 list.size(), model.mdp.states()));
  }
  Policy policy;
  for (const std::string& word : list) policy.push_back(find_action(model, word, where));
  return policy;
}

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
    agent.policy = given_policy(options, model);
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
