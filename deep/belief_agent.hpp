#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/aggregate.hpp>
#include <maximin/deep/belief_model.hpp>
#include <maximin/deep/q_network.hpp>

namespace maximin::deep {

/// Action values, a belief model and an aggregator: acts by argmax_a Aggregate_{m in M_t} Q(m, a). With the particle
/// filter or the exact set and the minimum it is the paper's BP-DQN (its Algorithm 5); with ObservedState any DQN.
class BeliefAgent final : public GridAgent {
 public:
  /// `random_actions` is the share of actions drawn at random instead, 0 to 1: exploration in training, or a way out of
  /// deadlocks.
  BeliefAgent(std::shared_ptr<ActionValueModule> q, std::shared_ptr<LaneBelief> belief, AnyAggregator aggregator,
              double random_actions = 0);

  void resize(Lane lanes) override;
  void forget(Lane lane) override;
  /// Takes one or two numbers of a lane's stream where random_actions > 0, else none.
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) override;
  void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const override;

  /// Of a belief over places; of other beliefs (images) only the last action is told.
  Mind mind(Lane lane) const override { return minds_[static_cast<std::size_t>(lane)]; }

  bool holds(Lane lane, Point place) const override { return belief_->holds(lane, place); }
  double belief_size(Lane lane) const override { return belief_->size(lane); }
  long empty_intersections() const override { return belief_->empty_intersections(); }
  /// The sets that it knows exactly; of other beliefs the states that it acted on last, where those were this lane's
  /// only.
  TraceBelief picture(Lane lane) const override;

  /// The values by which `would_do` chooses, [n, actions].
  torch::Tensor would_value(std::span<const Lane> lanes, std::span<const Point> shown) const;

  void set_random_actions(double share) { random_actions_ = share; }
  double random_actions() const { return random_actions_; }

  /// The beliefs by which the last `act` acted, in its order of lanes.
  const BeliefStates& acted_on() const { return acted_on_; }
  ActionValueModule& q() const { return *q_; }
  const LaneBelief& belief() const { return *belief_; }
  const AnyAggregator& aggregator() const { return aggregator_; }
  /// The lane's last action, which its next belief takes into account.
  Action last_action(Lane lane) const { return minds_[static_cast<std::size_t>(lane)].last_action; }

 private:
  torch::Tensor values(const BeliefStates& belief) const;
  void remember(std::span<const Lane> lanes, std::span<const Action> actions);
  std::vector<Action> last_of(std::span<const Lane> lanes) const;

  std::shared_ptr<ActionValueModule> q_;
  std::shared_ptr<LaneBelief> belief_;
  AnyAggregator aggregator_;
  double random_actions_;
  BeliefStates acted_on_;
  std::vector<Mind> minds_;
};

}  // namespace maximin::deep
