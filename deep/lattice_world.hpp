#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/model.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/concepts.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

/// The lattice of the Gridworld as a world of places, in which deep agents and attacks play and the exact layer says
/// what the best attack is. No LibTorch here.
namespace maximin::deep {

/// The lattice (models/gridworld_lattice.hpp) with its balls. True states and observations are lattice points in no
/// wall; a place is its point, rounded to the quantum grid. Models Environment.
class LatticeWorld {
 public:
  using StateType = Point;
  using ActionType = Action;

  /// Throws InputError as gridworld_lattice.
  explicit LatticeWorld(const GridworldLatticeOptions& options = {});
  LatticeWorld(const LatticeWorld&) = delete;
  LatticeWorld& operator=(const LatticeWorld&) = delete;

  /// Uniform over `starts`.
  Point reset(Stream& rng) const { return place(environment_.reset(rng)); }
  Outcome<Point> step(Point at, Action action, Stream& rng) const;

  Point place(State s) const { return places_[static_cast<std::size_t>(s)]; }
  /// The state that lies there. Throws std::invalid_argument when no lattice point does.
  State state(Point at) const;
  /// The member of B(truth) nearest to a place: what is left of an observation that is no lattice point.
  State nearest_in_ball(State truth, Point wanted) const;

  /// States in which an episode may start: neither gold nor bomb.
  const std::vector<State>& starts() const { return starts_; }
  bool terminal(State s) const { return environment_.terminal(s); }
  const FiniteMdp<double>& mdp() const { return model_.mdp; }
  const Perturbation<double>& balls() const { return balls_; }
  const GridworldLatticeOptions& options() const { return options_; }

 private:
  GridworldLatticeOptions options_;
  Model<double> model_;
  Perturbation<double> balls_;
  TabularEnvironment<double> environment_;
  int per_axis_;
  std::vector<Point> places_;
  std::vector<State> state_at_;  // by row and column of lattice points; -1 in walls
  std::vector<State> starts_;
};

/// The lattice world that starts in each of its starts in turn, over and over: what happens to every start, rather than
/// to a sample. The world must outlive it.
class EveryStart {
 public:
  using StateType = Point;
  using ActionType = Action;

  explicit EveryStart(const LatticeWorld& world) : world_(&world) {}
  Point reset(Stream&) { return world_->place(world_->starts()[next_++ % world_->starts().size()]); }
  Outcome<Point> step(Point at, Action action, Stream& rng) const { return world_->step(at, action, rng); }

 private:
  const LatticeWorld* world_;
  std::size_t next_ = 0;
};

/// An attack of the continuous world on the lattice: what it wants to show is rounded to the nearest lattice point in
/// the ball, and so is what it asks the agent about. The world and the attack must outlive it.
class OnLattice final : public WrappedAttack {
 public:
  OnLattice(GridAttack& attack, const LatticeWorld& world) : WrappedAttack(attack), world_(&world) {}
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  const LatticeWorld* world_;
};

/// Any attack on the lattice, held to the rules: throws std::logic_error when it shows something else than a lattice
/// point in the ball. The world and the attack must outlive it.
class WithinLatticeBall final : public WrappedAttack {
 public:
  WithinLatticeBall(GridAttack& attack, const LatticeWorld& world) : WrappedAttack(attack), world_(&world) {}
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  const LatticeWorld* world_;
};

}  // namespace maximin::deep
