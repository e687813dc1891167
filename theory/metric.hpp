#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <variant>

#include <maximin/theory/error.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The norm that turns points into distances (the paper's l_p ball).
enum class Norm { l1, l2, linf };

/// As model files and command lines write it.
inline const char* norm_name(Norm norm) {
  return norm == Norm::l1 ? "l1" : norm == Norm::l2 ? "l2" : "linf";
}

/// A distance on the states: |x_s - x_t| of the paper. Symmetric, zero from a state to itself, never negative, and
/// obeys the triangle inequality (the factor 2 eps of Lemma 2 rests on it). May be infinite between states that no path
/// joins, and zero between distinct states; then the Lipschitz constants say so.
template <class Scalar>
class Metric {
 public:
  using Points = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Distances between points: row s of `points` (|S| x d, d >= 1) is x_s.
  /// Throws InputError when a coordinate is not finite, there is none, or they are so far apart that a distance could
  /// overflow. l2 distances neither overflow nor underflow where the distance itself does not.
  static Metric from_points(Points points, Norm norm) {
    if (points.rows() < 1 || points.cols() < 1) throw InputError("points: empty, expected one point per state");
    if constexpr (!is_exact_v<Scalar>) {
      for (Eigen::Index s = 0; s < points.rows(); ++s) {
        if (!points.row(s).allFinite()) {
          throw InputError("points[" + std::to_string(s) + "]: not finite, expected finite coordinates");
        }
      }
      const Points box = points.colwise().maxCoeff() - points.colwise().minCoeff();
      if (!box.allFinite() || !is_finite_length(box, norm)) {
        throw InputError("points: so far apart that distances overflow, expected smaller coordinates");
      }
    }
    return Metric(Embedded{std::move(points), norm});
  }

  /// Distances given outright, |S| x |S|. Throws InputError naming the entry that is negative or NaN, the pair that is
  /// not symmetric, the state at non-zero distance from itself, or the triple that breaks the triangle inequality
  /// (beyond rounding, for an inexact scalar). Takes O(|S|^3).
  static Metric from_distances(QTable<Scalar> distances) {
    check(distances);
    return Metric(Matrix{std::move(distances)});
  }

  /// Distances known to be shortest paths in an undirected graph, |S| x |S|: a metric by construction, so not checked.
  static Metric from_shortest_paths(QTable<Scalar> distances) { return Metric(Matrix{std::move(distances)}); }

  /// Distance 1 between any two distinct states.
  static Metric discrete(State states) {
    if (states < 1) throw InputError("states: " + std::to_string(states) + ", expected at least 1");
    return Metric(Discrete{states});
  }

  State states() const {
    return std::visit([](const auto& m) { return m.states(); }, form_);
  }

  /// |x_s - x_t|.
  Scalar distance(State s, State t) const {
    return std::visit([&](const auto& m) { return m.distance(s, t); }, form_);
  }

  /// Whether |x_s - x_t| is finite: only distances given outright may not be.
  bool finite(State s, State t) const {
    const auto* given = std::get_if<Matrix>(&form_);
    return given == nullptr || given->distance(s, t) - given->distance(s, t) == Scalar(0);
  }

  /// Whether the metric was made by `discrete`.
  bool is_discrete() const { return std::holds_alternative<Discrete>(form_); }

  /// The points, where the metric was made from points; otherwise null.
  const Points* points() const {
    const auto* embedded = std::get_if<Embedded>(&form_);
    return embedded ? &embedded->points : nullptr;
  }

  /// The norm, where the metric was made from points.
  Norm norm() const { return std::get<Embedded>(form_).norm; }

 private:
  static bool is_finite_length(const Points& row, Norm norm) {
    const Scalar length = Embedded::length([&](Eigen::Index i) { return row(0, i); }, row.cols(), norm);
    return length <= std::numeric_limits<Scalar>::max();
  }

  struct Embedded {
    Points points;
    Norm norm;

    State states() const { return static_cast<State>(points.rows()); }

    Scalar distance(State s, State t) const {
      return length([&](Eigen::Index i) { return Scalar(points(s, i) - points(t, i)); }, points.cols(), norm);
    }

    /// The norm of the vector with those `size` components.
    template <class Component>
    static Scalar length(Component component, Eigen::Index size, Norm norm) {
      using std::abs;
      Scalar total(0), largest(0);
      for (Eigen::Index i = 0; i < size; ++i) {
        const Scalar gap = abs(component(i));
        if (norm == Norm::l1) total += gap;
        if (norm == Norm::l2) total += gap * gap;
        if (gap > largest) largest = gap;
      }
      if (norm == Norm::linf) return largest;
      return norm == Norm::l1 ? total : root(total, largest, component, size);
    }

    /// The root of a sum of squares. A sum that overflowed, or lost digits to underflow, is taken again with components
    /// of at most 1.
    template <class Component>
    static Scalar root(const Scalar& squares, const Scalar& largest, Component component, Eigen::Index size) {
      if constexpr (is_exact_v<Scalar>) {
        throw InputError("norm: l2 distances are not rational, expected l1 or linf with exact arithmetic");
      } else {
        using Limits = std::numeric_limits<Scalar>;
        using std::sqrt;
        constexpr Scalar safe = Limits::min() / (Limits::epsilon() * Limits::epsilon());
        if ((squares >= safe && squares <= Limits::max()) || largest == Scalar(0)) return sqrt(squares);
        Scalar scaled(0);
        for (Eigen::Index i = 0; i < size; ++i) scaled += (component(i) / largest) * (component(i) / largest);
        return largest * sqrt(scaled);
      }
    }
  };

  struct Matrix {
    QTable<Scalar> distances;
    State states() const { return static_cast<State>(distances.rows()); }
    Scalar distance(State s, State t) const { return distances(s, t); }
  };

  struct Discrete {
    State count;
    State states() const { return count; }
    Scalar distance(State s, State t) const { return Scalar(s == t ? 0 : 1); }
  };

  using Form = std::variant<Embedded, Matrix, Discrete>;
  explicit Metric(Form form) : form_(std::move(form)) {}

  static std::string pair(Eigen::Index s, Eigen::Index t) {
    return "distances[" + std::to_string(s) + "][" + std::to_string(t) + "]";
  }

  static void check(const QTable<Scalar>& d) {
    if (d.rows() < 1 || d.rows() != d.cols())
      throw InputError("distances: not square, expected one row and column per state");
    const Eigen::Index n = d.rows();
    for (Eigen::Index s = 0; s < n; ++s) {
      for (Eigen::Index t = 0; t < n; ++t) {
        if (!(d(s, t) >= Scalar(0)))
          throw InputError(pair(s, t) + ": negative or not a number, expected a distance >= 0");
        if (d(s, t) != d(t, s))
          throw InputError(pair(s, t) + ": differs from " + pair(t, s) + ", expected a symmetric matrix");
      }
      if (d(s, s) != Scalar(0))
        throw InputError(pair(s, s) + ": not 0, expected a state to be at distance 0 from itself");
    }
    const Scalar stretch = Scalar(1) + Scalar(8) * unit_roundoff<Scalar>();
    for (Eigen::Index m = 0; m < n; ++m) {
      for (Eigen::Index s = 0; s < n; ++s) {
        for (Eigen::Index t = 0; t < n; ++t) {
          if (!(d(s, t) <= (d(s, m) + d(m, t)) * stretch)) {
            throw InputError(pair(s, t) + ": longer than the way through state " + std::to_string(m) +
                             ", expected the triangle inequality to hold");
          }
        }
      }
    }
  }

  Form form_;
};

}  // namespace maximin
