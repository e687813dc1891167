#pragma once

#include <utility>

#include <maximin/theory/metric.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// All distances of a small metric, with its extremes. A model of one state has no pair: both extremes are then 0.
struct PairwiseDistances {
  QTable<double> table;               ///< |S| x |S|, symmetric
  double least = 0;                   ///< the least distance between two distinct states
  double diameter = 0;                ///< the largest
  std::pair<State, State> nearest{};  ///< a pair at the least distance

  double operator()(State s, State t) const { return table(s, t); }
  State states() const { return static_cast<State>(table.rows()); }
};

/// Tabulates the metric. Throws InputError when two states lie at distance 0. O(|S|^2).
PairwiseDistances pairwise_distances(const Metric<double>& metric);

}  // namespace maximin
