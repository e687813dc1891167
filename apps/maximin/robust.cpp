#include <maximin/apps/maximin/robust.hpp>

#include <fmt/format.h>
#include <algorithm>

#include <maximin/apps/common/table.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin::apps {

namespace {

RobustSolution::Agent attacked(const Problem& problem, const CertifiedSolution<double>& optimal, Policy policy) {
  RobustSolution::Agent agent;
  agent.attacked = evaluate_against_optimal_attack(problem.model.mdp, problem.perturbation, policy);
  agent.policy = std::move(policy);
  agent.gap = (optimal.v - agent.attacked.v).maxCoeff();
  return agent;
}

const char* fate_word(Fate fate) {
  return fate == Fate::settled ? "settled" : fate == Fate::cycles ? "cycles" : "undetermined";
}

std::string iteration_text(const PessimisticQIteration<double>& run) {
  std::string fate = fmt::format("undetermined after {} rounds", run.iterations);
  if (run.fate == Fate::settled)
    fate = fmt::format("one pair for ever from round {}, Q_n converges", run.periodic_from);
  if (run.fate == Fate::cycles)
    fate = fmt::format("the pairs cycle with period {} from round {}, Q_n does not converge", run.period,
                       run.periodic_from);
  return fmt::format("Pessimistic Q-iteration: {}; {} policy pair{} met.\n", fate, run.pairs.size(),
                     run.pairs.size() == 1 ? "" : "s");
}

/// Who is worth what from the start, and how much is lost at the worst state.
std::string summary_text(const Problem& problem, const CertifiedSolution<double>& optimal,
                         const RobustSolution& robust) {
  const Model<double>& model = problem.model;
  Table table;
  table.column("agent", Align::left).column("under", Align::left);
  table.column("value from start", Align::point).column("most lost of V*", Align::point);
  const auto add = [&](const char* agent, const char* attack, const Values<double>& v, double error) {
    table.row({agent, attack, number(start_mean(model, v), error),
               number((optimal.v - v).maxCoeff(), error + optimal.error)});
  };
  add("optimal", "no attack", optimal.v, optimal.error);
  add("greedy in Q*", "optimal attack", robust.greedy.attacked.v, robust.greedy.attacked.error);
  add("maximin of Q* over the ball", "optimal attack", robust.maximin.attacked.v, robust.maximin.attacked.error);
  add("maximin of the last Q_n over the ball", "optimal attack", robust.pessimistic.attacked.v,
      robust.pessimistic.attacked.error);
  if (robust.belief) add("maximin of Q* over the belief", "any attack", robust.belief->v, robust.belief->error);
  if (robust.stackelberg)
    add("best stationary policy for each state", "optimal attack", robust.stackelberg->v, robust.stackelberg->error);
  std::string text = table.text();
  if (robust.belief) {
    text += fmt::format("The belief game has {} positions (truth, belief); {} beliefs of {} states on average.\n",
                        robust.belief->positions, robust.belief->beliefs, number(robust.belief->mean_size));
  } else {
    text += fmt::format("Belief: not solved ({}).\n", robust.belief_unknown);
  }
  if (!robust.stackelberg) return text + fmt::format("Stackelberg: not solved ({}).\n", robust.stackelberg_unknown);
  return text + fmt::format("Stackelberg: of {} deterministic stationary policies, {} for every start state.\n",
                            robust.stackelberg->policies,
                            robust.stackelberg->one_policy_is_best_everywhere() ? "one is best, as far as can be told,"
                                                                                : "none is best");
}

Json agent_json(const Model<double>& model, const RobustSolution::Agent& agent) {
  Json json;
  json["policy"] = agent.policy;
  json["v"] = to_json(agent.attacked.v);
  json["value_from_start"] = start_mean(model, agent.attacked.v);
  json["gap"] = agent.gap;
  json["attack"] = agent.attacked.attack;
  json["certified_error"] = agent.attacked.error;
  return json;
}

/// The pairs of one period, in the order of the rounds, as indices; null where the fate is not known.
Json recurring_pairs(const PessimisticQIteration<double>& run) {
  if (run.fate == Fate::undetermined) return nullptr;
  const auto first = run.pair_of.begin() + run.periodic_from;
  return std::vector<int>(first, first + run.period);
}

Json iteration_json(const PessimisticQIteration<double>& run) {
  Json json;
  json["fate"] = fate_word(run.fate);
  json["iterations"] = run.iterations;
  json["period"] = run.period;
  json["periodic_from"] = run.periodic_from;
  Json pairs = Json::array();
  for (const PolicyPair& pair : run.pairs) {
    Json one;
    one["policy"] = pair.policy;
    one["attack"] = pair.attack;
    pairs.push_back(std::move(one));
  }
  json["pairs"] = std::move(pairs);
  json["recurring"] = recurring_pairs(run);
  json["q"] = to_json(run.q);
  return json;
}

}  // namespace

