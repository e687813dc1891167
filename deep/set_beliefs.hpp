#pragma once

#include <span>
#include <vector>

#include <maximin/deep/filter_beliefs.hpp>
#include <maximin/gridworld/box_belief.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// No doubt at all: what is shown is believed. K = 1.
class ObservedState final : public LaneBelief {
 public:
  void resize(Lane lanes) override { shown_.assign(static_cast<std::size_t>(lanes), {}); }
  void forget(Lane) override {}
  long states_per_belief() const override { return 1; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override;
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override;
  bool holds(Lane lane, Point truth) const override { return shown_[static_cast<std::size_t>(lane)] == truth; }
  double size(Lane) const override { return 0; }

 private:
  std::vector<Point> shown_;
};

/// A set of places in continuous space, of which K spread evenly by area stand for all, with equal weights: the free
/// part of the ball, or what BoxBelief keeps.
class SetBeliefs final : public FilterBeliefs<BoxBelief> {
 public:
  SetBeliefs(SetBelief kind, const ObservationBall& ball, long states, const GridworldOptions& world = {});

  bool holds(Lane lane, Point truth) const override { return set(lane).contains(truth); }
  double size(Lane lane) const override { return set(lane).area(); }

  /// The set itself.
  const BoxUnion& set(Lane lane) const { return filter(lane).belief(); }

 private:
  void begin(BoxBelief& filter, Point shown) const override { filter.reset(shown); }
  void go_on(BoxBelief& filter, Action action, Point shown) const override { filter.update(action, shown); }
  void write(const BoxBelief& filter, BeliefStates& out, std::size_t row) const override;
};

}  // namespace maximin::deep
