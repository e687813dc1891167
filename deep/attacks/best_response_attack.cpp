#include <maximin/deep/attacks/best_response_attack.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// l-infinity.
double distance(Point a, Point b) {
  return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
}

}  // namespace

BestResponseAttack::BestResponseAttack(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                                       const BestResponseOptions& options)
    : judge_(std::move(judge)), ball_(ball), options_(options) {
  if (options.grid < 0 || options.random < 0 || options.grid == 1 || options.grid + options.random == 0) {
    throw InputError("best response: no candidates, expected a grid of 2 or more points a side, or random ones");
  }
}

Point BestResponseAttack::carried_over(Lane lane, Point truth) const {
  const std::optional<Point>& error = errors_[static_cast<std::size_t>(lane)];
  return error ? ball_.project(truth, {truth.x + error->x, truth.y + error->y}) : truth;
}

void BestResponseAttack::candidates(Lane lane, Point truth, Stream& rng, std::vector<Point>& out) const {
  add_grid(ball_, truth, options_.grid, out);
  for (int i = 0; i < options_.random; ++i) out.push_back(ball_.draw(truth, rng));
  if (options_.steady) out.push_back(carried_over(lane, truth));
}

void BestResponseAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                 std::span<Stream> streams, std::span<Point> shown) {
  std::vector<Point> points;
  std::vector<Lane> asked;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    candidates(lanes[k], truths[k], streams[static_cast<std::size_t>(lanes[k])], points);
    asked.resize(points.size(), lanes[k]);
  }
  std::vector<Action> answers(points.size());
  agent.would_do(asked, points, answers);

  const torch::Tensor q = values_at(*judge_, truths).to(torch::kFloat);
  const auto value = q.accessor<float, 2>();
  const std::size_t each = points.size() / lanes.size();
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    Stream& rng = streams[static_cast<std::size_t>(lanes[k])];
    const Point last = carried_over(lanes[k], truths[k]);
    std::size_t worst = k * each;
    int equals = 1;
    for (std::size_t c = k * each + 1; c < (k + 1) * each; ++c) {
      const auto row = static_cast<long>(k);
      const float here = value[row][answers[c]], least = value[row][answers[worst]];
      equals = here < least ? 1 : here == least ? equals + 1 : equals;
      const bool instead = options_.steady ? distance(points[c], last) < distance(points[worst], last)
                                           : here == least && rng.below(equals) == 0;
      if (here < least || (here == least && instead)) worst = c;
    }
    shown[k] = points[worst];
    if (options_.steady) {
      errors_[static_cast<std::size_t>(lanes[k])] = Point{shown[k].x - truths[k].x, shown[k].y - truths[k].y};
    }
  }
}

}  // namespace maximin::deep
