#include <maximin/deep/losses/td_loss.hpp>

namespace maximin::deep {

torch::Tensor values_over(const BeliefStates& belief, ActionValueModule& q) {
  const long b = belief.states.size(0), k = belief.states.size(1);
  return q.forward(belief.states.flatten(0, 1)).view({b, k, -1});
}

torch::Tensor TdLoss::target_values(const Batch& batch, QNetwork& online, QNetwork& target) const {
  torch::NoGradGuard no_grad;
  const torch::Tensor& weights = batch.next_belief.weights;
  const torch::Tensor q = values_over(batch.next_belief, target);
  torch::Tensor next;
  if (options_.order == TargetOrder::aggregate_of_max) {
    next = aggregate(options_.aggregator, q.amax(2, true), weights).squeeze(1);
  } else if (options_.order == TargetOrder::belief_greedy) {
    const torch::Tensor there = target.forward(batch.next_states).gather(1, q.argmax(2));
    next = aggregate(options_.aggregator, there.unsqueeze(2), weights).squeeze(1);
  } else if (options_.td.double_q) {
    const torch::Tensor chooser = aggregate(options_.aggregator, values_over(batch.next_belief, online), weights);
    next = of_actions(aggregate(options_.aggregator, q, weights), chooser.argmax(1));
  } else {
    next = aggregate(options_.aggregator, q, weights).amax(1);
  }
  return bootstrapped(batch, options_.td.discount, next);
}

LossValue TdLoss::operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress&) {
  const torch::Tensor y = target_values(batch, online, target);
  const torch::Tensor q = of_actions(online.forward(batch.states), batch.actions);
  const torch::Tensor error = y - q;
  return {huber(error, options_.td.huber), error.detach()};
}

}  // namespace maximin::deep
