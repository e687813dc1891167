#pragma once

#include <maximin/deep/losses/perturbation_ramp.hpp>
#include <maximin/deep/losses/td_error.hpp>

namespace maximin::deep {

/// How the overlap of the ranges of two action values is bounded.
enum class RadialOverlap {
  separate_bounds,    ///< upper(a) - lower(taken), as published
  merged_difference,  ///< a bound of Q(x,a) - Q(x,taken), never wider
};

struct RadialLossOptions {
  TdOptions td{};
  PerturbationRamp ramp{};
  double kappa = 0.8;       ///< share of the temporal difference in the loss, at the full radius
  bool ramp_kappa = false;  ///< the share falls from 1 to kappa as the radius grows (first released code); paper: fixed
  BoundMethod bounds = BoundMethod::ibp;
  RadialOverlap overlap = RadialOverlap::separate_bounds;

  /// Throws InputError, naming the option, when one is out of range.
  void check() const;
};

/// Radial-DQN (Oikarinen et al. 2021, section 4.1): kappa TD + (1 - kappa) L_adv with
///
///     L_adv = sum_a d_a max(0, upper(a) - lower(taken) + d_a/2),  d_a = max(0, Q(s,taken) - Q(s,a)),
///
/// bounds over B(s), d without gradient: the ranges of a worse action and of the taken one must not overlap, and must
/// leave half of the clean distance between them. L_adv goes with the square of the scale of Q, TD (in its linear part)
/// with the scale.
class RadialLoss final : public Loss {
 public:
  /// Throws InputError, naming the option, when one is out of range.
  explicit RadialLoss(const RadialLossOptions& options);
  LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) override;

  /// L_adv, [b], given Q(s, .) of the batch, [b, actions].
  torch::Tensor adversarial(const Batch& batch, const torch::Tensor& values, const QNetwork& online,
                            const Progress& progress) const;

 private:
  RadialLossOptions options_;
};

}  // namespace maximin::deep
