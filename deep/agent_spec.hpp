#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/deep/losses/car_loss.hpp>
#include <maximin/deep/losses/radial_loss.hpp>
#include <maximin/deep/losses/sa_loss.hpp>
#include <maximin/deep/losses/td_loss.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/deep/pf_rnn.hpp>
#include <maximin/deep/pf_rnn_belief.hpp>
#include <maximin/deep/pf_rnn_training.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/deep/trainer.hpp>

namespace maximin::deep {

/// Everything that makes an agent: what it believes, what it is trained on, for how long. The same specification with
/// the same seed is the same agent. A field's name here is its name in configuration files.
struct AgentSpec {
  std::string kind = "dqn";  ///< for people and for tables
  double eps = 0.1;          ///< radius of the ball that it is trained to withstand and believes in
  QNetworkShape network;
  std::string loss = "td";  ///< td, sa, wocar, radial, car; "loss_options" in files are those of it:
  /// As in their papers but for some things. Radial-DQN, CAR-DQN and WocaR-DQN have CROWN's bounds. Radial-DQN's
  /// overlap is of merged bounds of differences. WocaR-DQN has the released robust term and ramp, and its critic a
  /// floor, the discounted cost of never arriving: -100 rewards at a reward_scale of 0.02. Losses see scaled rewards:
  /// so are kappa, lambda and the margin to be read.
  SaLossOptions sa;
  RadialLossOptions radial{.bounds = BoundMethod::crown, .overlap = RadialOverlap::merged_difference};
  CarLossOptions car{.bounds = BoundMethod::crown};
  WocarLossOptions wocar{.reach_bounds = BoundMethod::crown, .robust_bounds = BoundMethod::crown, .critic_floor = -2};
  std::string belief = "observed";  ///< observed; or ball, exact, pf-lstm, pf-gru, and X-mean, the mean of X alone
  long belief_trajectories = 0;     ///< of clean play, all that a particle filter is taught; 0: as many as it takes
  PfRnnOptions particle_filter;     ///< in files where the belief is one; but for its cell, radius and seed, which
  PfTrainingOptions particle_filter_training;  ///< follow from the other fields
  PfBeliefOptions particle_filter_belief;
  long belief_states = 1;           ///< K of set beliefs when acting
  long training_belief_states = 1;  ///< and in the replay memory
  std::string aggregator = "mean";  ///< min, mean, soft-min:BETA, cvar:ALPHA
  bool double_q = true;
  TargetOrder target_order = TargetOrder::max_of_aggregate;
  double discount = 0.99;
  std::string train_attack = "none";  ///< none, random, pgd, pgd-released, min-best, mixed
  bool start_anywhere = false;        ///< episodes begin in gold and bomb too, as in the released code; written if so
  std::string start_from;             ///< kind of agent whose weights the training begins with; empty: none
  double random_actions = 0;          ///< share of random actions after training
  TrainOptions training;

  /// The agent's name in files: "bp-dqn-eps0.5-seed1"; without eps where none was trained for.
  std::string name() const;
  /// Whether its belief is a particle filter, which is trained before it.
  bool has_particle_filter() const { return belief.starts_with("pf-"); }
  /// Whether eps has a part in it.
  bool knows_eps() const { return belief != "observed" || loss != "td" || train_attack != "none"; }
};

/// The world that it is trained in, and evaluated.
inline GridworldOptions world_of(const AgentSpec& spec) {
  GridworldOptions world;
  world.start_anywhere = spec.start_anywhere;
  return world;
}

/// The options of a loss, one of the specification's, with what follows from its other fields.
template <class Options>
Options options_of_loss(const AgentSpec& spec, Options options) {
  options.td.discount = spec.discount;
  options.td.double_q = spec.double_q;
  options.ramp.eps = spec.eps;
  return options;
}

/// The particle filter's shape and training, in the same way.
PfRnnOptions shape_of_filter(const AgentSpec& spec);
PfTrainingOptions training_of_filter(const AgentSpec& spec);

/// Names of beliefs.
const std::vector<std::string>& belief_names();

/// Kinds that `recipe` knows.
const std::vector<std::string>& agent_kinds();
/// In a few words what an agent of this kind is; empty where there is no such kind.
std::string what_is(std::string_view kind);

/// How much of a recipe's training to do. Where a flag is enough, `true` is the quick one.
struct Effort {
  bool quick = false;  ///< a training of seconds, that shows that everything works and no more
  long frames = 0;     ///< so many frames of each training, and exploration in proportion; 0: what the recipe says

  Effort(bool in_small = false, long so_many_frames = 0) : quick(in_small), frames(so_many_frames) {}
};

/// How the project trains an agent of this kind, eps and training seed. Throws InputError on a kind that it does not
/// know, naming the nearest.
AgentSpec recipe(std::string_view kind, double eps, std::uint64_t seed, const Effort& effort = {});

/// What the agent's training begins with and what is trained before it: the recipe of `start_from`, with the agent's
/// own network and scale of rewards. Empty where it begins with nothing. Throws InputError where that would be called
/// as the agent itself.
std::optional<AgentSpec> beginning_of(const AgentSpec& spec, const Effort& effort = {});

/// Training seed of the vanilla agent by whose values attacks on the whole defence go: none that a training of `seed`
/// began with or was attacked by.
inline std::uint64_t judge_seed(std::uint64_t seed) {
  return 1'000'000 + seed;
}

/// Whether the two are trained in the same way: all is the same but perhaps a radius that has no part in it.
bool same_training(const AgentSpec& a, const AgentSpec& b);

/// Every field, in order.
nlohmann::ordered_json to_json(const AgentSpec& spec);
/// Takes over the fields that `json` names and leaves the others as they are. Throws InputError, "WHERE: FIELD: what is
/// wrong, expected ...", on a field that there is none of, or of another type, or out of range.
void merge_json(AgentSpec& spec, const nlohmann::ordered_json& json, const std::string& where);

}  // namespace maximin::deep
