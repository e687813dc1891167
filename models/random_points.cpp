#include <maximin/models/random_points.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <fmt/format.h>

namespace maximin {
namespace {

using Points = Metric<double>::Points;

void check(State states, int dimension, double side) {
  if (states < 1) throw InputError(fmt::format("states: {}, expected at least 1", states));
  if (dimension < 1 || dimension > 16) {
    throw InputError(fmt::format("dimension: {}, expected 1 to 16", dimension));
  }
  if (!(side > 0 && std::isfinite(side))) {
    throw InputError(fmt::format("side: {}, expected a positive finite number", side));
  }
}

/// The least m with m^dimension >= states. Integers only: the same on every machine.
std::int64_t points_per_axis(State states, int dimension) {
  for (std::int64_t m = 1;; ++m) {
    std::int64_t cells = 1;
    for (int i = 0; i < dimension && cells < states; ++i) cells *= m;
    if (cells >= states) return m;
  }
}

/// Whether row s is at least `spacing` from rows first .. s-1 in the maximum norm, hence in l1 and l2 as well.
bool is_apart(const Points& points, Eigen::Index first, Eigen::Index s, double spacing) {
  for (Eigen::Index t = first; t < s; ++t) {
    if ((points.row(s) - points.row(t)).cwiseAbs().maxCoeff() < spacing) return false;
  }
  return true;
}

void draw_in_box(Points& points, Eigen::Index s, double side, Stream& rng) {
  for (Eigen::Index i = 0; i < points.cols(); ++i) points(s, i) = rng.uniform(0, side);
}

/// At spacing 0.3 side / m the boxes around all earlier points cover at most 0.6^dimension of the box, so that a draw
/// succeeds with probability at least 0.4.
Points uniform_points(State states, int dimension, double side, Stream& rng) {
  const double spacing = uniform_spacing(states, dimension, side);
  Points points(states, dimension);
  for (Eigen::Index s = 0; s < states; ++s) {
    do draw_in_box(points, s, side, rng);
    while (!is_apart(points, 0, s, spacing));
  }
  return points;
}

/// Distinct cells of the lattice, by rejection.
Points lattice_points(State states, int dimension, double side, Stream& rng) {
  const std::int64_t m = points_per_axis(states, dimension);
  const double step = m > 1 ? side / static_cast<double>(m - 1) : 0;
  Points points(states, dimension);
  for (Eigen::Index s = 0; s < states; ++s) {
    do {
      for (Eigen::Index i = 0; i < dimension; ++i) points(s, i) = step * rng.below(static_cast<int>(m));
    } while (!is_apart(points, 0, s, step / 2));
  }
  return points;
}

Points line_points(State states, int dimension, double side) {
  Points points = Points::Zero(states, dimension);
  for (Eigen::Index s = 0; s < states; ++s) {
    points(s, 0) = states == 1 ? 0 : side * static_cast<double>(s) / (states - 1);
  }
  return points;
}

}  // namespace

double uniform_spacing(State states, int dimension, double side) {
  check(states, dimension, side);
  return 0.3 * side / static_cast<double>(points_per_axis(states, dimension));
}

Points random_points(PointLayout layout, State states, int dimension, double side, Stream& rng) {
  check(states, dimension, side);
  switch (layout) {
    case PointLayout::lattice:
      return lattice_points(states, dimension, side, rng);
    case PointLayout::line:
      return line_points(states, dimension, side);
    case PointLayout::uniform:
      break;
  }
  return uniform_points(states, dimension, side, rng);
}

Points grouped_points(State states, int dimension, double side, double group_side, Stream& rng) {
  check(states, dimension, side);
  if (!(group_side > 0 && group_side < side)) {
    throw InputError("group_side: expected a number above 0 and below side");
  }
  constexpr int max_attempts = 32;  // a crowded box has to let groups meet
  Points points(states, dimension);
  Eigen::Index s = 0;
  for (int group = 0; s < states; ++group) {
    const Eigen::Index first = s;
    const Eigen::Index last = group == 0 ? std::max(1, states - 1) : states;  // leave one for a second group
    const Eigen::Index end = std::min<Eigen::Index>(last, s + rng.integer(2, 4));
    int attempts = 0;
    do {
      draw_in_box(points, first, side, rng);
      if (group < 2) points(first, 0) = group == 0 ? 0 : side;
    } while (!is_apart(points, 0, first, group_side / 10) && ++attempts < max_attempts);
    const Eigen::RowVectorXd corner = points.row(first);
    for (++s; s < end; ++s) {
      do {
        for (Eigen::Index i = 0; i < dimension; ++i) points(s, i) = corner[i] + rng.uniform(0, group_side);
      } while (!is_apart(points, first, s, group_side / 10));
    }
  }
  return points;
}

}  // namespace maximin
