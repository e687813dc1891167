#include <maximin/proofs_check/certificate/exact_geometry.hpp>

#include <algorithm>
#include <utility>

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

ExactGeometry euclidean(const Geometry<Rational>& g) {
  const auto n = static_cast<State>(g.points.rows());
  QTable<Rational> lower(n, n), upper(n, n), squares(n, n);
  bool exact = true;
  for (State s = 0; s < n; ++s) {
    for (State t = 0; t < n; ++t) {
      squares(s, t) = square_distance(g.points, s, t);
      const auto [root, attained] = root_below(squares(s, t));
      lower(s, t) = root;
      upper(s, t) = attained ? root : Rational(root + Rational(1, Integer(1) << root_bits));
      exact = exact && attained;
    }
  }
  const Rational eps = *g.eps;
  return {std::move(lower),
          std::move(upper),
          exact,
          {Metric<Rational>::from_shortest_paths(std::move(squares)), eps * eps},
          eps,
          g};
}

/// Paths that do not exist count as |S| hops in an exact metric.
ExactGeometry by_metric(Perturbation<Rational> balls, Geometry<Rational> g) {
  const State n = balls.states();
  const bool hops = g.kind == Kind::hops || g.kind == Kind::neighbourhoods || g.kind == Kind::none;
  QTable<Rational> distances(n, n);
  for (State s = 0; s < n; ++s) {
    for (State t = 0; t < n; ++t) {
      const Rational d = balls.metric().distance(s, t);
      distances(s, t) = hops && d >= n ? Rational(-1) : d;
    }
  }
  Rational eps = balls.eps();
  if (g.kind != Kind::points) {
    g = {};
    g.kind = Kind::distances;
    g.distances = distances;
  }
  g.eps = eps;
  return {distances, distances, true, std::move(balls), std::move(eps), std::move(g)};
}

}  // namespace

ExactGeometry exact_geometry(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides) {
  Geometry<Rational> g = resolve_geometry(model, overrides);
  if (g.kind == Kind::points && g.norm == Norm::l2) {
    if (*g.eps < 0) throw InputError("eps: negative, expected eps >= 0");
    return euclidean(g);
  }
  return by_metric(make_perturbation(model, overrides), std::move(g));
}

LipschitzReach lipschitz_reach(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const ModelConstants<Rational>& constants) {
  LipschitzReach reach{geometry.lower * constants.l_r.value, geometry.lower * constants.l_p.value};
  if (geometry.exact) return reach;
  for (State s = 0; s < mdp.states(); ++s) {
    for (State t = s + 1; t < mdp.states(); ++t) {
      for (Action a = 0; a < mdp.actions(); ++a) {
        Rational& r = reach.rewards(s, t);
        r = std::max(r, Rational(abs(Rational(mdp.reward(s, a) - mdp.reward(t, a)))));
        Rational& p = reach.probabilities(s, t);
        p = std::max(p, internal::row_difference<Rational>(mdp.successors(s, a), mdp.successors(t, a)).largest);
      }
    }
  }
  return reach;
}

}  // namespace maximin
