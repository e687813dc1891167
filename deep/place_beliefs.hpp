#pragma once

#include <maximin/deep/filter_beliefs.hpp>
#include <maximin/deep/places.hpp>
#include <maximin/tabular/belief_update.hpp>

namespace maximin::deep {

/// A set of finitely many places, all of them: the ball around what is shown, or the exact filter of the tabular layer.
/// K is the size of the largest ball, which no belief exceeds; what a smaller belief lacks has weight 0 and repeats its
/// first place. Model, perturbation and places must outlive it. An observation that is no place throws InputError.
class PlaceBeliefs final : public FilterBeliefs<BeliefFilter<double>> {
 public:
  PlaceBeliefs(SetBelief kind, const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
               const Places& places);

  bool holds(Lane lane, Point truth) const override;
  /// The number of places in the belief.
  double size(Lane lane) const override { return static_cast<double>(places(lane).size()); }

  /// The belief itself.
  const Belief& places(Lane lane) const { return filter(lane).belief(); }

 private:
  void begin(BeliefFilter<double>& filter, Point shown) const override;
  void go_on(BeliefFilter<double>& filter, Action action, Point shown) const override;
  void write(const BeliefFilter<double>& filter, BeliefStates& out, std::size_t row) const override;

  const Places* places_;
};

}  // namespace maximin::deep
