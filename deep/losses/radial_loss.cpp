#include <string>

#include <maximin/deep/losses/radial_loss.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

void RadialLossOptions::check() const {
  const RangeCheck require("Radial loss");
  td.check(require);
  ramp.check(require);
  require(kappa >= 0 && kappa <= 1, "kappa", kappa, "0 to 1");
}

RadialLoss::RadialLoss(const RadialLossOptions& options) : options_(options) {
  options_.check();
}

torch::Tensor RadialLoss::adversarial(const Batch& batch, const torch::Tensor& values, const QNetwork& online,
                                      const Progress& progress) const {
  const StateBox ball = options_.ramp.ball(batch.states, progress);
  const torch::Tensor taken = batch.actions.unsqueeze(1);
  const torch::Tensor distance = (values.gather(1, taken) - values).clamp_min(0).detach();
  torch::Tensor lead;
  if (options_.overlap == RadialOverlap::merged_difference) {
    lead = difference_upper_bounds(online, ball, batch.actions, options_.bounds);
  } else {
    const OutputBounds q = output_bounds(online, ball, options_.bounds);
    lead = q.upper - q.lower.gather(1, taken);
  }
  return (distance * (lead + distance / 2).clamp_min(0)).sum(1);
}

LossValue RadialLoss::operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) {
  const torch::Tensor y = next_state_target(batch, online, target, options_.td);
  const torch::Tensor values = online.forward(batch.states);
  const torch::Tensor error = y - of_actions(values, batch.actions);
  const double share = options_.ramp_kappa ? options_.ramp.share(progress) : 1;
  const double kappa = 1 - share * (1 - options_.kappa);
  return {kappa * huber(error, options_.td.huber) + (1 - kappa) * adversarial(batch, values, online, progress),
          error.detach()};
}

}  // namespace maximin::deep
