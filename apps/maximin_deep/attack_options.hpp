#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <maximin/deep/attacks/named_attack.hpp>
#include <maximin/deep/trained_agent.hpp>

namespace maximin::apps {

/// An agent from its file under an attack by name: what `evaluate` and `watch` share.
struct AttackedAgent {
  std::filesystem::path file;
  std::string attack = "none";
  double eps = -1;  ///< of the attack; negative: what the agent was trained for
  std::filesystem::path
      judge;  ///< whose values adaptive attacks go by; empty: a vanilla agent beside the file, or its own
  deep::ActingChange change;                 ///< how it acts otherwise than it was trained to
  std::optional<std::uint64_t> attack_seed;  ///< 1 unless given
  std::filesystem::path attacker;            ///< where a learned attack is kept
  bool quick = false;
  /// Is told what the work is at, e.g. for how much of its training a learned attack has learned.
  std::function<void(const std::string&)> progress;
};

/// Tells that numbers of learned attacks are quick ones, where they are.
void note_if_quick(const AttackedAgent& options);

/// Throws InputError where an option is given that none of these attacks looks at.
void expect_options_used(const AttackedAgent& options, const std::vector<std::string>& attacks);

/// Declares them, all but the file and the attack.
void add_attack_options(CLI::App& sub, AttackedAgent& options);

/// The agent and the attack, ready to play.
struct Match {
  std::unique_ptr<deep::TrainedAgent> trained;
  deep::Acting acting;
  std::unique_ptr<deep::BeliefAgent> agent;
  std::shared_ptr<deep::GridAttack> attack;
  std::string judge;  ///< whose values an attack on the whole defence goes by; empty where the attack is none
  double eps = 0;
};

/// Throws InputError on a file or a name that there is none of.
Match prepare_match(const AttackedAgent& options);

}  // namespace maximin::apps
