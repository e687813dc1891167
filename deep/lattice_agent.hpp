#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/aggregate.hpp>
#include <maximin/deep/lattice_world.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

/// What an agent on the lattice takes for possible.
enum class LatticeMemory {
  observed,  ///< what it is shown: it knows of no attacker, as a plain DQN
  ball,      ///< the ball around what it is shown
  exact,     ///< all that its history leaves possible
};

/// How an agent on the lattice decides: a table of the lattice and an aggregator, or anything else that acts on a
/// belief.
struct LatticeMind {
  LatticeMemory memory = LatticeMemory::exact;
  BeliefPolicy policy;
};

/// Action values at each lattice point, [states, actions]: the network's, in its units.
QTable<double> values_on_lattice(ActionValueModule& q, const LatticeWorld& world);

/// The mind of a deep agent: argmax_a Aggregate_{m in M} q(m, a), all members of the belief with the same weight; of
/// equals the first. Gold and bomb are no part of a belief, since the episode goes on; only an agent who believes what
/// it is shown takes them as they are. The world must outlive it.
LatticeMind deep_mind(QTable<double> q, const AnyAggregator& aggregator, LatticeMemory memory,
                      const LatticeWorld& world);

/// An agent with such a mind in many lanes. What it is shown must be lattice points (std::invalid_argument). Takes no
/// random numbers. The world must outlive it.
class LatticeAgent final : public GridAgent {
 public:
  LatticeAgent(const LatticeWorld& world, LatticeMind mind) : world_(&world), mind_(std::move(mind)) {}

  void resize(Lane lanes) override;
  void forget(Lane lane) override;
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) override;
  void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const override;
  Mind mind(Lane lane) const override;

  /// The belief that the observation would lead to in the lane now.
  Belief would_believe(Lane lane, State shown) const;
  const LatticeMind& mind() const { return mind_; }

 private:
  struct Memory {
    Belief belief;  // empty before the first observation
    Action last = 0;
  };

  const LatticeWorld* world_;
  LatticeMind mind_;
  std::vector<Memory> lanes_;
};

}  // namespace maximin::deep
