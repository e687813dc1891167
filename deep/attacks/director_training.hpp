#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include <maximin/deep/attacks/director.hpp>
#include <maximin/gridworld/gridworld.hpp>

namespace maximin::deep {

struct DirectorTraining {
  std::uint64_t seed = 1;
  long frames = 600'000;  ///< steps of one environment
  Lane lanes = 128;       ///< environments in step
  long ticks = 32;        ///< steps of every lane between two rounds of learning
  long horizon = ContinuousGridworld::horizon;
  /// What the director is paid for each unit of reward that the agent does not get. Negative: an ally.
  double pay = 0.02;
  long stretch_frames = 50'000;  ///< between evaluations; each begins with new episodes
  long evaluation_episodes = 128;
  PpoOptions ppo;

  /// Throws InputError, naming the field, when one is out of range.
  void check() const;
};

/// How a director plays, at some point of its training.
struct DirectorPoint {
  long frames = 0;             ///< so far
  double training_return = 0;  ///< the agent's mean return in this stretch; NaN where no episode ended
  double sampled_return = 0;   ///< the agent's mean return in the evaluation, by the policy
  double greedy_return = 0;    ///< by its most probable choices
};

/// Is told each point as it comes; false stops the training.
using DirectorCallback = std::function<bool(const DirectorPoint&)>;

/// Teaches the director to harm the agent, which does not learn: its reward is minus the agent's. Of all evaluations,
/// the first before any learning, it keeps the policy, and the way to play, of the one in which the agent did worst;
/// all are of the same episodes, which no training sees. Bit for bit the same for the same seed. Returns the points.
std::vector<DirectorPoint> train_director(Director& director, GridAgent& agent, const ContinuousGridworld& world,
                                          const DirectorTraining& options, const DirectorCallback& callback = {});

}  // namespace maximin::deep
