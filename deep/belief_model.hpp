#pragma once

#include <span>

#include <torch/torch.h>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/rollout_in_step.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

/// What is held possible in n lanes: K states for each, with weights that sum to 1. States are tensors, so that a state
/// may be a place or, later, an image.
/// Contiguous floats on the CPU.
struct BeliefStates {
  torch::Tensor states;   ///< [n, K, state...]
  torch::Tensor weights;  ///< [n, K]
};

/// A belief model (the paper's M_t) for many episodes in step: the ball, the exact set, a particle filter, later a
/// purifier of images.
class LaneBelief {
 public:
  LaneBelief() = default;
  virtual ~LaneBelief() = default;
  LaneBelief(const LaneBelief&) = delete;
  LaneBelief& operator=(const LaneBelief&) = delete;

  /// Lanes 0 to n-1, all before their first observation.
  virtual void resize(Lane lanes) = 0;
  /// The lane is before its first observation again.
  virtual void forget(Lane lane) = 0;
  /// K, states per belief; the same at all times.
  virtual long states_per_belief() const = 0;

  /// Takes what is shown in these lanes, each at most once, and the actions taken there since the last observation
  /// (ignored in a lane before its first). Returns the new beliefs, in the same order.
  virtual BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                              std::span<const Point> shown) = 0;

  /// What `update` would return; nothing is remembered. Lanes may occur many times.
  virtual BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                            std::span<const Point> shown) const = 0;

  /// Whether the lane's belief holds the state possible.
  virtual bool holds(Lane lane, Point truth) const = 0;
  /// The area of the lane's belief; the number of its states where a world has finitely many.
  virtual double size(Lane lane) const = 0;
  /// How often since `resize` prediction and observation did not meet.
  virtual long empty_intersections() const { return 0; }
};

}  // namespace maximin::deep
