#pragma once

#include <memory>
#include <vector>

#include <torch/torch.h>

#include <maximin/deep/belief_model.hpp>
#include <maximin/deep/q_network.hpp>

namespace maximin::deep {

/// b transitions (s_t, a_t, R_t, s_{t+1}, M_{t+1}) out of the replay memory, all on the network's device.
struct Batch {
  torch::Tensor states;       ///< s_t, [b, state...]
  torch::Tensor actions;      ///< a_t, [b], int64
  torch::Tensor rewards;      ///< R_t, [b]
  torch::Tensor terminal;     ///< 1 where the episode is over, else 0, [b]
  torch::Tensor next_states;  ///< s_{t+1}, [b, state...]
  /// M_{t+1} (M_t where the options of the training say so), [b, K, state...]; anything where the episode is over.
  BeliefStates next_belief;
};

/// Where the training stands: schedules depend on it.
struct Progress {
  double fraction = 0;  ///< of the frames, 0 to 1
};

/// What a loss came to.
struct LossValue {
  torch::Tensor loss;      ///< per sample, [b], to be weighted and averaged
  torch::Tensor td_error;  ///< per sample, [b], detached: what prioritised replay goes by
};

/// What a network is trained to make small. A loss may own further networks (WocaR-DQN's worst-case critic), which are
/// trained and saved with the main one.
class Loss {
 public:
  Loss() = default;
  virtual ~Loss() = default;
  Loss(const Loss&) = delete;
  Loss& operator=(const Loss&) = delete;

  virtual LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) = 0;

  /// Further modules to save and, where they have parameters that need gradients, to train. Empty for most.
  virtual std::vector<std::shared_ptr<torch::nn::Module>> modules() { return {}; }
  /// Called whenever the target network takes over the online network's weights.
  virtual void copy_targets() {}
  /// What the agent acts by: the online network, unless the loss knows better.
  virtual std::shared_ptr<ActionValueModule> acting(QNetworkPtr online) { return online; }
};

}  // namespace maximin::deep
