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
};

/// The geometry that `model` has with the overrides of a command line. Throws InputError as `make_perturbation`.
ExactGeometry exact_geometry(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides = {});

/// The constants of the model, by upper distances: never too large. Pairs at infinite distance do not count.
ModelConstants<Rational> exact_constants(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry);

/// l_r d(s,t) and l_p d(s,t) for every pair of states, or a little less: the constant times the lower distance, or what
/// the pair itself differs by if that is more. |S| x |S|, used for s < t.
struct LipschitzReach {
  QTable<Rational> rewards, probabilities;
};
LipschitzReach lipschitz_reach(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const ModelConstants<Rational>& constants);

/// The Lipschitz constant of a table, by upper distances.
LipschitzConstant<Rational> exact_lipschitz_constant(const QTable<Rational>& q, const ExactGeometry& geometry);

}  // namespace maximin
