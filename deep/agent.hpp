#pragma once

#include <memory>
#include <span>
#include <utility>

#include <maximin/deep/report/trace.hpp>
#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/rollout_in_step.hpp>
#include <maximin/theory/types.hpp>

/// What the deep layer's agents and attacks have in common. No LibTorch here.
namespace maximin::deep {

/// What an adaptive attack reads of an agent's memory in one lane.
struct Mind {
  bool awake = false;      ///< has seen something of this episode; if not, the rest says nothing
  Action last_action = 0;  ///< its last
  Point mean;              ///< of what it held possible when it took it
  Box hull;                ///< the smallest box around that
};

/// An agent that acts in many episodes of the Gridworld at once and whose mind can be read. Models AgentInStep.
class GridAgent {
 public:
  using ObservationType = Point;
  using ActionType = Action;

  GridAgent() = default;
  virtual ~GridAgent() = default;
  GridAgent(const GridAgent&) = delete;
  GridAgent& operator=(const GridAgent&) = delete;

  virtual void resize(Lane lanes) = 0;
  virtual void forget(Lane lane) = 0;
  virtual void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
                   std::span<Action> actions) = 0;

  /// What the agent would do in these lanes if it were shown this now; nothing is remembered. A lane may occur many
  /// times: that is how an adaptive attack looks for the observation to show.
  virtual void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const = 0;

  /// What it has in mind in this lane. An agent without memory has nothing.
  virtual Mind mind(Lane) const { return {}; }

  /// For whoever watches it play, right after it acted in a lane: is this place possible to it, what is the area of
  /// those that are, and how do they look; and how often, over all lanes, was nothing left possible.
  virtual bool holds(Lane, Point) const { return false; }
  virtual double belief_size(Lane) const { return 0; }
  virtual TraceBelief picture(Lane) const { return {}; }
  virtual long empty_intersections() const { return 0; }
};

/// Whoever perturbs what an agent of the Gridworld sees. Models AttackInStep.
class GridAttack {
 public:
  GridAttack() = default;
  virtual ~GridAttack() = default;
  GridAttack(const GridAttack&) = delete;
  GridAttack& operator=(const GridAttack&) = delete;

  virtual void resize(Lane) {}
  virtual void forget(Lane) {}
  /// Fills shown[k], what the agent will see in lane lanes[k] where truths[k] is true; draws from streams[lanes[k]].
  /// It must be what ObservationBall::project gives back: within eps, inside the world, on the grid of the quantum.
  virtual void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                       std::span<Stream> streams, std::span<Point> shown) = 0;
};

/// An attack made of another one, which it keeps, or which must outlive it: when it forgets, so does that.
class WrappedAttack : public GridAttack {
 public:
  explicit WrappedAttack(GridAttack& attack) : attack_(&attack) {}
  explicit WrappedAttack(std::shared_ptr<GridAttack> attack) : attack_(attack.get()), kept_(std::move(attack)) {}
  void resize(Lane lanes) override { attack_->resize(lanes); }
  void forget(Lane lane) override { attack_->forget(lane); }

 protected:
  GridAttack& attack() const { return *attack_; }

 private:
  GridAttack* attack_;
  std::shared_ptr<GridAttack> kept_;
};

}  // namespace maximin::deep
