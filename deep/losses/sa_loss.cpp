#include <limits>
#include <string>

#include <maximin/deep/losses/sa_loss.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

torch::Tensor greatest_lead(const torch::Tensor& difference_bounds, const torch::Tensor& reference) {
  return difference_bounds.scatter(1, reference.unsqueeze(1), -std::numeric_limits<double>::infinity()).amax(1);
}

void SaLossOptions::check() const {
  const RangeCheck require("SA loss");
  td.check(require);
  ramp.check(require);
  require(kappa >= 0, "kappa", kappa, "at least 0");
  require(margin >= 0, "margin", margin, "at least 0");
}

SaLoss::SaLoss(const SaLossOptions& options) : options_(options) {
  options_.check();
}

torch::Tensor SaLoss::hinge(const torch::Tensor& states, QNetwork& online, const Progress& progress) const {
  if (online.shape().actions < 2) throw InputError("SA loss: a network of one action, expected at least 2");
  torch::Tensor greedy;
  {
    torch::NoGradGuard no_grad;
    greedy = online.forward(states).argmax(1);
  }
  const StateBox ball = options_.ramp.ball(states, progress);
  const auto bounds = [&](BoundMethod method) { return difference_upper_bounds(online, ball, greedy, method); };
  // A mean of two upper bounds is an upper bound.
  const double beta = options_.bounds ? 1 : 1 - options_.ramp.share(progress);
  torch::Tensor upper = beta > 0 ? beta * bounds(options_.bounds.value_or(BoundMethod::crown_ibp)) : torch::Tensor();
  if (beta < 1) upper = upper.defined() ? upper + (1 - beta) * bounds(BoundMethod::ibp) : bounds(BoundMethod::ibp);
  return greatest_lead(upper, greedy).clamp_min(-options_.margin);
}

LossValue SaLoss::operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) {
  const torch::Tensor y = next_state_target(batch, online, target, options_.td);
  const torch::Tensor error = y - of_actions(online.forward(batch.states), batch.actions);
  return {huber(error, options_.td.huber) + options_.kappa * hinge(batch.states, online, progress), error.detach()};
}

}  // namespace maximin::deep
