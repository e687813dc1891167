#include <maximin/deep/set_beliefs.hpp>

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

SetBeliefs::SetBeliefs(SetBelief kind, const ObservationBall& ball, long states)
    : kind_(kind), states_(states), fresh_(ball) {
  if (states < 1 || states > 4096) {
    throw InputError(fmt::format("belief: {} states, expected 1 to 4096", states));
  }
}

void SetBeliefs::resize(Lane lanes) {
  beliefs_.assign(static_cast<std::size_t>(lanes), fresh_);
  started_.assign(static_cast<std::size_t>(lanes), 0);
}

void SetBeliefs::advance(BoxBelief& belief, bool started, Action action, Point shown) const {
  if (started && kind_ == SetBelief::exact) {
    belief.update(action, shown);
  } else {
    belief.reset(shown);
  }
}

BeliefStates SetBeliefs::all_empty(std::size_t lanes) const {
  const auto n = static_cast<long>(lanes);
  return {torch::empty({n, states_, 2}), torch::full({n, states_}, 1.0 / static_cast<double>(states_))};
}

void SetBeliefs::write(const BoxUnion& set, torch::Tensor& states, std::size_t row) const {
  float* out = states.data_ptr<float>() + row * static_cast<std::size_t>(2 * states_);
  for (const Point& p : set.spread(static_cast<int>(states_))) {
    *out++ = static_cast<float>(p.x);
    *out++ = static_cast<float>(p.y);
  }
}

BeliefStates SetBeliefs::update(std::span<const Lane> lanes, std::span<const Action> actions,
                                std::span<const Point> shown) {
  BeliefStates out = all_empty(lanes.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    advance(beliefs_[l], started_[l] != 0, actions[k], shown[k]);
    started_[l] = 1;
    write(beliefs_[l].belief(), out.states, k);
  }
  return out;
}

BeliefStates SetBeliefs::peek(std::span<const Lane> lanes, std::span<const Action> actions,
                              std::span<const Point> shown) const {
  BeliefStates out = all_empty(lanes.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    BoxBelief probe = beliefs_[l];
    advance(probe, started_[l] != 0, actions[k], shown[k]);
    write(probe.belief(), out.states, k);
  }
  return out;
}

long SetBeliefs::empty_intersections() const {
  long sum = 0;
  for (const BoxBelief& b : beliefs_) sum += b.empty_intersections();
  return sum;
}

}  // namespace maximin::deep
