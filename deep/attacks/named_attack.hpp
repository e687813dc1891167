#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/q_network.hpp>

namespace maximin::deep {

/// What an attack goes by, weakest first: the true state alone; the network too; belief and aggregator and all.
enum class Knowledge { truth, network, defence };

/// An attack by its name on the command line.
struct NamedAttack {
  std::string name;
  std::string title;  ///< in tables
  Knowledge knows = Knowledge::truth;
  bool learned = false;   ///< is trained, for minutes, against one agent
  bool in_paper = false;  ///< a column of the paper's table
};

/// All of them, weakest knowledge first.
const std::vector<NamedAttack>& named_attacks();
/// Their names, in the same order.
std::vector<std::string> attack_names();

/// The attack of this name. Throws InputError on a name that there is none of, naming the nearest.
const NamedAttack& attack_named(const std::string& name);

/// Whom an attack is made for.
struct AttackTarget {
  /// The network that the paper's attacks differentiate, and know nothing beyond; in rewards, as the judge.
  std::shared_ptr<ActionValueModule> values;
  /// What the adaptive attacks take for the value of an action when s is true.
  std::shared_ptr<ActionValueModule> judge;
  /// Tells the agent, its weights and its judge from all others: a learned attack is one agent's.
  std::string identity;
  /// A twin of the agent, for learned attacks to learn against.
  std::function<std::unique_ptr<GridAgent>()> twin;
  /// What one reward is in the values that the agent goes by.
  double unit = 1;
  /// Where it plays.
  GridworldOptions world = {};
};

struct AttackSetting {
  std::string name = "none";
  double eps = 0.1;
  std::uint64_t seed = 1;                                     ///< of a learned attack's training
  bool quick = false;                                         ///< learned attacks learn for seconds
  std::filesystem::path file;                                 ///< where a learned attack is kept; empty: nowhere
  std::function<bool(double share, double reward)> progress;  ///< of its training; false stops it
};

/// Makes the attack; a learned one is read from its file, or trained and written there. Empty where `progress` stopped
/// it.
std::shared_ptr<GridAttack> make_attack(const AttackSetting& setting, const AttackTarget& target);

}  // namespace maximin::deep
