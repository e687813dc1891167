#include <cmath>
#include <string>

#include <maximin/deep/losses/td_error.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

void TdOptions::check(const RangeCheck& require) const {
  require(discount >= 0 && discount <= 1, "discount", discount, "0 to 1");
  require(huber > 0 && std::isfinite(huber), "huber", huber, "above 0, e.g. 1");
}

torch::Tensor next_state_target(const Batch& batch, ActionValueModule& online, ActionValueModule& target,
                                const TdOptions& options) {
  torch::NoGradGuard no_grad;
  const torch::Tensor values = target.forward(batch.next_states);
  const torch::Tensor next =
      options.double_q ? of_actions(values, online.forward(batch.next_states).argmax(1)) : values.amax(1);
  return bootstrapped(batch, options.discount, next);
}

torch::Tensor bootstrapped(const Batch& batch, double discount, const torch::Tensor& next) {
  return batch.rewards + discount * (1 - batch.terminal) * next;
}

torch::Tensor of_actions(const torch::Tensor& values, const torch::Tensor& actions) {
  return values.gather(1, actions.unsqueeze(1)).squeeze(1);
}

torch::Tensor huber(const torch::Tensor& errors, double delta) {
  return torch::huber_loss(errors, torch::zeros_like(errors), torch::Reduction::None, delta);
}

}  // namespace maximin::deep
