#include <maximin/deep/place_beliefs.hpp>

#include <algorithm>

namespace maximin::deep {

PlaceBeliefs::PlaceBeliefs(SetBelief kind, const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                           const Places& places)
    : kind_(kind), places_(&places), states_(perturbation.largest_ball()), fresh_(mdp, perturbation) {}

void PlaceBeliefs::resize(Lane lanes) {
  beliefs_.assign(static_cast<std::size_t>(lanes), fresh_);
  started_.assign(static_cast<std::size_t>(lanes), 0);
}

const Belief& PlaceBeliefs::advance(BeliefFilter<double>& belief, std::size_t lane, Action action, Point shown) const {
  const State observation = places_->state_at(shown);
  const bool remembers = started_[lane] != 0 && kind_ == SetBelief::exact;
  return remembers ? belief.update(action, observation) : belief.reset(observation);
}

BeliefStates PlaceBeliefs::all_empty(std::size_t lanes) const {
  const auto n = static_cast<long>(lanes);
  return {torch::empty({n, states_, 2}), torch::zeros({n, states_})};
}

void PlaceBeliefs::write(const Belief& belief, BeliefStates& out, std::size_t row) const {
  const auto k = static_cast<std::size_t>(states_);
  float* state = out.states.data_ptr<float>() + 2 * k * row;
  float* weight = out.weights.data_ptr<float>() + k * row;
  std::fill_n(weight, belief.size(), 1.0F / static_cast<float>(belief.size()));
  for (std::size_t i = 0; i < k; ++i) {
    const Point p = places_->point(belief[i < belief.size() ? i : 0]);
    *state++ = static_cast<float>(p.x);
    *state++ = static_cast<float>(p.y);
  }
}

BeliefStates PlaceBeliefs::update(std::span<const Lane> lanes, std::span<const Action> actions,
                                  std::span<const Point> shown) {
  BeliefStates out = all_empty(lanes.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    write(advance(beliefs_[l], l, actions[k], shown[k]), out, k);
    started_[l] = 1;
  }
  return out;
}

BeliefStates PlaceBeliefs::peek(std::span<const Lane> lanes, std::span<const Action> actions,
                                std::span<const Point> shown) const {
  BeliefStates out = all_empty(lanes.size());
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    BeliefFilter<double> probe = beliefs_[l];
    write(advance(probe, l, actions[k], shown[k]), out, k);
  }
  return out;
}

bool PlaceBeliefs::holds(Lane lane, Point truth) const {
  const Belief& belief = places(lane);
  return std::binary_search(belief.begin(), belief.end(), places_->state_at(truth));
}

long PlaceBeliefs::empty_intersections() const {
  long sum = 0;
  for (const auto& b : beliefs_) sum += b.empty_intersections();
  return sum;
}

}  // namespace maximin::deep
