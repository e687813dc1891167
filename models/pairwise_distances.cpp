#include <maximin/models/pairwise_distances.hpp>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {

PairwiseDistances pairwise_distances(const Metric<double>& metric) {
  const State n = metric.states();
  PairwiseDistances d{.table = QTable<double>::Zero(n, n)};
  for (State s = 0; s < n; ++s) {
    for (State t = s + 1; t < n; ++t) {
      const double distance = metric.distance(s, t);
      d.table(s, t) = d.table(t, s) = distance;
      if (distance > d.diameter) d.diameter = distance;
      if ((s == 0 && t == 1) || distance < d.least) {
        d.least = distance;
        d.nearest = {s, t};
      }
    }
  }
  if (n > 1 && !(d.least > 0)) {
    throw InputError(fmt::format("points: states {} and {} lie at distance 0, expected distinct points",
                                 d.nearest.first, d.nearest.second));
  }
  return d;
}

}  // namespace maximin
