#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <maximin/deep/report/results.hpp>
#include <maximin/deep/trained_agent.hpp>

namespace maximin::apps {

/// A cell of the defence-by-attack table and how it is made.
struct PlannedCell {
  std::string block;
  deep::ResultCell cell;  ///< titles, the paper's figure, the target; no runs yet
  std::string kind;       ///< of the agent that is trained, e.g. "bp-dqn"; or "sure", deep/sure_agent.hpp
  double trained_eps = 0.1;
  std::string filter_of;      ///< kind of agent whose particle filter it takes; empty: it has its own or none
  std::string config;         ///< JSON that changes the recipe; empty: none
  deep::ActingChange change;  ///< how it acts otherwise than it was trained to
  std::string attack;         ///< name of the attack
  double attack_eps = 0;

  bool is_trained() const { return kind != "sure"; }
};

/// What is to be trained for a cell of an agent that is.
deep::AgentSpec spec_of(const PlannedCell& cell, std::uint64_t seed, const deep::Effort& effort);

/// The paper's table of the continuous Gridworld, its ablation and its noisy environment, each with attacks beside that
/// the paper did not try; and, to choose BP-DQN's aggregator before that table is seen, `aggregators`, on other seeds.
std::vector<PlannedCell> gridworld_plan();
std::vector<PlannedCell> aggregators_plan();

/// Whether a quick table has the cell: those of the larger radius, which show as much as both.
bool is_in_quick_table(const PlannedCell& cell);

/// What stands above a block: how its agents were trained, what its attacks know.
std::string block_note(const std::string& block, const deep::Effort& effort);

/// Cells that follow from others: for every agent and radius the attack, of the paper's or the further ones, that left
/// it least. Replaces the block of that name.
void add_strongest(deep::ResultTable& table);

}  // namespace maximin::apps
