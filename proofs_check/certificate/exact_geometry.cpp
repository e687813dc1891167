#include <maximin/proofs_check/certificate/exact_geometry.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

namespace maximin {
namespace {

using Kind = Geometry<Rational>::Kind;
using boost::multiprecision::denominator;
using boost::multiprecision::numerator;

constexpr unsigned root_bits = 64;

/// The largest multiple of 2^-64 whose square is at most q, and whether its square is q.
std::pair<Rational, bool> root_below(const Rational& q) {
  const Integer scale = Integer(1) << root_bits;
  const Integer whole = (numerator(q) * scale * scale) / denominator(q);
  const Rational root(sqrt(whole), scale);
  return {root, root * root == q};
}

Rational square_distance(const Metric<Rational>::Points& points, State s, State t) {
  Rational sum(0);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const Rational gap = points(s, i) - points(t, i);
    sum += gap * gap;
  }
  return sum;
}

Perturbation<Rational> balls_of(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides,
                                const Geometry<Rational>& g) {
  if (g.kind != Kind::points || g.norm != Norm::l2) return make_perturbation(model, overrides);
  if (*g.eps < 0) throw InputError("eps: negative, expected eps >= 0");
  const Rational square = *g.eps * *g.eps;
  return Perturbation<Rational>::decided_by(
      Metric<Rational>::from_points(g.points, g.norm), *g.eps,
      [&](State s, State t) { return square_distance(g.points, s, t) <= square; });
}

}  // namespace

ExactGeometry::ExactGeometry(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides)
    : stated_(resolve_geometry(model, overrides)), balls_(balls_of(model, overrides, stated_)) {
  euclidean_ = stated_.kind == Kind::points && stated_.norm == Norm::l2;
  hops_ = stated_.kind == Kind::hops || stated_.kind == Kind::neighbourhoods;
  if (stated_.kind != Kind::neighbourhoods) return;
  const Rational eps = balls_.eps();
  stated_ = {};
  stated_.kind = Kind::distances;
  stated_.eps = eps;
  stated_.distances.resize(balls_.states(), balls_.states());
  for (State s = 0; s < balls_.states(); ++s) {
    for (State t = 0; t < balls_.states(); ++t) stated_.distances(s, t) = finite(s, t) ? lower(s, t) : Rational(-1);
  }
}

bool ExactGeometry::finite(State s, State t) const {
  return !hops_ || balls_.metric().distance(s, t) < balls_.states();
}

Rational ExactGeometry::lower(State s, State t) const {
  return euclidean_ ? root_below(square_distance(stated_.points, s, t)).first : balls_.metric().distance(s, t);
}

Rational ExactGeometry::upper(State s, State t) const {
  if (!euclidean_) return balls_.metric().distance(s, t);
  const auto [root, attained] = root_below(square_distance(stated_.points, s, t));
  return attained ? root : Rational(root + Rational(1, Integer(1) << root_bits));
}

void refuse_infinite(const ModelConstants<Rational>& c) {
  if (c.finite()) return;
  const auto& bad = c.l_r.infinite ? c.l_r : c.l_p.infinite ? c.l_p : c.k_tv;
  throw AssumptionFails(fmt::format(
      "Assumption 1: states {} and {} are at distance 0, but their {} for action {} differ, so no Lipschitz constant "
      "exists",
      bad.s1, bad.s2, c.l_r.infinite ? "rewards" : "transitions", bad.action));
}

LipschitzReach lipschitz_reach(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const ModelConstants<Rational>& constants, bool may_fall_short) {
  LipschitzReach reach{QTable<Rational>(mdp.states(), mdp.states()), QTable<Rational>(mdp.states(), mdp.states())};
  for (State s = 0; s < mdp.states(); ++s) {
    for (State t = s + 1; t < mdp.states(); ++t) {
      if (!geometry.finite(s, t)) continue;
      const Rational d = geometry.lower(s, t);
      Rational& r = reach.rewards(s, t) = constants.l_r.value * d;
      Rational& p = reach.probabilities(s, t) = constants.l_p.value * d;
      if (!may_fall_short) continue;
      for (Action a = 0; a < mdp.actions(); ++a) {
        r = std::max(r, Rational(abs(Rational(mdp.reward(s, a) - mdp.reward(t, a)))));
        p = std::max(p, internal::row_difference<Rational>(mdp.successors(s, a), mdp.successors(t, a)).largest);
      }
    }
  }
  return reach;
}

}  // namespace maximin
