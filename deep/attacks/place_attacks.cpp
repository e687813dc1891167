#include <maximin/deep/attacks/place_attacks.hpp>

#include <stdexcept>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {

FixedPlaceAttack::FixedPlaceAttack(AttackPolicy attack, const Perturbation<double>& perturbation, const Places& places)
    : attack_(std::move(attack)), places_(&places) {
  if (attack_.size() != static_cast<std::size_t>(perturbation.states())) {
    throw InputError(
        fmt::format("attack: {} answers, expected one per state, {}", attack_.size(), perturbation.states()));
  }
  for (State s = 0; s < perturbation.states(); ++s) {
    const State shown = attack_[static_cast<std::size_t>(s)];
    if (!perturbation.contains(s, shown)) {
      throw std::logic_error(
          fmt::format("attack: shows state {} when state {} is true, which is outside its ball", shown, s));
    }
  }
}

void FixedPlaceAttack::perturb(std::span<const Lane>, std::span<const Point> truths, const GridAgent&,
                               std::span<Stream>, std::span<Point> shown) {
  for (std::size_t k = 0; k < truths.size(); ++k) {
    shown[k] = places_->point(attack_[static_cast<std::size_t>(places_->state_at(truths[k]))]);
  }
}

PlaceBestResponse::PlaceBestResponse(std::shared_ptr<ActionValueModule> judge, const Perturbation<double>& perturbation,
                                     const Places& places)
    : judge_(std::move(judge)), perturbation_(&perturbation), places_(&places) {}

void PlaceBestResponse::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                std::span<Stream>, std::span<Point> shown) {
  const torch::Tensor values = values_at(*judge_, truths).to(torch::kDouble);
  std::vector<Lane> asked;
  std::vector<Point> candidates;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    for (const State t : perturbation_->ball(places_->state_at(truths[k]))) {
      asked.push_back(lanes[k]);
      candidates.push_back(places_->point(t));
    }
  }
  std::vector<Action> answers(candidates.size());
  agent.would_do(asked, candidates, answers);
  std::size_t next = 0;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const double* q = values.data_ptr<double>() + static_cast<long>(k) * values.size(1);
    const std::size_t end = next + perturbation_->ball(places_->state_at(truths[k])).size();
    std::size_t worst = next;
    for (; next < end; ++next) {
      if (q[answers[next]] < q[answers[worst]]) worst = next;
    }
    shown[k] = candidates[worst];
  }
}

}  // namespace maximin::deep
