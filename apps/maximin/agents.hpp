#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include <maximin/models/model.hpp>
#include <maximin/tabular/certified.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::apps {

/// Which agent a command line asks for.
struct AgentOptions {
  std::string agent = "maximin";  ///< greedy, maximin, pessimistic, policy, or belief where that is allowed
  std::string policy;             ///< list of actions, one per observed state
  std::string policy_file;        ///< file that holds such a list, or the JSON of `maximin solve`
};

/// Whether an agent may remember.
enum class AgentMemory {
  none,    ///< stationary policies only
  belief,  ///< also the agent that holds the exact belief
};

/// Adds --agent, --policy and --policy-file.
void declare(CLI::App& app, AgentOptions& options, AgentMemory memory);

/// Refuses a policy beside an agent that takes none. Throws InputError.
void check_agent(const CLI::App& app);

/// A stationary agent and the action values by which the myopic attacker judges what it provokes.
struct StationaryAgent {
  Policy policy;          ///< by observation
  QTable<double> values;  ///< Q* (greedy, maximin, policy) or the last Q_n (pessimistic)
  std::string about;      ///< one line for people
};

/// The agent asked for: greedy in Q*, maximin over the ball of Q*, the last policy of pessimistic Q-iteration, or a
/// policy given. Throws InputError when the policy does not fit the model.
StationaryAgent make_agent(const AgentOptions& options, const Model<double>& model,
                           const Perturbation<double>& perturbation, const CertifiedSolution<double>& optimal);

/// The model as the policy meets it under a random attack: one action, P and R averaged over the ball.
FiniteMdp<double> under_random_attack(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                                      const Policy& policy);

/// What a stationary agent is worth under each stationary attack, by true state.
struct AttackedValues {
  Values<double> none, random, myopic, optimal;
  AttackPolicy myopic_attack, optimal_attack;
  double error = 0;  ///< largest certified error of the four
};

AttackedValues attacked_values(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                               const StationaryAgent& agent);

}  // namespace maximin::apps
