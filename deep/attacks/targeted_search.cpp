#include <maximin/deep/attacks/targeted_search.hpp>

#include <limits>
#include <utility>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// By how much the target, [n, 1], leads the best other action of q, [n, actions]: -> [n].
torch::Tensor lead(const torch::Tensor& q, const torch::Tensor& target) {
  const torch::Tensor others = q.scatter(1, target, -std::numeric_limits<float>::infinity());
  return q.gather(1, target).squeeze(1) - others.amax(1);
}

}  // namespace

TargetedSearch::TargetedSearch(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball,
                               const TargetedSearchOptions& options)
    : q_(std::move(q)), ball_(ball), options_(options) {
  if (options.grid < 2 || options.refinement < 0 || options.steps < 0 || !(options.step_share > 0)) {
    throw InputError("targeted search: a grid below 2, or steps below 0, expected e.g. grid 7 and 30 steps");
  }
}

torch::Tensor TargetedSearch::best_of_grid(std::span<const Point> truths, const torch::Tensor& targets) const {
  const long each = static_cast<long>(options_.grid) * options_.grid;
  std::vector<Point> places;
  for (const Point& truth : truths) add_grid(ball_, truth, options_.grid, places);
  torch::NoGradGuard no_grad;
  const torch::Tensor rows = to_tensor(places).to(targets.device());
  const torch::Tensor leads = lead(q_->forward(rows), targets.repeat_interleave(each, 0)).view({-1, each});
  const torch::Tensor first = torch::arange(leads.size(0), targets.options()) * each;
  return rows.index_select(0, first + leads.argmax(1));
}

void TargetedSearch::find(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> targets,
                          std::span<Stream> streams, std::span<Point> found) const {
  const torch::Device device = device_of(*q_);
  const BallBounds bounds(truths, ball_, device);
  const torch::Tensor target =
      torch::tensor(std::vector<int>(targets.begin(), targets.end()), torch::kLong).unsqueeze(1).to(device);
  const bool by_grid = options_.method == SearchMethod::grid;
  torch::Tensor at;
  if (by_grid) {
    at = best_of_grid(truths, target);
  } else {
    std::vector<Point> starts;
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      starts.push_back(ball_.draw(truths[k], streams[static_cast<std::size_t>(lanes[k])]));
    }
    at = to_tensor(starts).to(device);
  }
  double step = by_grid ? ball_.eps() / (options_.grid - 1) : options_.step_share * ball_.eps();
  const int steps = by_grid ? options_.refinement : options_.steps;
  torch::Tensor best = at, most = torch::full({at.size(0)}, -std::numeric_limits<float>::infinity(), device);
  for (int i = 0; i <= steps; ++i) {
    torch::AutoGradMode gradients(i < steps);
    at = bounds.clamp(at.detach()).set_requires_grad(i < steps);
    const torch::Tensor q = q_->forward(at);
    const torch::Tensor lead_here = lead(q.detach(), target);
    const torch::Tensor better = lead_here > most;
    best = torch::where(better.unsqueeze(1), at.detach(), best);
    most = torch::where(better, lead_here, most);
    if (i == steps) break;
    const torch::Tensor slope = torch::autograd::grad({torch::log_softmax(q, 1).gather(1, target).sum()}, {at})[0];
    at = at.detach() + step * slope.sign();
    if (by_grid) step /= 2;
  }
  const std::vector<Point> points = to_points(best);
  for (std::size_t k = 0; k < points.size(); ++k) found[k] = ball_.project(truths[k], points[k]);
}

}  // namespace maximin::deep
