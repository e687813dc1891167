#pragma once

#include <memory>
#include <vector>

#include <torch/torch.h>

#include <maximin/deep/q_network.hpp>
#include <maximin/theory/random.hpp>

namespace maximin::deep {

/// Proximal policy optimisation (Schulman, Wolski, Dhariwal, Radford and Klimov 2017, eq. 7 and 9), for choices out of
/// a finite number.
struct PpoOptions {
  double discount = 0.99;
  double trace_decay = 0.95;  ///< lambda of generalised advantage estimation
  double clip = 0.1;          ///< of the ratio of new to old probability
  double learning_rate = 5e-4;
  double final_learning_rate = 5e-5;  ///< reached linearly at the end of the training
  double entropy_bonus = 0.01;
  double value_weight = 0.5;
  double gradient_clip = 0.5;  ///< of the gradient's norm
  int epochs = 4;
  long minibatch = 512;

  /// Throws InputError, naming the field, when one is out of range.
  void check() const;
};

/// What there is to choose by, in n situations.
struct Situations {
  torch::Tensor features;  ///< [n, features]
  /// Logits that are added to the policy's, [n, choices]: what the policy does before it has learned anything.
  torch::Tensor prior;
};

/// A policy and a value function, two networks.
class ActorCritic : public torch::nn::Module {
 public:
  /// Before training the policy is softmax(prior), but for a hundredth.
  ActorCritic(long features, long choices, const std::vector<long>& hidden, Stream& rng);

  /// Log-probabilities of the choices, [n, choices].
  torch::Tensor log_policy(const Situations& situations);
  /// The value of each situation, [n].
  torch::Tensor value(const torch::Tensor& features);

 private:
  QNetworkPtr policy_, value_;
};

/// What was met in T ticks of L lanes, tick by tick: n = T L rows.
struct Experience {
  Situations situations;
  torch::Tensor choices;          ///< [n], int64
  torch::Tensor log_probability;  ///< of the choice when it was made, [n]
  torch::Tensor advantage;        ///< [n]
  torch::Tensor target;           ///< of the value, [n]
};

/// Generalised advantage estimation (Schulman et al. 2016): rewards and `over` (1 where the episode ended with the
/// step) are [T, L], values [T+1, L], the last row those of where the lanes stand in the end. -> [T, L].
torch::Tensor generalised_advantage(const torch::Tensor& rewards, const torch::Tensor& values,
                                    const torch::Tensor& over, double discount, double trace_decay);

/// The learning rule.
class Ppo {
 public:
  Ppo(std::shared_ptr<ActorCritic> network, const PpoOptions& options);

  /// Learns from the experience, which has to come from the policy as it is. Advantages are normalised here.
  /// `fraction` of the training is over.
  void learn(const Experience& experience, double fraction, Stream& rng);

  const PpoOptions& options() const { return options_; }

 private:
  torch::Tensor loss(const Experience& part);

  std::shared_ptr<ActorCritic> network_;
  PpoOptions options_;
  torch::optim::Adam optimiser_;
};

}  // namespace maximin::deep
