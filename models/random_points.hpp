#pragma once

#include <maximin/theory/metric.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// Where the states of a random model lie.
enum class PointLayout {
  uniform,  ///< uniform in a box, no two nearer than `uniform_spacing`
  lattice,  ///< distinct points of the coarsest regular lattice of the box that has enough of them, in random order
  line,     ///< equally spaced along the first axis, in order
};

/// The distance that random_points keeps between any two points of `PointLayout::uniform`, in every norm:
/// 0.3 side / m, where m is the least integer with m^dimension >= states.
double uniform_spacing(State states, int dimension, double side);

/// `states` distinct points (one per row) in the box [0, side]^dimension. Throws InputError unless states >= 1,
/// 1 <= dimension <= 16 and side is positive and finite.
Metric<double>::Points random_points(PointLayout layout, State states, int dimension, double side, Stream& rng);

/// Groups of two to four points, each group inside a box of side `group_side`, the groups spread over
/// [0, side]^dimension: a wide space whose balls of radius about `group_side` still hold more than one state. Points of
/// a group are at least group_side / 10 apart. The first points of the first two groups lie at the two ends of the
/// first axis, so that the diameter is at least `side` when there are two states or more.
/// Throws InputError unless states >= 1, 1 <= dimension <= 16 and 0 < group_side < side, all finite.
Metric<double>::Points grouped_points(State states, int dimension, double side, double group_side, Stream& rng);

}  // namespace maximin
