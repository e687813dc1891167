#include <cmath>
#include <limits>
#include <string>

#include <maximin/deep/losses/sa_loss.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

void WocarLossOptions::check() const {
  const RangeCheck require("WocaR loss");
  td.check(require);
  ramp.check(require);
  require(kappa >= 0 && kappa <= 1, "kappa", kappa, "0 to 1");
  require(worst_share >= 0 && worst_share <= 1, "worst_share", worst_share, "0 to 1");
  require(hinge_margin >= 0, "hinge_margin", hinge_margin, "at least 0");
  require(!critic_floor || std::isfinite(*critic_floor), "critic_floor", critic_floor.value_or(0), "finite");
  const double critic = critic_eps.value_or(0);
  require(critic >= 0 && std::isfinite(critic), "critic_eps", critic, "finite and at least 0");
}

WocarLoss::WocarLoss(const WocarLossOptions& options, const QNetworkShape& shape, Stream& rng)
    : options_(options), critic_(std::make_shared<QNetwork>(shape, rng)), critic_target_(frozen_copy(*critic_)) {
  options_.check();
}

void WocarLoss::start_from(const QNetwork& q) {
  critic_->copy_from(q);
  copy_targets();
}

torch::Tensor WocarLoss::reachable(const torch::Tensor& states, QNetwork& online, const Progress& progress) const {
  torch::NoGradGuard no_grad;
  const double eps = options_.critic_eps.value_or(options_.ramp.eps_at(progress));
  const StateBox ball = ball_around(states, eps, options_.ramp.range);
  torch::Tensor values = online.forward(states);
  if (options_.reach_of_acting_values) values = mix(values, critic_->forward(states));
  const torch::Tensor greedy = values.argmax(1);
  // What can be greedy somewhere leads there the action that is greedy at the state itself.
  torch::Tensor leads = difference_upper_bounds(online, ball, greedy, options_.reach_bounds);
  // A mean of bounds bounds the mean.
  if (options_.reach_of_acting_values)
    leads = mix(leads, difference_upper_bounds(*critic_, ball, greedy, options_.reach_bounds));
  return leads >= 0;
}

torch::Tensor WocarLoss::target_values(const Batch& batch, QNetwork& online, QNetwork& target) const {
  torch::NoGradGuard no_grad;
  const torch::Tensor& next = batch.next_states;
  const torch::Tensor values = target.forward(next);
  const torch::Tensor chooser = options_.td.double_q ? mix(online.forward(next), critic_->forward(next))
                                                     : mix(values, critic_target_->forward(next));
  return bootstrapped(batch, options_.td.discount, of_actions(values, chooser.argmax(1)));
}

torch::Tensor WocarLoss::critic_target_values(const Batch& batch, QNetwork& online, const Progress& progress) const {
  torch::NoGradGuard no_grad;
  const torch::Tensor reach = reachable(options_.reach_at_state ? batch.states : batch.next_states, online, progress);
  const QNetworkPtr& valuer = options_.critic_target_network ? critic_target_ : critic_;
  const torch::Tensor values = valuer->forward(batch.next_states);
  const torch::Tensor worst =
      values.masked_fill(torch::logical_not(reach), std::numeric_limits<double>::infinity()).amin(1);
  const torch::Tensor y = bootstrapped(batch, options_.td.discount, worst);
  return options_.critic_floor ? y.clamp_min(*options_.critic_floor) : y;
}

torch::Tensor WocarLoss::robust_term(const Batch& batch, QNetwork& online, const torch::Tensor& values,
                                     const torch::Tensor& y, const Progress& progress) const {
  if (options_.robust_term == WocarRobustTerm::none) return torch::zeros_like(y);
  if (options_.robust_term == WocarRobustTerm::important_hinge) {
    const SaLossOptions hinge{options_.td, options_.ramp, 1, options_.hinge_margin, options_.robust_bounds};
    torch::Tensor importance;
    {
      torch::NoGradGuard no_grad;
      const torch::Tensor worst = critic_->forward(batch.states);
      importance = worst.amax(1) - worst.amin(1);
      importance = importance / importance.mean().clamp_min(std::numeric_limits<float>::min());
    }
    return importance * SaLoss(hinge).hinge(batch.states, online, progress);
  }
  const OutputBounds q = output_bounds(online, options_.ramp.ball(batch.states, progress), options_.robust_bounds);
  const torch::Tensor taken = batch.actions.unsqueeze(1);
  const torch::Tensor is_taken = torch::zeros_like(values, torch::kBool).scatter(1, taken, true);
  const torch::Tensor anchor = torch::where(is_taken, y.unsqueeze(1), values);
  const torch::Tensor errors = options_.robust_term == WocarRobustTerm::both_ends
                                   ? torch::maximum((q.upper - anchor).abs(), (q.lower - anchor).abs())
                                   : torch::where(is_taken, q.lower, q.upper) - anchor;
  return huber(errors, options_.td.huber).sum(1);
}

LossValue WocarLoss::operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) {
  const torch::Tensor y = target_values(batch, online, target);
  const torch::Tensor values = online.forward(batch.states);
  const torch::Tensor error = y - of_actions(values, batch.actions);
  const double share = options_.ramp_kappa ? options_.ramp.share(progress) : 1;
  const double kappa = options_.robust_term == WocarRobustTerm::none ? 1 : 1 - share * (1 - options_.kappa);

  const torch::Tensor worst_error =
      critic_target_values(batch, online, progress) - of_actions(critic_->forward(batch.states), batch.actions);
  torch::Tensor loss = kappa * huber(error, options_.td.huber) + huber(worst_error, options_.td.huber);
  if (kappa < 1) loss = loss + (1 - kappa) * robust_term(batch, online, values, y, progress);
  return {loss, error.detach()};
}

}  // namespace maximin::deep
