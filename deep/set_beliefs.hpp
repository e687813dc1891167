#pragma once

#include <vector>

#include <maximin/deep/belief_model.hpp>
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

/// What a set belief goes by.
enum class SetBelief {
  ball,   ///< the free part of the ball around what is shown now; no memory (paper, Algorithm 1)
  exact,  ///< everything that the whole history leaves possible, the model of the world being known (BoxBelief)
};

/// A set of places in continuous space, of which K spread evenly by area stand for all, with equal weights.
class SetBeliefs final : public LaneBelief {
 public:
  SetBeliefs(SetBelief kind, const ObservationBall& ball, long states);

  void resize(Lane lanes) override;
  void forget(Lane lane) override { started_[static_cast<std::size_t>(lane)] = false; }
  long states_per_belief() const override { return states_; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override;
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override;
  bool holds(Lane lane, Point truth) const override { return set(lane).contains(truth); }
  double size(Lane lane) const override { return set(lane).area(); }
  long empty_intersections() const override;

  /// The set itself.
  const BoxUnion& set(Lane lane) const { return beliefs_[static_cast<std::size_t>(lane)].belief(); }

 private:
  void advance(BoxBelief& belief, bool started, Action action, Point shown) const;
  BeliefStates all_empty(std::size_t lanes) const;
  void write(const BoxUnion& set, torch::Tensor& states, std::size_t row) const;

  SetBelief kind_;
  long states_;
  BoxBelief fresh_;
  std::vector<BoxBelief> beliefs_;
  std::vector<char> started_;
};

}  // namespace maximin::deep
