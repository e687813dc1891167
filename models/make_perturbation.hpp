#pragma once

#include <limits>
#include <optional>

#include <maximin/models/model.hpp>
#include <maximin/tabular/transition_graph.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// What a command line says of the geometry, over what the file says.
template <class Scalar>
struct GeometryOverrides {
  std::optional<typename Geometry<Scalar>::Kind> kind;  ///< points (the file must have some), hops or discrete
  std::optional<Norm> norm;
  std::optional<Scalar> eps;
};

/// The geometry that is used for a model: its own with the overrides; hops in the transition graph where it has none.
/// eps is 1 where none is said and distances are whole numbers (hops, discrete, neighbourhoods).
/// Throws InputError when an override does not fit (a norm without points, points that the model lacks, an eps for
/// balls given outright) or eps is missing.
template <class Scalar>
Geometry<Scalar> resolve_geometry(const Model<Scalar>& model, const GeometryOverrides<Scalar>& overrides = {}) {
  using Kind = typename Geometry<Scalar>::Kind;
  Geometry<Scalar> g = model.geometry;
  if (overrides.kind) {
    if (*overrides.kind == Kind::points && g.points.rows() == 0) {
      throw InputError("metric: points asked for, but the model has none; expected hops or discrete");
    }
    g.kind = *overrides.kind;
    if (g.kind != model.geometry.kind) g.eps.reset();
  } else if (g.kind == Kind::none) {
    g.kind = Kind::hops;
  }
  if (overrides.norm) {
    if (g.kind != Kind::points)
      throw InputError("norm: given for a metric without points, expected a model with points");
    g.norm = *overrides.norm;
  }
  if (overrides.eps) {
    if (g.kind == Kind::neighbourhoods)
      throw InputError("eps: given for a model whose balls are listed, expected none");
    g.eps = *overrides.eps;
  }
  const bool whole = g.kind == Kind::hops || g.kind == Kind::discrete || g.kind == Kind::neighbourhoods;
  if (!g.eps && whole) g.eps = Scalar(1);
  if (!g.eps) throw InputError("eps: not given by the model nor by an option, expected the radius of the balls");
  return g;
}

/// The balls of a model. Throws InputError as `resolve_geometry`, and when the geometry is not of the model's size.
template <class Scalar>
Perturbation<Scalar> make_perturbation(const Model<Scalar>& model, const GeometryOverrides<Scalar>& overrides = {}) {
  using Kind = typename Geometry<Scalar>::Kind;
  const Geometry<Scalar> g = resolve_geometry(model, overrides);
  auto balls = [&]() -> Perturbation<Scalar> {
    switch (g.kind) {
      case Kind::points:
        return {Metric<Scalar>::from_points(g.points, g.norm), *g.eps};
      case Kind::distances:
        return {Metric<Scalar>::from_distances(g.distances), *g.eps};
      case Kind::neighbourhoods:
        return Perturbation<Scalar>::from_neighbourhoods(g.neighbourhoods);
      case Kind::discrete:
        return {Metric<Scalar>::discrete(model.mdp.states()), *g.eps};
      case Kind::none:
      case Kind::hops:
        break;
    }
    const auto hops = Metric<Scalar>::from_shortest_paths(hop_distances(model.mdp));
    if constexpr (!std::numeric_limits<Scalar>::has_infinity) {  // |S| hops stand for no path, however large eps is
      return Perturbation<Scalar>::decided_by(hops, *g.eps, [&, n = Scalar(model.mdp.states())](State s, State t) {
        const Scalar d = hops.distance(s, t);
        return d <= *g.eps && d < n;
      });
    }
    return {hops, *g.eps};
  }();
  if (balls.states() != model.mdp.states()) {
    throw InputError("geometry: of " + std::to_string(balls.states()) + " states, expected the model's " +
                     std::to_string(model.mdp.states()));
  }
  return balls;
}

}  // namespace maximin
