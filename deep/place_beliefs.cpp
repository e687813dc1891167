#include <maximin/deep/place_beliefs.hpp>

#include <algorithm>

namespace maximin::deep {

PlaceBeliefs::PlaceBeliefs(SetBelief kind, const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                           const Places& places)
    : FilterBeliefs(kind, BeliefFilter<double>(mdp, perturbation), perturbation.largest_ball()), places_(&places) {}

void PlaceBeliefs::begin(BeliefFilter<double>& filter, Point shown) const {
  filter.reset(places_->state_at(shown));
}

void PlaceBeliefs::go_on(BeliefFilter<double>& filter, Action action, Point shown) const {
  filter.update(action, places_->state_at(shown));
}

void PlaceBeliefs::write(const BeliefFilter<double>& filter, BeliefStates& out, std::size_t row) const {
  const Belief& belief = filter.belief();
  const auto k = static_cast<std::size_t>(states_per_belief());
  float* state = out.states.data_ptr<float>() + 2 * k * row;
  float* weight = out.weights.data_ptr<float>() + k * row;
  std::fill_n(weight, belief.size(), 1.0F / static_cast<float>(belief.size()));
  for (std::size_t i = 0; i < k; ++i) {
    const Point p = places_->point(belief[i < belief.size() ? i : 0]);
    *state++ = static_cast<float>(p.x);
    *state++ = static_cast<float>(p.y);
  }
}

bool PlaceBeliefs::holds(Lane lane, Point truth) const {
  const Belief& belief = places(lane);
  return std::binary_search(belief.begin(), belief.end(), places_->state_at(truth));
}

}  // namespace maximin::deep
