#pragma once

#include <vector>

#include <maximin/deep/belief_model.hpp>
#include <maximin/deep/places.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/tabular/belief_update.hpp>

namespace maximin::deep {

/// A set of finitely many places, all of them: the ball around what is shown, or the exact filter of the tabular layer.
/// K is the size of the largest ball, which no belief exceeds; what a smaller belief lacks has weight 0 and repeats its
/// first place. Model, perturbation and places must outlive it. An observation that is no place throws InputError.
class PlaceBeliefs final : public LaneBelief {
 public:
  PlaceBeliefs(SetBelief kind, const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
               const Places& places);

  void resize(Lane lanes) override;
  void forget(Lane lane) override { started_[static_cast<std::size_t>(lane)] = false; }
  long states_per_belief() const override { return states_; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override;
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override;
  bool holds(Lane lane, Point truth) const override;
  /// The number of places in the belief.
  double size(Lane lane) const override { return static_cast<double>(places(lane).size()); }
  long empty_intersections() const override;

  /// The belief itself.
  const Belief& places(Lane lane) const { return beliefs_[static_cast<std::size_t>(lane)].belief(); }

 private:
  const Belief& advance(BeliefFilter<double>& belief, std::size_t lane, Action action, Point shown) const;
  BeliefStates all_empty(std::size_t lanes) const;
  void write(const Belief& belief, BeliefStates& out, std::size_t row) const;

  SetBelief kind_;
  const Places* places_;
  long states_;
  BeliefFilter<double> fresh_;
  std::vector<BeliefFilter<double>> beliefs_;
  std::vector<char> started_;
};

}  // namespace maximin::deep
