#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// What an attacker may show: the l-infinity ball of radius eps around the truth, closed, cut to the world (paper,
/// section 2.2). Coordinates are multiples of the quantum, so membership is decided exactly.
class ObservationBall {
 public:
  /// eps is rounded down to a multiple of the quantum. Throws InputError unless 0 <= eps <= 5.
  explicit ObservationBall(double eps) : eps_(gridworld::round_down(eps)) {
    if (!(eps >= 0 && eps <= 5)) {
      throw InputError("eps: " + std::to_string(eps) + ", expected a number from 0 to 5, e.g. 0.1");
    }
  }

  double eps() const { return eps_; }

  /// Whether `shown` may be shown when `truth` is true: within eps and the world, on the grid of the quantum.
  bool contains(Point truth, Point shown) const { return within(truth.x, shown.x) && within(truth.y, shown.y); }

  /// The nearest observation that may be shown. Throws std::invalid_argument when `wanted` is not finite.
  Point project(Point truth, Point wanted) const { return {nearest(truth.x, wanted.x), nearest(truth.y, wanted.y)}; }

  /// Any observation that may be shown, all equally likely. Takes two numbers of the stream.
  Point draw(Point truth, Stream& rng) const {
    const double x = draw(truth.x, rng);
    return {x, draw(truth.y, rng)};
  }

  /// Every true state that may be behind an observation, walls and gold and bomb too.
  Box around(Point shown) const {
    return {shown.x - eps_, shown.x + eps_ + gridworld::quantum, shown.y - eps_, shown.y + eps_ + gridworld::quantum};
  }

  /// The corners of what may be shown when `truth` is true: low and high on each axis.
  double low(double truth) const { return std::max(truth - eps_, 0.0); }
  double high(double truth) const { return std::min(truth + eps_, static_cast<double>(gridworld::side)); }

  /// Whether all that is wrong with `shown` is that it lies between points of the grid.
  bool between_grid(Point truth, Point shown) const {
    return !contains(truth, shown) && contains(truth, {gridworld::round_down(shown.x), gridworld::round_down(shown.y)});
  }

 private:
  static bool on_grid(double v) { return gridworld::round_down(v) == v; }
  bool within(double truth, double shown) const {
    return shown >= low(truth) && shown <= high(truth) && on_grid(shown);
  }
  double nearest(double truth, double wanted) const {
    if (!std::isfinite(wanted)) throw std::invalid_argument("observation: not finite, expected a number");
    return std::clamp(gridworld::round_down(wanted), low(truth), high(truth));
  }
  double draw(double truth, Stream& rng) const {
    return nearest(truth, rng.uniform(low(truth), high(truth) + gridworld::quantum));
  }

  double eps_;
};

}  // namespace maximin
