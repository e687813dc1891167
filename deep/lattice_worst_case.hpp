#pragma once

#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <maximin/deep/lattice_agent.hpp>
#include <maximin/deep/lattice_world.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/tabular/finite_horizon.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

struct WorstCaseOptions {
  /// The total reward of so many steps, not discounted; 0: the return for ever, discounted as the lattice's model.
  long steps = ContinuousGridworld::horizon;
  long max_positions = 200'000;  ///< of an agent with an exact belief, before BudgetExhausted is thrown
  bool keep = false;             ///< also what the optimal attack needs to know: memory for steps * positions numbers
};

/// The ceiling of all attacks: the exact worst-case return on the lattice of an agent with a given mind, over all
/// attackers who keep to the ball, know the truth, the agent, its belief and the clock, and plan ahead. By the game on
/// (truth, belief) where the agent has an exact belief, by the attacker's own control problem where it remembers
/// nothing.
class LatticeWorstCase {
 public:
  /// Throws BudgetExhausted when there are too many positions, InputError on negative steps. The world must outlive it.
  LatticeWorstCase(const LatticeWorld& world, const LatticeMind& mind, const WorstCaseOptions& options = {});

  /// Worst-case return from each state, |S|; 0 where the episode is over.
  const Values<double>& v() const { return v_; }
  double error() const { return error_; }  ///< of any entry of v
  /// Over all starts, each as likely as the next.
  double mean() const;
  double least() const;

  /// Pairs (truth, belief) that can be reached, and beliefs among them. An agent without memory has as many as states.
  long positions() const { return positions_; }
  long beliefs() const { return beliefs_; }
  const WorstCaseOptions& options() const { return options_; }

  /// What is left at worst when `shown` is shown in state `truth`, which makes the agent believe `belief`, and `left`
  /// steps are left (ignored for ever). Needs `keep` (std::logic_error). Throws std::out_of_range on a belief that an
  /// agent of this mind never holds there.
  double after(State truth, State shown, const Belief& belief, long left) const;

 private:
  void solve_without_memory(const LatticeMind& mind);
  void solve_with_belief(const LatticeMind& mind);

  const LatticeWorld* world_;
  WorstCaseOptions options_;
  Values<double> v_;
  double error_ = 0;
  long positions_ = 0, beliefs_ = 0;
  Policy stationary_;                  // by what is shown, of an agent without memory; else empty
  std::vector<Values<double>> value_;  // by steps left (one entry: for ever), by state or number of position
  std::map<std::pair<State, Belief>, int> numbers_;
};

/// The optimal attack itself: shows the state of least worst-case return, in every lane. Against another agent than a
/// LatticeAgent of the very mind that was solved for it throws std::invalid_argument or std::out_of_range, or is just
/// some attack. World and solution must outlive it.
class OptimalLatticeAttack final : public GridAttack {
 public:
  /// Throws std::logic_error when the solution was not kept.
  OptimalLatticeAttack(const LatticeWorstCase& solution, const LatticeWorld& world);

  void resize(Lane lanes) override { taken_.assign(static_cast<std::size_t>(lanes), 0); }
  void forget(Lane lane) override { taken_[static_cast<std::size_t>(lane)] = 0; }
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  const LatticeWorstCase* solution_;
  const LatticeWorld* world_;
  std::vector<long> taken_;  // steps of each lane's episode
};

/// Plays `rounds` episodes from every start of the lattice, in order of starts, then rounds; episode k draws from
/// Stream(seed, k). Totals of `horizon` steps and discounted as the lattice's model. Throws std::logic_error when the
/// attack leaves the ball.
std::vector<Episode> play_every_start(const LatticeWorld& world, GridAgent& agent, GridAttack& attack, long rounds,
                                      std::uint64_t seed, long horizon = ContinuousGridworld::horizon);

}  // namespace maximin::deep
