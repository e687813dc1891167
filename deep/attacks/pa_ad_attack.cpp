#include <maximin/deep/attacks/pa_ad_attack.hpp>

#include <utility>

namespace maximin::deep {

PaAdAttack::PaAdAttack(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball, const PaAdOptions& options)
    : Director(ball, options.director, 0, ContinuousGridworld::actions), actor_(std::move(q), ball, options.actor) {}

Situations PaAdAttack::look(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent&) const {
  torch::Tensor features = blank_features(lanes.size());
  float* out = features.data_ptr<float>();
  for (std::size_t k = 0; k < lanes.size(); ++k) out = write_place(lanes[k], truths[k], out);
  return {features, torch::zeros({features.size(0), choices()})};
}

void PaAdAttack::realise(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> choices,
                         std::span<Stream> streams, std::span<Point> shown) {
  actor_.find(lanes, truths, choices, streams, shown);
}

nlohmann::ordered_json PaAdAttack::about() const {
  nlohmann::ordered_json out = Director::about();
  const TargetedSearchOptions& actor = actor_.options();
  out["attack"] = "pa-ad";
  out["actor"] = actor.method == SearchMethod::grid ? "grid" : "pgd";
  out["actor_grid"] = actor.grid;
  out["actor_steps"] = actor.method == SearchMethod::grid ? actor.refinement : actor.steps;
  return out;
}

}  // namespace maximin::deep
