#pragma once

#include <span>
#include <utility>
#include <vector>

#include <maximin/deep/belief_model.hpp>

namespace maximin::deep {

/// What a set belief goes by.
enum class SetBelief {
  ball,   ///< what is possible in the ball around what is shown now; no memory (paper, Algorithm 1)
  exact,  ///< everything that the whole history leaves possible, the model of the world being known
};

/// A set of places that a filter of one episode keeps, in every lane a copy of it. K places stand for the set.
template <class Filter>
class FilterBeliefs : public LaneBelief {
 public:
  FilterBeliefs(SetBelief kind, Filter fresh, long states) : kind_(kind), fresh_(std::move(fresh)), states_(states) {}

  void resize(Lane lanes) override { lanes_.assign(static_cast<std::size_t>(lanes), {fresh_, false}); }
  void forget(Lane lane) override { lanes_[static_cast<std::size_t>(lane)].started = false; }
  long states_per_belief() const override { return states_; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override {
    BeliefStates out = none(lanes.size());
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      InLane& in = lanes_[static_cast<std::size_t>(lanes[k])];
      advance(in, actions[k], shown[k]);
      write(in.filter, out, k);
    }
    return out;
  }
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override {
    BeliefStates out = none(lanes.size());
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      InLane probe = lanes_[static_cast<std::size_t>(lanes[k])];
      advance(probe, actions[k], shown[k]);
      write(probe.filter, out, k);
    }
    return out;
  }
  long empty_intersections() const override {
    long sum = 0;
    for (const InLane& in : lanes_) sum += in.filter.empty_intersections();
    return sum;
  }

 protected:
  const Filter& filter(Lane lane) const { return lanes_[static_cast<std::size_t>(lane)].filter; }

 private:
  struct InLane {
    Filter filter;
    bool started;
  };

  virtual void begin(Filter& filter, Point shown) const = 0;
  virtual void go_on(Filter& filter, Action action, Point shown) const = 0;
  /// The K places and their weights into a row that is all 0.
  virtual void write(const Filter& filter, BeliefStates& out, std::size_t row) const = 0;

  void advance(InLane& in, Action action, Point shown) const {
    if (in.started && kind_ == SetBelief::exact) {
      go_on(in.filter, action, shown);
    } else {
      begin(in.filter, shown);
    }
    in.started = true;
  }
  BeliefStates none(std::size_t lanes) const {
    const auto n = static_cast<long>(lanes);
    return {torch::zeros({n, states_, 2}), torch::zeros({n, states_})};
  }

  SetBelief kind_;
  Filter fresh_;
  long states_;
  std::vector<InLane> lanes_;
};

}  // namespace maximin::deep
