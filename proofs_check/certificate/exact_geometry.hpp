#pragma once

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model.hpp>
#include <maximin/theory/lipschitz.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

/// The distances of a model in rational numbers. Under l2 they are roots, enclosed between neighbouring multiples of
/// 2^-64; otherwise both bounds are the distance. A negative entry stands for infinity.
struct ExactGeometry {
  QTable<Rational> lower, upper;  ///< |S| x |S|
  bool exact = true;              ///< lower == upper
  Perturbation<Rational> balls;   ///< B(s), decided exactly (under l2 on squares: its metric is not the distance)
  Rational eps;                   ///< radius of the balls
  Geometry<Rational> geometry;    ///< as a certificate states it: points with a norm, or distances

  bool finite(State s, State t) const { return lower(s, t) >= 0; }
  /// The upper bound: Lipschitz constants by it are never too large.
  const Rational& distance(State s, State t) const { return upper(s, t); }
};

/// The geometry that `model` has with the overrides of a command line. Throws InputError as `make_perturbation`.
ExactGeometry exact_geometry(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides = {});

/// l_r d(s,t) and l_p d(s,t) for every pair of states, or a little less: the constant times the lower distance, or what
/// the pair itself differs by if that is more. |S| x |S|, used for s < t.
struct LipschitzReach {
  QTable<Rational> rewards, probabilities;
};
LipschitzReach lipschitz_reach(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const ModelConstants<Rational>& constants);

}  // namespace maximin
