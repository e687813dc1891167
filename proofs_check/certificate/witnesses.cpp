#include <maximin/proofs_check/certificate/witnesses.hpp>

#include <algorithm>
#include <limits>
#include <utility>

#include <maximin/tabular/exact_control.hpp>

namespace maximin {
namespace {

/// The distances in floating point.
Metric<double> near_metric(const ExactGeometry& geometry) {
  const Perturbation<Rational>& balls = geometry.balls();
  const Metric<Rational>& metric = balls.metric();
  if (metric.is_discrete()) return Metric<double>::discrete(balls.states());
  if (const auto* points = metric.points()) return Metric<double>::from_points(points->cast<double>(), metric.norm());
  QTable<double> distances(balls.states(), balls.states());
  for (State s = 0; s < balls.states(); ++s) {
    for (State t = 0; t < balls.states(); ++t) {
      distances(s, t) =
          geometry.finite(s, t) ? static_cast<double>(metric.distance(s, t)) : std::numeric_limits<double>::infinity();
    }
  }
  return Metric<double>::from_shortest_paths(std::move(distances));
}

template <class Make>
auto in_floating_point(Make make) {
  try {
    return make();
  } catch (const InputError&) {
    throw InputError(
        "model: numbers beyond floating point, which bounds start from; expected smaller ones or --arith exact");
  }
}

/// The constant with the place that was found, and the difference there over the distance; 0 where that is not above 0.
template <class Difference>
LipschitzConstant<Rational> exactly(const LipschitzConstant<double>& found, const ExactGeometry& geometry,
                                    Difference difference) {
  LipschitzConstant<Rational> c;
  if (found.value > 0 || found.infinite) {
    c.observe(difference(found), geometry.upper(found.s1, found.s2), found.s1, found.s2, found.action, found.target);
  }
  return c;
}

}  // namespace

Witnesses find_witnesses(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry, const ScaledTable& low,
                         const ScaledTable& high) {
  const Metric<double> metric = in_floating_point([&] { return near_metric(geometry); });
  const auto near = in_floating_point([&] { return model_constants(internal::rounded(mdp), metric); });
  Witnesses w;
  ModelConstants<Rational>& c = w.constants;
  c.l_r = exactly(near.l_r, geometry, [&](const auto& at) {
    return Rational(abs(Rational(mdp.reward(at.s1, at.action) - mdp.reward(at.s2, at.action))));
  });
  const auto rows = [&](const auto& at) {
    return internal::row_difference<Rational>(mdp.successors(at.s1, at.action), mdp.successors(at.s2, at.action));
  };
  c.l_p = exactly(near.l_p, geometry, [&](const auto& at) { return rows(at).largest; });
  if (c.l_p.value != 0) c.l_p.target = rows(near.l_p).at;
  c.k_tv = exactly(near.k_tv, geometry, [&](const auto& at) { return rows(at).total_variation; });
  refuse_infinite(c);
  c.r_min = mdp.rewards().minCoeff();
  c.r_max_signed = mdp.rewards().maxCoeff();
  c.r_max = std::max(c.r_max_signed, Rational(-c.r_min));
  c.span = c.r_max_signed - c.r_min;

  QTable<double> q(mdp.states(), mdp.actions());
  for (Eigen::Index i = 0; i < q.size(); ++i) {
    q.data()[i] = static_cast<double>(Rational(low.numerators.data()[i], low.denominator));
  }
  LipschitzConstant<double> star = lipschitz_constant(q, metric);
  if (q(star.s1, star.action) < q(star.s2, star.action)) std::swap(star.s1, star.s2);
  w.l_star =
      exactly(star, geometry, [&](const auto& at) { return Rational(low(at.s1, at.action) - high(at.s2, at.action)); });
  return w;
}

}  // namespace maximin
