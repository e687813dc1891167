#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include <maximin/deep/agent_spec.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/loss.hpp>
#include <maximin/deep/pf_rnn.hpp>
#include <maximin/deep/report/training_log.hpp>
#include <maximin/deep/trainer.hpp>

namespace maximin::deep {

/// Networks with what they are: enough to act.
struct TrainedAgent {
  AgentSpec spec;
  QNetworkPtr q;                ///< what was trained
  std::shared_ptr<Loss> loss;   ///< with further networks, if it owns any
  PfRnnPtr particle_filter;     ///< where the belief is one, else empty
  double training_seconds = 0;  ///< of this part of the pipeline
  double belief_seconds = 0;    ///< of the particle filter's training

  /// What it acts by: in units of training rewards, reward_scale times rewards.
  std::shared_ptr<ActionValueModule> values() const { return loss->acting(q); }
  /// What attacks differentiate: the same in rewards, for what a softmax of values does depends on their unit.
  std::shared_ptr<ActionValueModule> values_in_rewards() const {
    return std::make_shared<RescaledValues>(values(), spec.training.reward_scale);
  }
};

/// How to act.
struct Acting {
  std::string belief;
  long belief_states = 32;
  std::string aggregator;
  double random_actions = 0;
  PfBeliefOptions filter_belief;  ///< of a particle filter
  GridworldOptions world;         ///< that an exact belief knows
};
Acting acting_of(const AgentSpec& spec);

/// What to do otherwise than the specification says: ablations take parts of an agent.
struct ActingChange {
  /// Empty: its own. For another belief than its own as many states stand as are Acting's default.
  std::string belief, aggregator;
  double random_actions = -1;  ///< negative: its own
};
Acting acting_of(const AgentSpec& spec, const ActingChange& change);

/// The belief model of that name, of radius eps. Throws InputError where it is a particle filter and there is none.
std::shared_ptr<LaneBelief> make_belief(const Acting& acting, double eps, const PfRnnPtr& particle_filter);

/// An agent out of its parts, for episodes in step.
std::unique_ptr<BeliefAgent> make_agent(const TrainedAgent& trained, const Acting& acting);

/// Tells the agent, as it acts, from others: name, all of how it acts, checksums of all weights.
std::string identity_of(const TrainedAgent& trained, const Acting& acting);

/// Networks before training.
TrainedAgent untrained(const AgentSpec& spec);

/// The agent's file, kind "agent", whose bytes depend on the training alone; how long that took stands beside it, in
/// NAME.times.json. Throws InputError as tensor files do.
void write_agent(const std::filesystem::path& path, const TrainedAgent& agent);
TrainedAgent read_agent(const std::filesystem::path& path);

/// What a trainer needs of the agent, which must outlive it: its network, belief, attack and loss.
TrainingParts training_parts(const TrainedAgent& agent, torch::Device device = torch::kCPU);

/// Its particle filter before training.
PfRnnPtr untrained_filter(const AgentSpec& spec);

/// The particle filter's tensors, where the agent has one; and back, where its specification asks for one. Throws
/// InputError as tensor files do.
void put_particle_filter(TensorFile& file, const TrainedAgent& agent);
void get_particle_filter(const TensorFile& file, TrainedAgent& agent);

/// What is told while an agent is trained. `stretch` returns false to stop.
struct TrainingHooks {
  std::function<void(const std::string& part, long frames)>
      begin;  ///< a part of the pipeline begins, of so many frames
  std::function<bool(const CurvePoint& point)> stretch;
};

/// Columns of the training log, one row per stretch.
std::vector<std::string> training_columns();
std::vector<std::optional<double>> training_row(const CurvePoint& point);

/// Trains the agent in `folder`, where files stand by AgentSpec::name(): NAME.agent when done, NAME.csv the curve,
/// NAME.training the checkpoint of a training under way, which a later call continues bit for bit. What the agent
/// begins with (a vanilla DQN of the same seed, a particle filter) is trained first where it is not there. Returns the
/// agent, from its file where it is there already; nothing where a hook stopped it. `effort` is that of what comes
/// first; the agent's own is in its specification. Throws InputError when a file there is of another specification, and
/// when another run is training the same agent there.
std::optional<TrainedAgent> train_agent(const AgentSpec& spec, const std::filesystem::path& folder,
                                        torch::Device device, const Effort& effort, const TrainingHooks& hooks);

}  // namespace maximin::deep