RobustSolution solve_robust(const Problem& problem, const CertifiedSolution<double>& optimal,
                            const RobustOptions& options) {
  const auto& mdp = problem.model.mdp;
  const auto& balls = problem.perturbation;
  RobustSolution robust;
  std::vector<double> scratch;
  Policy policy;
  greedy_policy(optimal.q, policy);
  robust.greedy = attacked(problem, optimal, policy);
  maximin_policy(optimal.q, balls, policy, scratch);
  robust.maximin = attacked(problem, optimal, policy);
  PessimisticQIterationOptions<double> iteration;
  iteration.max_iterations = options.max_iterations;
  robust.iteration = pessimistic_q_iteration(mdp, balls, iteration);
  maximin_policy(robust.iteration.q, balls, policy, scratch);
  robust.pessimistic = attacked(problem, optimal, policy);
  try {
    BeliefGameOptions game;
    game.max_positions = options.max_positions;
    robust.belief = solve_belief_game(mdp, balls, maximin_belief_policy(optimal.q), game);
  } catch (const BudgetExhausted& e) {
    robust.belief_unknown = e.what();
  }
  try {
    StackelbergOptions<double> enumeration;
    enumeration.max_policies = options.max_policies;
    robust.stackelberg = stackelberg_values(mdp, balls, enumeration);
  } catch (const BudgetExhausted& e) {
    robust.stackelberg_unknown = e.what();
  }
  return robust;
}

std::string robust_text(const Problem& problem, const CertifiedSolution<double>& optimal, const RobustSolution& robust,
                        std::size_t rows) {
  const Model<double>& model = problem.model;
  Table table;
  table.column("state", Align::left).column("V*", Align::point).column("greedy", Align::point);
  table.column("maximin", Align::point).column("pessimistic", Align::point);
  if (robust.belief) table.column("belief", Align::point);
  if (robust.stackelberg) table.column("Stackelberg", Align::point);
  table.column("maximin does", Align::left).column("is shown", Align::left).column("is made to do", Align::left);
  for (State s = 0; s < model.mdp.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    std::vector<std::string> cells{model.state_name(s), number(optimal.v[s], optimal.error),
                                   number(robust.greedy.attacked.v[s], robust.greedy.attacked.error),
                                   number(robust.maximin.attacked.v[s], robust.maximin.attacked.error),
                                   number(robust.pessimistic.attacked.v[s], robust.pessimistic.attacked.error)};
    if (robust.belief) cells.push_back(number(robust.belief->v[s], robust.belief->error));
    if (robust.stackelberg) cells.push_back(number(robust.stackelberg->v[s], robust.stackelberg->error));
    cells.push_back(model.action_name(robust.maximin.policy[i]));
    cells.push_back(model.state_name(robust.maximin.attacked.attack[i]));
    cells.push_back(model.action_name(robust.maximin.attacked.composed[i]));
    table.row(std::move(cells));
  }
  return fmt::format("{}{}\n{}\nWorst-case value by true state, and the optimal attack on maximin:\n\n{}",
                     balls_line(problem), iteration_text(robust.iteration), summary_text(problem, optimal, robust),
                     table.text(rows));
}

Json robust_json(const Problem& problem, const RobustSolution& robust) {
  const Model<double>& model = problem.model;
  Json json;
  json["balls"] = balls_json(problem);
  json["iteration"] = iteration_json(robust.iteration);
  json["greedy"] = agent_json(model, robust.greedy);
  json["maximin"] = agent_json(model, robust.maximin);
  json["pessimistic"] = agent_json(model, robust.pessimistic);
  json["belief"] = nullptr;
  if (robust.belief) {
    Json& belief = json["belief"];
    belief["v"] = to_json(robust.belief->v);
    belief["value_from_start"] = start_mean(model, robust.belief->v);
    belief["positions"] = robust.belief->positions;
    belief["beliefs"] = robust.belief->beliefs;
    belief["reach"] = robust.belief->reach;
    belief["mean_size"] = robust.belief->mean_size;
    belief["certified_error"] = robust.belief->error;
  }
  json["stackelberg"] = nullptr;
  if (robust.stackelberg) {
    Json& best = json["stackelberg"];
    best["v"] = to_json(robust.stackelberg->v);
    best["policies"] = robust.stackelberg->policies;
    best["best_for_state"] = robust.stackelberg->best_for_state;
    best["one_policy_is_best_everywhere"] = robust.stackelberg->one_policy_is_best_everywhere();
    best["shortfall"] = robust.stackelberg->shortfall;
    best["certified_error"] = robust.stackelberg->error;
  }
  json["unknown"] = Json::array();
  for (const std::string& why : {robust.belief_unknown, robust.stackelberg_unknown}) {
    if (!why.empty()) json["unknown"].push_back(why);
  }
  return json;
}

}  // namespace maximin::apps
