#pragma once

#include <torch/torch.h>

#include <maximin/deep/loss.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/deep/range_check.hpp>

/// Temporal differences with the next state itself in the place of a belief: what the robust baselines add to.
namespace maximin::deep {

struct TdOptions {
  double discount = 0.99;
  /// The online network chooses the next action and the target network values it (van Hasselt et al. 2016); else the
  /// target network does both.
  bool double_q = true;
  double huber = 1;  ///< where the squared loss becomes linear

  /// Throws InputError when one is out of range.
  void check(const RangeCheck& require) const;
};

/// y = R + discount (1 - terminal) Q'(s', a*), [b], without gradient.
torch::Tensor next_state_target(const Batch& batch, ActionValueModule& online, ActionValueModule& target,
                                const TdOptions& options);

/// R + discount (1 - terminal) next, [b]: a target, given what the next state is worth.
torch::Tensor bootstrapped(const Batch& batch, double discount, const torch::Tensor& next);

/// Column `actions` ([b], int64) of values [b, actions], [b].
torch::Tensor of_actions(const torch::Tensor& values, const torch::Tensor& actions);

/// The Huber loss of each error: e^2/2 up to `delta`, then linear with slope delta.
torch::Tensor huber(const torch::Tensor& errors, double delta);

}  // namespace maximin::deep
