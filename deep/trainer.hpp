#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/loss.hpp>
#include <maximin/deep/plane_world.hpp>
#include <maximin/deep/replay.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/gridworld/gridworld.hpp>

namespace maximin::deep {

/// Which belief the target of s_{t+1} is taken over.
enum class BootstrapBelief {
  next,     ///< M_{t+1}: what is believed when s_{t+1} is true
  current,  ///< M_t, as Algorithm 4 prints it and the released code has it
};

/// How a network is trained. Frames are steps of one environment; a tick is one step of every lane.
struct TrainOptions {
  std::uint64_t seed = 1;
  long frames = 1'000'000;
  Lane lanes = 64;  ///< environments in step
  long horizon = ContinuousGridworld::horizon;
  bool truncation_is_terminal = false;  ///< count the horizon as the end of the world, as the paper's runs did
  long frames_per_update = 4;
  long batch = 64;
  double learning_rate = 1e-3;
  double final_learning_rate = 1e-4;  ///< reached linearly at the last frame
  double adam_eps = 1.5e-4;
  double gradient_clip = 10;  ///< of the gradient's norm
  long warm_up = 5000;        ///< frames before the first update
  double explore_start = 1, explore_end = 0.05;
  long explore_frames = 200'000;  ///< over which the share of random actions falls linearly
  long target_every = 2000;       ///< frames between hard copies to the target network
  /// Share of the frames, at the end, over which what is copied to the target is averaged too: in the end the network
  /// has the average of these weights (Izmailov et al. 2018), which forgets the noise of single updates; what a loss
  /// has besides, as WocaR's critic, stays as it is. 0: none.
  double averaged_share = 0;
  double reward_scale = 0.02;    ///< networks see rewards times this
  long stretch_frames = 20'000;  ///< see Trainer::stretch
  BootstrapBelief bootstrap = BootstrapBelief::next;
  /// The noisy environment of the paper's appendix: the learner never sees a true state; the mean of the belief is
  /// stored in its place.
  bool learn_from_belief = false;
  ReplayOptions replay;

  /// Throws InputError, naming the field, when one is out of range.
  void check() const;
};

/// Whom to train, and against what. Attack and loss may hold the network too.
struct TrainingParts {
  QNetworkPtr online;
  std::shared_ptr<LaneBelief> belief;
  AnyAggregator aggregator = MinAggregator{};
  std::shared_ptr<GridAttack> attack;
  std::shared_ptr<Loss> loss;
  std::shared_ptr<const PlaneWorld> world = std::make_shared<GridworldPlane>();
  torch::Device device = torch::kCPU;
};

/// What one stretch of training came to: a point of the training curve.
struct CurvePoint {
  long frames = 0;         ///< so far
  long updates = 0;        ///< so far
  long episodes = 0;       ///< that ended in this stretch
  double mean_return = 0;  ///< of those, under attack and exploration, in rewards; NaN if none ended
  double loss = 0;         ///< mean over the stretch's updates; NaN before the first
  double exploration = 0;  ///< share of random actions at its end
  double believed = 0;     ///< share of steps in which the belief held the truth
  double belief_size = 0;  ///< mean size of a belief, see LaneBelief::size
};

/// Trains one network. Work goes in stretches: every stretch begins with new episodes and random streams that depend on
/// its number alone, so that a checkpoint between stretches needs no episode in progress, and a training that is saved,
/// killed and resumed goes on bit for bit like one that was not (with the same LibTorch on the same kind of processor).
class Trainer {
 public:
  Trainer(const TrainOptions& options, TrainingParts parts);

  long frames() const { return frames_; }
  bool done() const { return frames_ >= options_.frames; }
  /// Plays and learns for the next stretch, of `stretch_frames` or what is left, in whole ticks. Throws InputError when
  /// the loss is no number any more.
  CurvePoint stretch();

  const TrainOptions& options() const { return options_; }
  BeliefAgent& agent() { return *agent_; }
  QNetworkPtr online() const { return parts_.online; }

  /// Networks, optimiser, replay memory and counters, which share their numbers with the trainer: write them before it
  /// goes on. And back, into a trainer of the same options; `load` throws InputError when the file is of another
  /// training.
  void save(TensorFile& file) const;
  void load(const TensorFile& file);

 private:
  struct Pending {
    Transition transition;
    bool waiting = false;    // for the next belief
    bool truncated = false;  // after which the lane begins anew
  };

  void begin_lanes();
  void begin_episode(std::size_t lane);
  void look(std::span<const Lane> lanes);
  void hold(std::span<const Lane> lanes);
  void settle(std::span<const Lane> lanes);
  void move(CurvePoint& point);
  void learn(CurvePoint& point, long& updates);
  void copy_to_target();
  Point learner_state(long row, Point truth) const;
  double exploration() const;

  TrainOptions options_;
  TrainingParts parts_;
  QNetworkPtr target_;
  QNetworkPtr average_;  // of `averaged_` networks
  std::unique_ptr<BeliefAgent> agent_;
  Replay replay_;
  std::unique_ptr<torch::optim::Adam> optimiser_;
  long frames_ = 0, updates_ = 0, stretches_ = 0;
  long averaged_ = 0;
  long copied_at_ = 0;  // frames at the last copy to the target network
  double owed_ = 0;     // updates that are due

  std::vector<Lane> all_lanes_;
  std::vector<Stream> streams_;
  Stream draws_{0};
  std::vector<Point> truths_, learner_states_;
  std::vector<Action> actions_;
  BeliefStates held_;  // M_t of every lane
  std::vector<Pending> pending_;
  std::vector<Episode> episodes_;
};

}  // namespace maximin::deep
