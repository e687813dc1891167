#include <maximin/deep/attacks/network_search.hpp>

#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

NetworkSearchOptions network_search_named(std::string_view name) {
  NetworkSearchOptions options;
  if (name == "pgd-search") return options;
  if (name != "min-best-search") {
    throw InputError(fmt::format("network search: {}, expected pgd-search or min-best-search", name));
  }
  options.objective = AttackObjective::min_best;
  return options;
}

NetworkSearch::NetworkSearch(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball,
                             const NetworkSearchOptions& options)
    : q_(std::move(q)), ball_(ball), options_(options) {
  if (options.grid < 0 || options.random < 0 || options.grid == 1 || options.grid + options.random == 0) {
    throw InputError("network search: no candidates, expected a grid of 2 or more points a side, or random ones");
  }
}

void NetworkSearch::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&,
                            std::span<Stream> streams, std::span<Point> shown) {
  std::vector<Point> places, repeated;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    add_grid(ball_, truths[k], options_.grid, places);
    Stream& rng = streams[static_cast<std::size_t>(lanes[k])];
    for (int i = 0; i < options_.random; ++i) places.push_back(ball_.draw(truths[k], rng));
    repeated.resize(places.size(), truths[k]);
  }
  torch::NoGradGuard no_grad;
  const torch::Device device = device_of(*q_);
  const torch::Tensor q_truth = q_->forward(to_tensor(repeated).to(device));
  const AttackedStates attacked{q_truth, q_truth.argmax(1, true)};
  const torch::Tensor q_shown = q_->forward(to_tensor(places).to(device));
  const torch::Tensor hard = hard_objective(options_.objective, q_shown, attacked).to(torch::kCPU, torch::kDouble);
  const torch::Tensor smooth = smooth_objective(options_.objective, q_shown, attacked).to(torch::kCPU, torch::kDouble);
  const auto objective = [&, hard_at = hard.data_ptr<double>(), smooth_at = smooth.data_ptr<double>()](std::size_t i) {
    return std::pair{hard_at[i], smooth_at[i]};
  };
  const std::size_t each = places.size() / lanes.size();
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    std::size_t least = k * each;
    for (std::size_t i = least + 1; i < (k + 1) * each; ++i) {
      if (objective(i) < objective(least)) least = i;
    }
    shown[k] = places[least];
  }
}

}  // namespace maximin::deep
