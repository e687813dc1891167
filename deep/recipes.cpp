#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/deep/agent_spec.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// What all have in common: the vanilla DQN of the Gridworld.
AgentSpec vanilla(std::uint64_t seed) {
  AgentSpec s;
  s.kind = "dqn";
  s.network.waves = 2;
  s.training.seed = seed;
  s.training.frames = 1'000'000;
  s.training.learning_rate = 2e-3;
  s.training.final_learning_rate = 1e-4;
  s.training.target_every = 1000;
  s.training.explore_frames = 400'000;
  return s;
}

/// The robust part of a training that begins with a vanilla DQN.
void continue_from_vanilla(AgentSpec& s) {
  s.start_from = "dqn";
  s.training.frames = 500'000;
  s.training.learning_rate = 1e-3;
  s.training.explore_start = 0.1;
  s.training.explore_end = 0.03;
  s.training.explore_frames = 100'000;
}

AgentSpec belief_pessimistic(std::uint64_t seed, const char* belief) {
  AgentSpec s = vanilla(seed);
  continue_from_vanilla(s);
  s.belief = belief;
  s.belief_states = 32;
  s.training_belief_states = 8;
  // These three were chosen beforehand on other seeds, results/README.md; the random actions are a way out of loops.
  s.aggregator = "mean";
  s.random_actions = 0.02;
  s.training.averaged_share = 0.3;
  s.double_q = false;
  s.train_attack = "mixed";
  return s;
}

/// CROWN's bounds take ten times as long as the temporal difference alone: fewer updates.
AgentSpec robust_baseline(std::uint64_t seed, const char* loss) {
  AgentSpec s = vanilla(seed);
  continue_from_vanilla(s);
  s.training.frames = 200'000;
  s.training.frames_per_update = 8;
  s.loss = loss;
  return s;
}

/// The paper's belief and aggregator, and nothing that it does not have.
AgentSpec with_minimum(std::uint64_t seed) {
  AgentSpec s = belief_pessimistic(seed, "pf-lstm");
  s.aggregator = "min";
  s.random_actions = 0;
  s.training.averaged_share = 0;
  s.train_attack = "pgd";
  return s;
}

/// The same with what the authors' code for the Gridworld does otherwise than the paper says.
AgentSpec released(std::uint64_t seed) {
  AgentSpec s = with_minimum(seed);
  s.target_order = TargetOrder::aggregate_of_max;
  s.particle_filter = PfRnnOptions::published(s.eps);
  s.particle_filter_training = PfTrainingOptions::published();
  s.belief_trajectories = 10'000;
  s.particle_filter_belief = PfBeliefOptions::released();
  s.training.bootstrap = BootstrapBelief::current;
  s.train_attack = "pgd-released";
  s.start_anywhere = true;
  return s;
}

AgentSpec learned_in_noise(std::uint64_t seed) {
  AgentSpec s = belief_pessimistic(seed, "pf-lstm");
  s.belief_trajectories = 30;
  s.start_from.clear();
  s.training = vanilla(seed).training;
  s.train_attack = "pgd";
  s.training.learn_from_belief = true;
  return s;
}

struct Recipe {
  std::string_view kind;
  const char* what;  ///< for a list of them
  AgentSpec (*make)(std::uint64_t seed);
};

