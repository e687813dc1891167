#pragma once

#include <memory>
#include <span>
#include <utility>

#include <maximin/deep/belief_model.hpp>

namespace maximin::deep {

/// A belief of one state, the weighted mean of another belief's states: what an agent without pessimism makes of a
/// particle filter (the paper's "belief only"). Of set and size it tells what the other belief does.
class MeanState final : public LaneBelief {
 public:
  explicit MeanState(std::shared_ptr<LaneBelief> whole) : whole_(std::move(whole)) {}

  void resize(Lane lanes) override { whole_->resize(lanes); }
  void forget(Lane lane) override { whole_->forget(lane); }
  long states_per_belief() const override { return 1; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override {
    return mean(whole_->update(lanes, actions, shown));
  }
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override {
    return mean(whole_->peek(lanes, actions, shown));
  }
  bool holds(Lane lane, Point truth) const override { return whole_->holds(lane, truth); }
  double size(Lane lane) const override { return whole_->size(lane); }
  long empty_intersections() const override { return whole_->empty_intersections(); }

 private:
  /// Of places, [n, K, 2].
  static BeliefStates mean(const BeliefStates& whole) {
    return {(whole.states * whole.weights.unsqueeze(2)).sum(1, true), torch::ones({whole.states.size(0), 1})};
  }

  std::shared_ptr<LaneBelief> whole_;
};

}  // namespace maximin::deep
