#include <cmath>
#include <string>

#include <maximin/deep/losses/car_loss.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

void CarLossOptions::check() const {
  const RangeCheck require("CAR loss");
  td.check(require);
  ramp.check(require);
  require(lambda > 0 && std::isfinite(lambda), "lambda", lambda, "above 0, e.g. 1");
  require(clean_share >= 0 && clean_share <= 1, "clean_share", clean_share, "0 to 1");
}

CarLoss::CarLoss(const CarLossOptions& options) : options_(options) {
  options_.check();
}

LossValue CarLoss::operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) {
  const torch::Tensor y = next_state_target(batch, online, target, options_.td);
  const torch::Tensor error = y - of_actions(online.forward(batch.states), batch.actions);

  const OutputBounds q = output_bounds(online, options_.ramp.ball(batch.states, progress), options_.bounds);
  const torch::Tensor worst =
      torch::maximum((y - of_actions(q.upper, batch.actions)).abs(), (y - of_actions(q.lower, batch.actions)).abs());
  const torch::Tensor robust = huber(worst, options_.td.huber);
  const torch::Tensor scores = options_.weights == CarWeights::huber ? robust : worst;
  const torch::Tensor weights = torch::softmax(scores.detach() / options_.lambda, 0);
  torch::Tensor loss = static_cast<double>(worst.size(0)) * weights * robust;
  if (options_.clean_share > 0)
    loss = (1 - options_.clean_share) * loss + options_.clean_share * huber(error, options_.td.huber);
  return {loss, error.detach()};
}

}  // namespace maximin::deep
