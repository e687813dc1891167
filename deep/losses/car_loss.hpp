#pragma once

#include <maximin/deep/losses/perturbation_ramp.hpp>
#include <maximin/deep/losses/td_error.hpp>

namespace maximin::deep {

/// What the weights of the soft maximum over the batch are made of.
enum class CarWeights {
  absolute_error,  ///< the worst-case error e itself, as the paper's objective has it
  huber,           ///< its Huber loss, as released
};

struct CarLossOptions {
  TdOptions td{};  ///< Double DQN, as published
  PerturbationRamp ramp{};
  /// Temperature of the soft maximum over the batch, in units of Q: towards 0 the largest error alone counts, towards
  /// infinity it is the mean.
  double lambda = 1;
  CarWeights weights = CarWeights::absolute_error;
  BoundMethod bounds = BoundMethod::ibp;
  /// Share of the plain temporal difference that is mixed in (an option of the released code); the paper has none.
  double clean_share = 0;

  /// Throws InputError, naming the option, when one is out of range.
  void check() const;
};

/// CAR-DQN (Li et al. 2024): the largest Bellman error that any state of the ball leaves, softly maximised over the
/// batch,
///
///     sum_i w_i Huber(e_i),  e_i = max(|y_i - upper(a_i)|, |y_i - lower(a_i)|),  w = softmax(e / lambda),
///
/// bounds over B(s_i), w without gradient. What is returned per sample is b w_i Huber(e_i), so that its mean is that
/// sum; the weights therefore depend on the whole batch, and importance weights of a replay memory multiply them.
class CarLoss final : public Loss {
 public:
  /// Throws InputError, naming the option, when one is out of range.
  explicit CarLoss(const CarLossOptions& options);
  LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) override;

 private:
  CarLossOptions options_;
};

}  // namespace maximin::deep
