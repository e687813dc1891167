#pragma once

#include <maximin/deep/aggregate.hpp>
#include <maximin/deep/loss.hpp>
#include <maximin/deep/losses/td_error.hpp>

namespace maximin::deep {

/// In which order the target takes the best action and the worst state.
enum class TargetOrder {
  max_of_aggregate,  ///< max_a Aggregate_{m in M} Q'(m,a), the paper's maximin
  aggregate_of_max,  ///< Aggregate_{m in M} max_a Q'(m,a), the released Gridworld code
  /// Aggregate_{m in M} Q'(s',a_m) with a_m greedy at m: the true next state, and what may be done there (the released
  /// Atari code, with the minimum).
  belief_greedy,
};

struct TdLossOptions {
  TdOptions td{.double_q = false};  ///< the two networks are for the order max_of_aggregate alone
  AnyAggregator aggregator = MinAggregator{};
  TargetOrder order = TargetOrder::max_of_aggregate;
};

/// The Huber loss of Q(s_t, a_t) against y = R_t + gamma max_a Aggregate_{m in M_{t+1}} Q'(m, a), or R_t where the
/// episode is over: BP-DQN (paper, Algorithm 4), and DQN where the belief is the next state itself.
class TdLoss final : public Loss {
 public:
  explicit TdLoss(const TdLossOptions& options) : options_(options) {}
  LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) override;

  /// y, [b], without gradient.
  torch::Tensor target_values(const Batch& batch, QNetwork& online, QNetwork& target) const;

 private:
  TdLossOptions options_;
};

/// Values of every state of every belief, [b, K, actions].
torch::Tensor values_over(const BeliefStates& belief, ActionValueModule& q);

}  // namespace maximin::deep
