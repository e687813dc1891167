#include <maximin/deep/attacks/through_defence_attack.hpp>

#include <limits>
#include <utility>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// The descents under way, one row for each lane and start, and the best place that each has seen.
class Descents {
 public:
  Descents(const BeliefAgent& agent, const ObservationBall& ball, std::vector<Lane> lanes, std::vector<Point> truths,
           torch::Tensor judged, double unit)
      : agent_(agent),
        ball_(ball),
        bounds_(truths, ball),
        lanes_(std::move(lanes)),
        truths_(std::move(truths)),
        judged_(std::move(judged)),
        unit_(unit) {
    const auto rows = static_cast<long>(lanes_.size());
    best_ = torch::zeros({rows, 2});
    hard_ = torch::full({rows}, std::numeric_limits<float>::infinity());
    soft_ = hard_.clone();
  }

  /// The objective at these places, which are all considered.
  torch::Tensor look(const torch::Tensor& wanted) {
    // What is asked of the agent is what would be shown, on the quantum grid.
    std::vector<Point> places = to_points(bounds_.clamp(wanted));
    for (std::size_t k = 0; k < places.size(); ++k) places[k] = ball_.project(truths_[k], places[k]);
    const torch::Tensor values = agent_.would_value(lanes_, places).to(torch::kCPU).clone();
    const torch::Tensor soft = (torch::softmax(values / unit_, 1) * judged_).sum(1);
    const torch::Tensor hard = judged_.gather(1, values.argmax(1, true)).squeeze(1);
    const torch::Tensor better = (hard < hard_) | ((hard == hard_) & (soft < soft_));
    best_ = torch::where(better.unsqueeze(1), to_tensor(places), best_);
    hard_ = torch::where(better, hard, hard_);
    soft_ = torch::where(better, soft, soft_);
    return soft;
  }

  torch::Tensor slope_sign(const torch::Tensor& at, double probe) {
    torch::Tensor signs = torch::empty_like(at);
    for (long axis = 0; axis < 2; ++axis) {
      torch::Tensor aside = torch::zeros({2});
      aside[axis] = probe;
      signs.select(1, axis).copy_((look(at + aside) - look(at - aside)).sign());
    }
    return signs;
  }

  const BallBounds& bounds() const { return bounds_; }
  const torch::Tensor& best() const { return best_; }
  const torch::Tensor& hard() const { return hard_; }
  const torch::Tensor& soft() const { return soft_; }

 private:
  const BeliefAgent& agent_;
  const ObservationBall& ball_;
  BallBounds bounds_;
  std::vector<Lane> lanes_;
  std::vector<Point> truths_;
  torch::Tensor judged_, best_, hard_, soft_;
  double unit_;
};

}  // namespace

ThroughDefenceAttack::ThroughDefenceAttack(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                                           const ThroughDefenceOptions& options)
    : judge_(std::move(judge)), ball_(ball), options_(options) {
  if (options.steps < 0 || options.starts < 1 || !(options.step_share > 0) || !(options.probe_share > 0) ||
      !(options.unit > 0)) {
    throw InputError("through defence: steps below 0, or no starts, step or unit, expected e.g. 10 steps of 0.1");
  }
}

void ThroughDefenceAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                   std::span<Stream> streams, std::span<Point> shown) {
  const auto* defence = dynamic_cast<const BeliefAgent*>(&agent);
  if (defence == nullptr) throw InputError("through defence: an agent without belief, expected a BeliefAgent");
  torch::NoGradGuard no_grad;
  // Row k * starts + i is start i of lane k.
  std::vector<Lane> row_lanes;
  std::vector<Point> row_truths, row_starts;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    for (int start = 0; start < options_.starts; ++start) {
      row_lanes.push_back(lanes[k]);
      row_truths.push_back(truths[k]);
      row_starts.push_back(ball_.draw(truths[k], streams[static_cast<std::size_t>(lanes[k])]));
    }
  }
  const torch::Tensor judged = values_at(*judge_, row_truths);
  torch::Tensor at = to_tensor(row_starts);
  Descents descents(*defence, ball_, std::move(row_lanes), std::move(row_truths), judged, options_.unit);
  descents.look(at);
  for (int i = 0; i < options_.steps; ++i) {
    const torch::Tensor sign = descents.slope_sign(at, options_.probe_share * ball_.eps());
    at = descents.bounds().clamp(at - options_.step_share * ball_.eps() * sign);
  }
  descents.look(at);
  const auto hard = descents.hard().accessor<float, 1>(), soft = descents.soft().accessor<float, 1>();
  const std::vector<Point> places = to_points(descents.best());
  const auto starts = static_cast<std::size_t>(options_.starts);
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    std::size_t least = k * starts;
    for (std::size_t row = least + 1; row < (k + 1) * starts; ++row) {
      const auto r = static_cast<long>(row), l = static_cast<long>(least);
      if (hard[r] < hard[l] || (hard[r] == hard[l] && soft[r] < soft[l])) least = row;
    }
    shown[k] = ball_.project(truths[k], places[least]);
  }
}

}  // namespace maximin::deep