constexpr Recipe recipes[] = {
    {"dqn", "vanilla double DQN, with which all others begin", vanilla},
    {"sa-dqn", "SA-DQN", [](std::uint64_t seed) { return robust_baseline(seed, "sa"); }},
    {"wocar-dqn", "WocaR-DQN", [](std::uint64_t seed) { return robust_baseline(seed, "wocar"); }},
    {"radial-dqn", "Radial-DQN", [](std::uint64_t seed) { return robust_baseline(seed, "radial"); }},
    {"car-dqn", "CAR-DQN", [](std::uint64_t seed) { return robust_baseline(seed, "car"); }},
    {"bp-dqn", "BP-DQN on the exact belief, which knows the world, by the mean of it",
     [](std::uint64_t seed) { return belief_pessimistic(seed, "exact"); }},
    {"bp-dqn-lstm", "the same on a learned belief, a PF-LSTM",
     [](std::uint64_t seed) { return belief_pessimistic(seed, "pf-lstm"); }},
    {"bp-dqn-gru", "the same on a PF-GRU", [](std::uint64_t seed) { return belief_pessimistic(seed, "pf-gru"); }},
    {"bp-dqn-printed", "the paper's: PF-LSTM, and the minimum over its particles", with_minimum},
    {"bp-dqn-released", "that with what the authors' code does otherwise than the paper says", released},
    {"bp-dqn-noisy", "the appendix's, which learns in noise from what it believes", learned_in_noise}};

/// A vanilla DQN and BP-DQN on the exact belief find the gold in a fifth of their training. What has bounds or a
/// particle filter would take longer, and does less.
double quick_share(const AgentSpec& s) {
  return s.loss == "td" && !s.has_particle_filter() ? 0.2 : 0.06;
}

/// A training of so many frames in all, in stretches that are short in comparison, yet where there is time of whole
/// episodes: a stretch begins with new ones, and returns are told of those that end.
void shorten(TrainOptions& o, long frames) {
  const double share = static_cast<double>(frames) / static_cast<double>(o.frames);
  o.frames = frames;
  o.explore_frames = std::lround(static_cast<double>(o.explore_frames) * share);
  const long whole_episodes = o.lanes * o.horizon, least = frames < whole_episodes ? o.lanes : whole_episodes;
  o.stretch_frames = std::clamp(frames / 12, least, o.stretch_frames);
  o.warm_up = std::min(o.warm_up, frames / 60);
}

}  // namespace

const std::vector<std::string>& agent_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> names;
    for (const Recipe& r : recipes) names.emplace_back(r.kind);
    return names;
  }();
  return kinds;
}

std::string what_is(std::string_view kind) {
  for (const Recipe& r : recipes) {
    if (r.kind == kind) return r.what;
  }
  return "";
}

AgentSpec recipe(std::string_view kind, double eps, std::uint64_t seed, const Effort& effort) {
  const auto* const found =
      std::find_if(std::begin(recipes), std::end(recipes), [&](const Recipe& r) { return r.kind == kind; });
  if (found == std::end(recipes)) {
    throw InputError(fmt::format("agent: {}, expected {}", kind, nearest_or_all(kind, agent_kinds())));
  }
  AgentSpec s = found->make(seed);
  s.kind = kind;
  // The same vanilla agent, whatever it will be attacked with.
  if (s.knows_eps()) s.eps = eps + 0.0;  // -0 is 0
  if (effort.quick) {
    shorten(s.training, static_cast<long>(static_cast<double>(s.training.frames) * quick_share(s)));
    s.particle_filter_training.updates = 200;
  }
  if (effort.frames > 0) shorten(s.training, effort.frames);
  return s;
}

std::optional<AgentSpec> beginning_of(const AgentSpec& spec, const Effort& effort) {
  if (spec.start_from.empty()) return std::nullopt;
  AgentSpec first = recipe(spec.start_from, spec.eps, spec.training.seed, effort);
  first.network = spec.network;
  first.training.reward_scale = spec.training.reward_scale;
  bool comes_back = first.name() == spec.name();
  for (AgentSpec s = first; !comes_back && !s.start_from.empty();) {
    s = recipe(s.start_from, spec.eps, spec.training.seed, effort);
    comes_back = s.name() == spec.name();
  }
  if (!comes_back) return first;
  throw InputError(fmt::format("start_from: {}, expected an agent that is not called {} too, or another kind",
                               spec.start_from, spec.name()));
}

bool same_training(const AgentSpec& a, const AgentSpec& b) {
  AgentSpec other = b;
  if (!a.knows_eps() && !b.knows_eps()) other.eps = a.eps;
  return to_json(a) == to_json(other);
}

}  // namespace maximin::deep
