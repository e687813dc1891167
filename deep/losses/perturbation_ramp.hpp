#pragma once

#include <torch/torch.h>

#include <maximin/deep/loss.hpp>
#include <maximin/deep/output_bounds.hpp>
#include <maximin/deep/range_check.hpp>

namespace maximin::deep {

/// How the radius that a loss defends against grows from 0 to its full size in the course of training. Bounds are wide
/// in a network that was never trained against them, so that the full radius at once drowns what the rewards say.
struct PerturbationRamp {
  enum class Shape {
    linear,
    smoothed,  ///< grows with the fourth power over the first quarter of the ramp, then linearly
  };

  double eps = 0.1;             ///< the full radius, l-infinity
  double start = 0, end = 0.7;  ///< of the ramp, in fractions of training (SA-DQN: 4M of 6M frames)
  Shape shape = Shape::linear;
  StateRange range{};  ///< what states can be

  /// 0 up to `start`, 1 from `end` on.
  double share(const Progress& progress) const;
  double eps_at(const Progress& progress) const { return eps * share(progress); }
  StateBox ball(const torch::Tensor& states, const Progress& progress) const {
    return ball_around(states, eps_at(progress), range);
  }

  /// Throws InputError when one is out of range.
  void check(const RangeCheck& require) const;
};

}  // namespace maximin::deep
