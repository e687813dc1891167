#include <maximin/deep/set_beliefs.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

BeliefStates ObservedState::update(std::span<const Lane> lanes, std::span<const Action> actions,
                                   std::span<const Point> shown) {
  for (std::size_t k = 0; k < lanes.size(); ++k) shown_[static_cast<std::size_t>(lanes[k])] = shown[k];
  return peek(lanes, actions, shown);
}

BeliefStates ObservedState::peek(std::span<const Lane>, std::span<const Action>, std::span<const Point> shown) const {
  const torch::Tensor states = to_tensor(shown).unsqueeze(1);
  return {states, torch::ones({states.size(0), 1})};
}

SetBeliefs::SetBeliefs(SetBelief kind, const ObservationBall& ball, long states, const GridworldOptions& world)
    : FilterBeliefs(kind, BoxBelief(ball, world), states) {
  if (states < 1 || states > 4096) {
    throw InputError(fmt::format("belief: {} states, expected 1 to 4096", states));
  }
}

void SetBeliefs::write(const BoxBelief& filter, BeliefStates& out, std::size_t row) const {
  const auto k = static_cast<std::size_t>(states_per_belief());
  std::fill_n(out.weights.data_ptr<float>() + k * row, k, 1.0F / static_cast<float>(k));
  float* state = out.states.data_ptr<float>() + 2 * k * row;
  for (const Point& p : filter.belief().spread(static_cast<int>(k))) {
    *state++ = static_cast<float>(p.x);
    *state++ = static_cast<float>(p.y);
  }
}

}  // namespace maximin::deep
