#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include <maximin/deep/plane_world.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/metric.hpp>

/// Finite models whose states are points of the plane, as worlds for networks: there the exact layer knows what a
/// trained network is worth. No LibTorch here.
namespace maximin::deep {

/// Which state stands where. A place is looked up by its exact coordinates, or by those that a network sees.
class Places {
 public:
  /// Row s of `points`, |S| x 2, is the place of state s. Throws InputError when there are other than two columns, or
  /// two places are the same once rounded to float.
  explicit Places(const Metric<double>::Points& points);

  State states() const { return static_cast<State>(points_.size()); }
  Point point(State s) const { return points_[static_cast<std::size_t>(s)]; }

  /// The state that stands exactly there. Throws InputError when there is none.
  State state_at(Point place) const;
  /// The state whose place is this once rounded to float. Throws InputError when there is none.
  State state_at(float x, float y) const;

 private:
  static std::uint64_t key(float x, float y);

  std::vector<Point> points_;
  std::unordered_map<std::uint64_t, State> state_of_;
};

/// A finite model as a world of points: draws from the stream what TabularEnvironment draws. Environment and places
/// must outlive it.
class PlacesWorld final : public PlaneWorld {
 public:
  /// Throws InputError when there is not one place for each state.
  PlacesWorld(const TabularEnvironment<double>& environment, const Places& places);

  Action actions() const override { return environment_->mdp().actions(); }
  Point reset(Stream& rng) const override { return places_->point(environment_->reset(rng)); }
  /// Throws InputError when no state stands at that point.
  Outcome<Point> step(Point at, Action action, Stream& rng) const override;

 private:
  const TabularEnvironment<double>* environment_;
  const Places* places_;
};

}  // namespace maximin::deep
