#include <maximin/deep/prediction_errors.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <maximin/gridworld/box_belief.hpp>

namespace maximin::deep {
namespace {

double distance(Point a, Point b) {
  return std::hypot(a.x - b.x, a.y - b.y);
}

/// Adds one lane's step to the sums.
void add(PredictionErrors& sum, const torch::Tensor& states, const torch::Tensor& weights, const BoxUnion& exact,
         Point truth, Point shown) {
  const auto place = states.accessor<float, 2>();
  const auto weight = weights.accessor<float, 1>();
  Point mean;
  double nearest = std::numeric_limits<double>::infinity(), inside = 0;
  for (long k = 0; k < place.size(0); ++k) {
    const Point p{place[k][0], place[k][1]};
    mean.x += p.x * weight[k];
    mean.y += p.y * weight[k];
    nearest = std::min(nearest, distance(p, truth));
    if (exact.contains(p)) inside += weight[k];
  }
  ++sum.steps;
  sum.belief += distance(mean, truth);
  sum.exact += distance(centroid(exact), truth);
  sum.shown += distance(shown, truth);
  sum.nearest += nearest;
  sum.inside += inside;
  sum.exact_size += exact.area();
}

}  // namespace

Point centroid(const BoxUnion& set) {
  Point sum;
  for (const Box& box : set.boxes()) {
    sum.x += box.area() * (box.x_low + box.x_high) / 2;
    sum.y += box.area() * (box.y_low + box.y_high) / 2;
  }
  // A set of a few quanta has an area whose products underflow nothing, but which may be as small as 2^-80.
  const double area = set.area();
  return {sum.x / area, sum.y / area};
}

PredictionErrors evaluate_predictions(LaneBelief& belief, const PredictionTrial& trial) {
  const auto n = static_cast<std::size_t>(trial.episodes);
  std::vector<Wandering> walks(n, Wandering(trial.walk, trial.deception, trial.eps, 8, trial.horizon));
  std::vector<BoxBelief> exact(n, BoxBelief(ObservationBall(trial.eps)));
  std::vector<Lane> lanes;
  belief.resize(static_cast<Lane>(n));
  for (std::size_t l = 0; l < n; ++l) {
    walks[l].begin(trial.seed, l);
    lanes.push_back(static_cast<Lane>(l));
  }
  PredictionErrors sum;
  while (!lanes.empty()) {
    std::vector<Action> actions;
    std::vector<Point> shown;
    for (const Lane lane : lanes) {
      actions.push_back(walks[static_cast<std::size_t>(lane)].last_action());
      shown.push_back(walks[static_cast<std::size_t>(lane)].shown());
    }
    const BeliefStates beliefs = belief.update(lanes, actions, shown);
    std::vector<Lane> running;
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const auto l = static_cast<std::size_t>(lanes[k]);
      const BoxUnion& set = actions[k] < 0 ? exact[l].reset(shown[k]) : exact[l].update(actions[k], shown[k]);
      const auto row = static_cast<long>(k);
      add(sum, beliefs.states[row], beliefs.weights[row], set, walks[l].truth(), shown[k]);
      sum.holds += belief.holds(lanes[k], walks[l].truth()) ? 1 : 0;
      sum.size += belief.size(lanes[k]);
      if (walks[l].step()) running.push_back(lanes[k]);
    }
    lanes.swap(running);
  }
  const auto steps = static_cast<double>(std::max(sum.steps, 1L));
  for (double* mean :
       {&sum.belief, &sum.exact, &sum.shown, &sum.nearest, &sum.holds, &sum.inside, &sum.size, &sum.exact_size}) {
    *mean /= steps;
  }
  sum.empty = belief.empty_intersections();
  return sum;
}

}  // namespace maximin::deep
