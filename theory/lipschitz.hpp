#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The smallest constant c with |f(s1) - f(s2)| <= c |x_s1 - x_s2| for all pairs, and the pair that attains it.
template <class Scalar>
struct LipschitzConstant {
  Scalar value{0};        ///< the constant; meaningless when `infinite`
  bool infinite = false;  ///< distinct states at distance 0 (or next to it) disagree: no finite constant will do
  State s1 = 0, s2 = 0;   ///< the pair that attains it (equal: every difference is zero)
  Action action = 0;      ///< the action that attains it
  State target = -1;      ///< for l_p, the successor s' that attains it

  /// Takes the ratio difference / distance into account.
  void observe(const Scalar& difference, const Scalar& distance, State first, State second, Action a, State to = -1) {
    if (infinite || !(difference > Scalar(0))) return;
    if (!(distance > Scalar(0))) {
      infinite = true;
    } else if (!(difference > value * distance)) {
      return;
    } else {
      value = difference / distance;
      infinite = !(value - value == Scalar(0));  // the quotient overflows
    }
    s1 = first;
    s2 = second;
    action = a;
    target = to;
  }
};

/// Every constant of a model that a bound uses, recomputed from the model and never trusted from elsewhere.
template <class Scalar>
struct ModelConstants {
  LipschitzConstant<Scalar> l_r;   ///< of R(.,a), largest over a (paper, Assumption 1)
  LipschitzConstant<Scalar> l_p;   ///< of P(s'|.,a), largest over a and s' (paper, Assumption 1)
  LipschitzConstant<Scalar> k_tv;  ///< of P(.|.,a) in total variation (half the l1 distance), largest over a
  Scalar r_min{0};                 ///< min R
  Scalar r_max_signed{0};          ///< max R: all that Assumption 2 asks for as printed
  Scalar r_max{0};                 ///< max |R|: what the proof needs
  Scalar span{0};                  ///< max R - min R

  bool finite() const { return !l_r.infinite && !l_p.infinite && !k_tv.infinite; }
};

namespace internal {

/// Largest |P(s'|s1,a) - P(s'|s2,a)| with its s', and half the sum of all of them.
template <class Scalar>
struct RowDifference {
  Scalar largest{0};
  State at = -1;
  Scalar total_variation{0};
};

template <class Scalar>
RowDifference<Scalar> row_difference(typename FiniteMdp<Scalar>::Row x, typename FiniteMdp<Scalar>::Row y) {
  RowDifference<Scalar> result;
  Scalar sum(0);
  const auto take = [&](State target, Scalar difference) {
    if (difference < Scalar(0)) difference = -difference;
    sum += difference;
    if (difference > result.largest) {
      result.largest = difference;
      result.at = target;
    }
  };
  auto i = x.begin();
  auto j = y.begin();
  while (i != x.end() || j != y.end()) {
    if (j == y.end() || (i != x.end() && i->target < j->target)) {
      take(i->target, i->probability);
      ++i;
    } else if (i == x.end() || j->target < i->target) {
      take(j->target, j->probability);
      ++j;
    } else {
      take(i->target, Scalar(i->probability - j->probability));
      ++i;
      ++j;
    }
  }
  result.total_variation = sum / Scalar(2);
  return result;
}

}  // namespace internal

/// Whatever says how far states are apart: a Metric, or bounds on one. Pairs at infinite distance constrain nothing.
template <class D, class Scalar>
concept Distances = requires(const D& d, State s, State t) {
  { d.distance(s, t) } -> std::convertible_to<Scalar>;
  { d.finite(s, t) } -> std::same_as<bool>;
};

namespace internal {

/// Calls visit(s, t, distance) for every pair s < t at finite distance.
template <class Scalar, class Visit>
void for_each_pair(State states, const Distances<Scalar> auto& distances, Visit visit) {
  for (State s = 0; s < states; ++s) {
    for (State t = s + 1; t < states; ++t) {
      if (distances.finite(s, t)) visit(s, t, Scalar(distances.distance(s, t)));
    }
  }
}

}  // namespace internal

/// Lipschitz constant of q(.,a), largest over a. O(|S|^2 |A|).
template <class Scalar>
LipschitzConstant<Scalar> lipschitz_constant(const QTable<Scalar>& q, const Distances<Scalar> auto& distances) {
  LipschitzConstant<Scalar> constant;
  const auto states = static_cast<State>(q.rows());
  internal::for_each_pair<Scalar>(states, distances, [&](State s, State t, const Scalar& distance) {
    for (Action a = 0; a < q.cols(); ++a) {
      Scalar difference = q(s, a) - q(t, a);
      if (difference < Scalar(0)) difference = -difference;
      constant.observe(difference, distance, s, t, a);
    }
  });
  return constant;
}

/// All constants of the model under the distances. O(|S|^2 |A| row length).
template <class Scalar>
ModelConstants<Scalar> model_constants(const FiniteMdp<Scalar>& mdp, const Distances<Scalar> auto& distances) {
  ModelConstants<Scalar> c;
  c.l_r = lipschitz_constant(mdp.rewards(), distances);
  internal::for_each_pair<Scalar>(mdp.states(), distances, [&](State s, State t, const Scalar& distance) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      const auto d = internal::row_difference<Scalar>(mdp.successors(s, a), mdp.successors(t, a));
      c.l_p.observe(d.largest, distance, s, t, a, d.at);
      c.k_tv.observe(d.total_variation, distance, s, t, a);
    }
  });
  c.r_min = mdp.rewards().minCoeff();
  c.r_max_signed = mdp.rewards().maxCoeff();
  c.r_max = std::max(c.r_max_signed, Scalar(-c.r_min));
  c.span = c.r_max_signed - c.r_min;
  return c;
}

}  // namespace maximin
