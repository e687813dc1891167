#include <maximin/deep/attacks/through_defence_attack.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// Searches side by side, `each` of them for every lane, and the best place that each has seen.
class Searches {
 public:
  Searches(const BeliefAgent& agent, const ObservationBall& ball, ActionValueModule& judge, double unit,
           std::span<const Lane> lanes, std::span<const Point> truths, std::size_t each)
      : agent_(agent),
        ball_(ball),
        unit_(unit),
        each_(each),
        lanes_(repeated(lanes, each)),
        truths_(repeated(truths, each)),
        bounds_(truths_, ball),
        judged_(values_at(judge, truths_)) {
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

  torch::Tensor stepped(const torch::Tensor& at, double step, double probe) {
    return bounds_.clamp(at - step * slope_sign(at, probe));
  }

  /// The `count` best places of every lane, the best first.
  std::vector<Point> best_places(int count) const {
    const float *hard = hard_.data_ptr<float>(), *soft = soft_.data_ptr<float>();
    const std::vector<Point> best = to_points(best_);
    std::vector<std::size_t> rows(each_);
    std::vector<Point> out;
    for (std::size_t first = 0; first < best.size(); first += each_) {
      std::iota(rows.begin(), rows.end(), first);
      std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
        return std::pair(hard[a], soft[a]) < std::pair(hard[b], soft[b]);
      });
      for (int i = 0; i < count; ++i) out.push_back(best[rows[static_cast<std::size_t>(i)]]);
    }
    return out;
  }

 private:
  template <class T>
  static std::vector<T> repeated(std::span<const T> of, std::size_t each) {
    std::vector<T> out;
    for (const T& one : of) out.insert(out.end(), each, one);
    return out;
  }

  const BeliefAgent& agent_;
  const ObservationBall& ball_;
  double unit_;
  std::size_t each_;
  std::vector<Lane> lanes_;  ///< this and what follows: by row
  std::vector<Point> truths_;
  BallBounds bounds_;
  torch::Tensor judged_, best_, hard_, soft_;
};

}  // namespace

ThroughDefenceAttack::ThroughDefenceAttack(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                                           const ThroughDefenceOptions& options)
    : judge_(std::move(judge)), ball_(ball), options_(options) {
  if (options.steps < 0 || !(options.step_share > 0) || !(options.probe_share > 0) || !(options.unit > 0)) {
    throw InputError("through defence: steps below 0, or no step or unit, expected e.g. 10 steps of 0.1");
  }
  const int looks = options.grid * options.grid + options.random;
  if (options.grid < 0 || options.grid == 1 || options.random < 0 || options.starts < 1 || options.starts > looks) {
    throw InputError(fmt::format("through defence: {} starts from {} first looks, expected 1 to as many as there are",
                                 options.starts, looks));
  }
}

void ThroughDefenceAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                   std::span<Stream> streams, std::span<Point> shown) {
  const auto* defence = dynamic_cast<const BeliefAgent*>(&agent);
  if (defence == nullptr) throw InputError("through defence: an agent without belief, expected a BeliefAgent");
  torch::NoGradGuard no_grad;
  std::vector<Point> places;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    add_grid(ball_, truths[k], options_.grid, places);
    Stream& rng = streams[static_cast<std::size_t>(lanes[k])];
    for (int i = 0; i < options_.random; ++i) places.push_back(ball_.draw(truths[k], rng));
  }
  const auto searches = [&](std::size_t each) {
    return Searches(*defence, ball_, *judge_, options_.unit, lanes, truths, each);
  };
  Searches looks = searches(places.size() / lanes.size());
  looks.look(to_tensor(places));
  torch::Tensor at = to_tensor(looks.best_places(options_.starts));
  Searches descents = searches(static_cast<std::size_t>(options_.starts));
  descents.look(at);
  for (int i = 0; i < options_.steps; ++i) {
    at = descents.stepped(at, options_.step_share * ball_.eps(), options_.probe_share * ball_.eps());
  }
  descents.look(at);
  const std::vector<Point> least = descents.best_places(1);
  for (std::size_t k = 0; k < lanes.size(); ++k) shown[k] = ball_.project(truths[k], least[k]);
}

}  // namespace maximin::deep
