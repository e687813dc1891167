#pragma once

#include <array>
#include <vector>

#include <maximin/deep/loss.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

/// How transitions are drawn from the replay memory.
struct ReplayOptions {
  long capacity = 200'000;
  bool prioritised = false;  ///< proportional to |TD error|^alpha (Schaul et al. 2016), else uniform
  double alpha = 0.5;
  double beta_start = 0.4;  ///< importance correction, rising to 1 at the end of the training

  /// Throws InputError, naming the field, when one is out of range.
  void check() const;
};

/// A transition as it is stored.
struct Transition {
  Point state;
  Action action = 0;
  double reward = 0;
  Point next;
  bool terminal = false;
};

/// The last `capacity` transitions (s_t, a_t, R_t, s_{t+1}, M_{t+1}) of the Gridworld.
class Replay {
 public:
  /// Beliefs of `belief_states` states each. Throws InputError when an option is out of range or they do not fit.
  Replay(const ReplayOptions& options, long belief_states);

  long size() const { return size_; }

  /// Stores a transition with the belief of row `row`, whose tensors are contiguous floats on the CPU; the belief is
  /// not looked at where the episode is over.
  void add(const Transition& transition, const BeliefStates& next_belief, long row);

  /// What a draw came to: where the transitions stand, for `reprioritise`, and their importance weights, at most 1.
  struct Draw {
    Batch batch;
    torch::Tensor importance;  ///< [b]
    std::vector<long> indices;
  };
  /// b transitions with replacement. `progress` moves beta. The memory must not be empty.
  Draw draw(long b, double progress, Stream& rng, torch::Device device) const;

  /// Takes over |TD error| of drawn transitions as their priority. Does nothing when draws are uniform.
  void reprioritise(const std::vector<long>& indices, const torch::Tensor& td_error);

  /// Everything but the options, as tensors replay.NAME, for a checkpoint, which share their numbers with the memory;
  /// and back. Throws InputError when it does not fit.
  void save(TensorFile& file) const;
  void load(const TensorFile& file);

 private:
  std::array<torch::Tensor, 7> rows() const;
  long pick(double mass) const;
  void set_priority(long index, double priority);

  ReplayOptions options_;
  long size_ = 0, next_ = 0;
  torch::Tensor states_, actions_, rewards_, terminal_, next_states_, beliefs_, belief_weights_;
  long leaves_ = 0;
  std::vector<double> tree_;  // sums of priorities; leaf i at leaves_ + i
  double largest_ = 1;
};

}  // namespace maximin::deep
