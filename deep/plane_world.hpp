#pragma once

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/concepts.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

/// What a network is trained in: any world whose states are points of the plane. No LibTorch here.
namespace maximin::deep {

/// A world of points. Models Environment.
class PlaneWorld {
 public:
  using StateType = Point;
  using ActionType = Action;

  PlaneWorld() = default;
  virtual ~PlaneWorld() = default;
  PlaneWorld(const PlaneWorld&) = delete;
  PlaneWorld& operator=(const PlaneWorld&) = delete;

  /// |A|: actions are 0 to |A| - 1.
  virtual Action actions() const = 0;
  virtual Point reset(Stream& rng) const = 0;
  virtual Outcome<Point> step(Point at, Action action, Stream& rng) const = 0;
};

/// The continuous Gridworld as such a world.
class GridworldPlane final : public PlaneWorld {
 public:
  explicit GridworldPlane(const ContinuousGridworld& world = ContinuousGridworld()) : world_(world) {}

  Action actions() const override { return ContinuousGridworld::actions; }
  Point reset(Stream& rng) const override { return world_.reset(rng); }
  Outcome<Point> step(Point at, Action action, Stream&) const override { return world_.step(at, action); }

 private:
  ContinuousGridworld world_;
};

}  // namespace maximin::deep
