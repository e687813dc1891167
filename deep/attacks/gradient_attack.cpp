#include <maximin/deep/attacks/gradient_attack.hpp>

#include <limits>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

GradientAttackOptions gradient_attack_named(std::string_view name) {
  GradientAttackOptions options;
  if (name == "pgd") return options;
  if (name == "min-best") {
    options.objective = AttackObjective::min_best;
    return options;
  }
  if (name == "pgd-restarts") {
    options.starts = 10;
    return options;
  }
  if (name != "pgd-released") {
    throw InputError(fmt::format("gradient attack: {}, expected pgd, min-best, pgd-restarts or pgd-released", name));
  }
  options.objective = AttackObjective::cross_entropy;
  options.released_start = true;
  options.keep_best = false;
  return options;
}

GradientAttack::GradientAttack(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball,
                               const GradientAttackOptions& options)
    : q_(std::move(q)), ball_(ball), options_(options) {
  if (options.steps < 0 || options.starts < 1 || !(options.step_share > 0)) {
    throw InputError("gradient attack: steps below 0, or no starts or step, expected e.g. 10 steps of 0.1");
  }
}

torch::Tensor GradientAttack::starts(std::span<const Lane> lanes, std::span<const Point> truths,
                                     std::span<Stream> streams) const {
  std::vector<Point> drawn;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    drawn.push_back(ball_.draw(truths[k], streams[static_cast<std::size_t>(lanes[k])]));
  }
  const torch::Tensor rows = to_tensor(drawn);
  return options_.released_start ? rows.clamp(0, 1) : rows;
}

void GradientAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&,
                             std::span<Stream> streams, std::span<Point> shown) {
  const torch::Device device = device_of(*q_);
  const BallBounds bounds(truths, ball_, device);
  AttackedStates attacked;
  {
    torch::NoGradGuard no_grad;
    attacked.q = q_->forward(to_tensor(truths).to(device));
    attacked.best = attacked.q.argmax(1, true);
  }
  const auto n = static_cast<long>(lanes.size());
  torch::Tensor chosen = torch::zeros({n, 2}, device);
  torch::Tensor least = torch::full({n}, std::numeric_limits<float>::infinity(), device);
  const auto consider = [&](const torch::Tensor& at, const torch::Tensor& q_at) {
    const torch::Tensor score = hard_objective(options_.objective, q_at, attacked);
    const torch::Tensor better = options_.keep_best ? score < least : torch::ones_like(score, torch::kBool);
    chosen = torch::where(better.unsqueeze(1), at, chosen);
    least = torch::where(better, score, least);
  };
  const double step = options_.step_share * ball_.eps();
  for (int start = 0; start < options_.starts; ++start) {
    torch::Tensor at = starts(lanes, truths, streams).to(device);
    for (int i = 0; i <= options_.steps; ++i) {
      at = bounds.clamp(at).detach().set_requires_grad(i < options_.steps);
      const torch::Tensor q_at = q_->forward(at);
      if (options_.keep_best || i == options_.steps) consider(at.detach(), q_at.detach());
      if (i == options_.steps) break;
      const torch::Tensor objective = smooth_objective(options_.objective, q_at, attacked);
      const torch::Tensor slope = torch::autograd::grad({objective.sum()}, {at})[0];
      at = at.detach() - step * slope.sign();
    }
  }
  const std::vector<Point> points = to_points(chosen);
  for (std::size_t k = 0; k < points.size(); ++k) shown[k] = ball_.project(truths[k], points[k]);
}

}  // namespace maximin::deep
