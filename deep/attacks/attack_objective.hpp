#pragma once

#include <torch/torch.h>

namespace maximin::deep {

/// What an attack on a network makes small, as a function of the shown state t when s is true; Q is the network.
enum class AttackObjective {
  value,  ///< the value of the action it provokes, Q(s, pi(t)), by way of sum_a softmax(Q(t))_a Q(s,a) (the paper's
          ///< PGD)
  cross_entropy,  ///< the log-probability of the greedy action of s, hard labels (PGD of the authors' released code)
  min_best,       ///< the softmax probability of the best action of s (the paper's MinBest)
};

/// What is known of a batch of true states: Q there, [n, actions], and its greedy actions, [n, 1].
struct AttackedStates {
  torch::Tensor q, best;
};

/// What is differentiated, from Q at what is shown, [n, actions]: -> [n].
torch::Tensor smooth_objective(AttackObjective objective, const torch::Tensor& q_shown, const AttackedStates& truths);
/// What places are compared by: the value objective by the action really provoked, the others as above: -> [n].
torch::Tensor hard_objective(AttackObjective objective, const torch::Tensor& q_shown, const AttackedStates& truths);

}  // namespace maximin::deep
