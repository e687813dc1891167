#pragma once

#include <algorithm>
#include <utility>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {

/// A random sparse model for tests: up to three successors per pair, rewards in [-1, 1).
inline FiniteMdp<double> random_model(State states, Action actions, double discount, Stream& rng) {
  FiniteMdpBuilder<double> b(states, actions, discount);
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      b.reward(s, a, rng.uniform(-1, 1));
      const int successors = std::min<int>(states, rng.integer(1, 3));
      const State first = rng.below(states);
      double left = 1;
      for (int k = 0; k < successors; ++k) {
        const double p = k + 1 == successors ? left : left * rng.uniform(0.2, 0.8);
        b.transition(s, a, (first + k) % states, p);
        left -= p;
      }
    }
  }
  return std::move(b).build();
}

/// States 0, 1, 2, ... on a line and the balls of radius eps among them.
inline Perturbation<double> line_balls(State states, double eps) {
  Metric<double>::Points points(states, 1);
  for (State s = 0; s < states; ++s) points(s, 0) = s;
  return Perturbation<double>(Metric<double>::from_points(points, Norm::l1), eps);
}

}  // namespace maximin
