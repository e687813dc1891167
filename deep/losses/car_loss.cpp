#include <cmath>
#include <string>

#include <maximin/deep/losses/car_loss.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

CarLoss::CarLoss(const CarLossOptions& options) : options_(options) {
  options_.td.check("CAR loss");
  options_.ramp.check("CAR loss");
  if (!(options_.lambda > 0 && std::isfinite(options_.lambda)))
    throw InputError("CAR loss: lambda " + std::to_string(options_.lambda) + ", expected above 0, e.g. 1");
  if (!(options_.clean_share >= 0 && options_.clean_share <= 1))
    throw InputError("CAR loss: clean_share " + std::to_string(options_.clean_share) + ", expected 0 to 1");
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
