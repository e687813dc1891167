#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/attacks/ppo.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// What all learned attacks have in common.
struct DirectorOptions {
  std::uint64_t seed = 1;  ///< of the network's first weights
  std::vector<long> hidden{64, 64};
  long waves = 2;                               ///< sines and cosines of the true place beside it, see QNetworkShape
  long horizon = ContinuousGridworld::horizon;  ///< of the episodes: the director knows how much time is left
};

/// An attack that is learned: at every step a policy, the director, chooses one of a few things to do, and the attack
/// does it. `train_director` teaches it.
class Director : public GridAttack {
 public:
  /// How it chooses.
  enum class Play { sampled, greedy };

  /// What was chosen in the last `perturb`, in its order of lanes.
  struct Decision {
    Situations situations;
    torch::Tensor choices;          ///< [n], int64
    torch::Tensor log_probability;  ///< [n]
    torch::Tensor value;            ///< [n]
  };

  void resize(Lane lanes) override { steps_.assign(static_cast<std::size_t>(lanes), 0); }
  void forget(Lane lane) override { steps_[static_cast<std::size_t>(lane)] = 0; }
  /// Takes one number of a lane's stream where play is sampled, and what doing it takes.
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) final;

  /// What it sees there now.
  virtual Situations look(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent) const = 0;

  const Decision& decision() const { return decision_; }
  const std::shared_ptr<ActorCritic>& network() const { return network_; }
  Play play() const { return play_; }
  void set_play(Play play) { play_ = play; }

  /// What it is, to the last option: a file is of this director exactly if it says the same.
  virtual nlohmann::ordered_json about() const;
  /// Kind "attacker". `load` throws InputError when the file is of another director.
  TensorFile save() const;
  void load(const TensorFile& file);

  const ObservationBall& ball() const { return ball_; }

 protected:
  Director(const ObservationBall& ball, const DirectorOptions& options, long further_features, long choices);

  /// Shows what was chosen.
  virtual void realise(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> choices,
                       std::span<Stream> streams, std::span<Point> shown) = 0;

  /// The features that every director has, of one lane: its true place and the time left. `out` has room for them;
  /// returns what is behind them.
  float* write_place(Lane lane, Point truth, float* out) const;
  /// Zeros, one row for each lane.
  torch::Tensor blank_features(std::size_t lanes) const;
  long choices() const { return choices_; }

 private:
  std::vector<int> choose(const torch::Tensor& log_policy, std::span<const Lane> lanes,
                          std::span<Stream> streams) const;

  ObservationBall ball_;
  DirectorOptions options_;
  long features_, choices_;
  std::shared_ptr<ActorCritic> network_;
  Play play_ = Play::sampled;
  Decision decision_;
  std::vector<long> steps_;  ///< of each lane's episode
};

}  // namespace maximin::deep
