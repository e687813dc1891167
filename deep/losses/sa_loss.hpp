#pragma once

#include <optional>

#include <maximin/deep/losses/perturbation_ramp.hpp>
#include <maximin/deep/losses/td_error.hpp>

namespace maximin::deep {

struct SaLossOptions {
  TdOptions td{};
  PerturbationRamp ramp{};
  double kappa = 0.005;  ///< weight of the regulariser
  double margin = 1;     ///< c: no reward for a lead of the greedy action by more than this, in units of Q
  /// Bounds of the differences. Unset: beta CROWN-IBP + (1 - beta) IBP with beta = 1 - eps/eps_max, as in CROWN-IBP
  /// training, which begins with the narrow bounds and ends with those that train best.
  std::optional<BoundMethod> bounds{};

  /// Throws InputError, naming the option, when one is out of range.
  void check() const;
};

/// SA-DQN (Zhang et al. 2020, section 3.4): the Huber loss of the temporal difference plus
///
///     kappa max(-c, max_{a != a*} max_{x in B(s)} Q(x,a) - Q(x,a*)),  a* = argmax_a Q(s,a),
///
/// with an upper bound in the place of the inner maximum. It is -kappa c, and without gradient, as soon as a* provably
/// leads by c in the whole ball, and below 0 only where a* provably stays the greedy action.
class SaLoss final : public Loss {
 public:
  /// Throws InputError, naming the option, when one is out of range.
  explicit SaLoss(const SaLossOptions& options);
  LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) override;

  /// max(-c, bound of the lead that another action can take over the greedy one in the ball), [b]: the regulariser
  /// before its weight. Needs at least two actions.
  torch::Tensor hinge(const torch::Tensor& states, QNetwork& online, const Progress& progress) const;

 private:
  SaLossOptions options_;
};

/// The most by which any action can lead a given one in the ball, from `difference_upper_bounds`: the maximum over all
/// actions but the reference, [b].
torch::Tensor greatest_lead(const torch::Tensor& difference_bounds, const torch::Tensor& reference);

}  // namespace maximin::deep
