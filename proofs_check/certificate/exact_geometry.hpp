#pragma once

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model.hpp>
#include <maximin/theory/lipschitz.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

/// The distances of a model in rational numbers. Under l2 they are roots, enclosed between neighbouring multiples of
/// 2^-64; otherwise both bounds are the distance.
class ExactGeometry {
 public:
  /// The geometry that `model` has with the overrides of a command line. Throws InputError as `make_perturbation`.
  explicit ExactGeometry(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides = {});

  /// d-(s,t), and d+(s,t). Not for pairs at infinite distance.
  Rational lower(State s, State t) const;
  Rational upper(State s, State t) const;
  bool finite(State s, State t) const;
  /// The upper bound: Lipschitz constants by it are never too large.
  Rational distance(State s, State t) const { return upper(s, t); }

  /// Whether distances are not rounded: not under l2.
  bool exact() const { return !euclidean_; }
  /// B(s), decided exactly: under l2 on squares, so that their metric gives squares of distances.
  const Perturbation<Rational>& balls() const { return balls_; }
  /// Radius of the balls.
  const Rational& eps() const { return *stated_.eps; }
  /// As a certificate states it: points with a norm, hops, the discrete metric, or distances, where a negative entry
  /// stands for infinity.
  const Geometry<Rational>& stated() const { return stated_; }

 private:
  Geometry<Rational> stated_;
  Perturbation<Rational> balls_;
  bool euclidean_ = false;
  bool hops_ = false;  // paths that do not exist count as |S| hops in an exact metric
};

/// Throws AssumptionFails where states at distance 0 differ, so that no constant exists.
void refuse_infinite(const ModelConstants<Rational>& c);

/// l_r d(s,t) and l_p d(s,t) for every pair of states, or a little less: the constant times the lower distance, or what
/// the pair itself differs by if that is more, which it can only be where distances or constants `may_fall_short` of
/// their own. |S| x |S|, used for s < t.
struct LipschitzReach {
  QTable<Rational> rewards, probabilities;
};
LipschitzReach lipschitz_reach(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const ModelConstants<Rational>& constants, bool may_fall_short);

}  // namespace maximin
