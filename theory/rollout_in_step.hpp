#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/concepts.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/rollout.hpp>

/// Many episodes in step: what costs little for one costs less for 64 at once, when a network looks at all of them. The
/// concepts of concepts.hpp, for whoever acts in many episodes; EachLane makes one of the one-episode kind into one of
/// these.
namespace maximin {

/// One of the episodes that run in step: 0 <= lane < lanes.
using Lane = int;

/// Acts in many episodes. `resize(n)` makes lanes 0 to n-1, all before their first observation; `forget(lane)` puts one
/// back there; `act` takes what is shown in some lanes, each at most once, and chooses an action for each. streams[l]
/// is the source of randomness of lane l.
template <class A>
concept AgentInStep = requires(A& agent, Lane lane, std::span<const Lane> lanes,
                               std::span<const typename A::ObservationType> shown, std::span<Stream> streams,
                               std::span<typename A::ActionType> actions) {
  agent.resize(lane);
  agent.forget(lane);
  agent.act(lanes, shown, streams, actions);
};

/// Perturbs what the agent sees in many episodes. It may look at the agent, memory and all.
template <class K, class StateT, class AgentT>
concept AttackInStep = requires(K& attack, Lane lane, std::span<const Lane> lanes, std::span<const StateT> truths,
                                const AgentT& agent, std::span<Stream> streams,
                                std::span<typename AgentT::ObservationType> shown) {
  attack.resize(lane);
  attack.forget(lane);
  attack.perturb(lanes, truths, agent, streams, shown);
};

/// One agent for one episode, copied into each lane.
template <Agent AgentT>
class EachLane {
 public:
  using ObservationType = typename AgentT::ObservationType;
  using ActionType = typename AgentT::ActionType;

  explicit EachLane(AgentT agent) : original_(std::move(agent)) {}

  void resize(Lane n) {
    agents_.assign(static_cast<std::size_t>(n), original_);
    started_.assign(static_cast<std::size_t>(n), false);
    for (Lane lane = 0; lane < n; ++lane) forget(lane);
  }
  void forget(Lane lane) {
    started_[static_cast<std::size_t>(lane)] = false;
    if constexpr (requires { original_.forget(); }) agents_[static_cast<std::size_t>(lane)].forget();
  }
  void act(std::span<const Lane> lanes, std::span<const ObservationType> shown, std::span<Stream> streams,
           std::span<ActionType> actions) {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const auto l = static_cast<std::size_t>(lanes[k]);
      actions[k] = started_[l] ? agents_[l].act(shown[k], streams[l]) : agents_[l].begin(shown[k], streams[l]);
      started_[l] = true;
    }
  }

  /// The agent that acts in the lane.
  const AgentT& lane(Lane lane) const { return agents_[static_cast<std::size_t>(lane)]; }

 private:
  AgentT original_;
  std::vector<AgentT> agents_;
  std::vector<bool> started_;
};

/// One attack on one episode, copied into each lane. The agent must be EachLane, or have such a `lane`.
template <class AttackT>
class EachLaneAttack {
 public:
  explicit EachLaneAttack(AttackT attack) : original_(std::move(attack)) {}

  void resize(Lane n) { attacks_.assign(static_cast<std::size_t>(n), original_); }
  void forget(Lane lane) {
    if constexpr (requires { original_.forget(); }) attacks_[static_cast<std::size_t>(lane)].forget();
  }
  template <class StateT, class AgentT>
  void perturb(std::span<const Lane> lanes, std::span<const StateT> truths, const AgentT& agent,
               std::span<Stream> streams, std::span<typename AgentT::ObservationType> shown) {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const auto l = static_cast<std::size_t>(lanes[k]);
      shown[k] = attacks_[l].perturb(truths[k], agent.lane(lanes[k]), streams[l]);
    }
  }

 private:
  AttackT original_;
  std::vector<AttackT> attacks_;
};

/// How much to play.
struct EpisodesInStep {
  double discount = 1;  ///< gamma of `discounted_return`
  long horizon = 100;   ///< steps after which an episode is cut
  long episodes = 100;
  std::uint64_t seed = 1;  ///< episode k draws from Stream(seed, k)
  Lane lanes = 64;         ///< how many run at once
  long first = 0;          ///< number of the first episode
};

/// Plays the episodes, as many in step as there are lanes; a lane whose episode is over takes the next one. Returns
/// them in order of their numbers, from `first` on. Episode k is what `rollout` plays with Stream(seed, k), whatever
/// the lanes, as far as the agent's and the attack's answers do not depend on who is asked with them (a network's may,
/// in the last digit). `observe(k, record)` is called after every step of episode k. Throws InputError when there is
/// less than one lane.
template <Environment Env, AgentInStep AgentT, class AttackT, class Observer>
requires AttackInStep<AttackT, typename Env::StateType, AgentT> std::vector<Episode> rollout_in_step(
    Env& env, AgentT& agent, AttackT& attack, const EpisodesInStep& options, Observer&& observe) {
  using StateT = typename Env::StateType;
  using ObservationT = typename AgentT::ObservationType;
  using ActionT = typename AgentT::ActionType;
  if (options.lanes < 1) throw InputError("lanes: " + std::to_string(options.lanes) + ", expected at least 1");
  std::vector<Episode> episodes(static_cast<std::size_t>(options.episodes));
  if (options.horizon < 1) return episodes;
  const auto width = static_cast<std::size_t>(std::min<long>(options.lanes, options.episodes));
  std::vector<double> weight(episodes.size(), 1.0);
  std::vector<Stream> streams(width, Stream(options.seed));
  std::vector<StateT> state(width);
  std::vector<long> number(width);
  std::vector<Lane> lanes;
  long next_episode = options.first;
  agent.resize(static_cast<Lane>(width));
  attack.resize(static_cast<Lane>(width));
  const auto begin = [&](std::size_t l) {
    number[l] = next_episode++;
    streams[l] = Stream(options.seed, static_cast<std::uint64_t>(number[l]));
    state[l] = env.reset(streams[l]);
    agent.forget(static_cast<Lane>(l));
    attack.forget(static_cast<Lane>(l));
  };
  for (std::size_t l = 0; l < width; ++l) {
    begin(l);
    lanes.push_back(static_cast<Lane>(l));
  }
  std::vector<StateT> truths;
  std::vector<ObservationT> shown;
  std::vector<ActionT> actions;
  while (!lanes.empty()) {
    truths.clear();
    for (const Lane l : lanes) truths.push_back(state[static_cast<std::size_t>(l)]);
    shown.resize(lanes.size());
    actions.resize(lanes.size());
    attack.perturb(std::span<const Lane>(lanes), std::span<const StateT>(truths), std::as_const(agent),
                   std::span<Stream>(streams), std::span<ObservationT>(shown));
    agent.act(std::span<const Lane>(lanes), std::span<const ObservationT>(shown), std::span<Stream>(streams),
              std::span<ActionT>(actions));
    std::vector<Lane> running;
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const auto l = static_cast<std::size_t>(lanes[k]);
      const auto e = static_cast<std::size_t>(number[l] - options.first);
      const Outcome<StateT> outcome = env.step(state[l], actions[k], streams[l]);
      episodes[e].discounted_return += weight[e] * outcome.reward;
      episodes[e].total_reward += outcome.reward;
      weight[e] *= options.discount;
      observe(number[l], StepRecord<StateT, ObservationT, ActionT>{episodes[e].steps, truths[k], shown[k], actions[k],
                                                                   outcome.reward, outcome.next, outcome.terminal});
      ++episodes[e].steps;
      episodes[e].terminal = outcome.terminal;
      state[l] = outcome.next;
      if (!outcome.terminal && episodes[e].steps < options.horizon) {
        running.push_back(lanes[k]);
      } else if (next_episode < options.first + options.episodes) {
        begin(l);
        running.push_back(lanes[k]);
      }
    }
    lanes.swap(running);
  }
  return episodes;
}

template <Environment Env, AgentInStep AgentT, class AttackT>
std::vector<Episode> rollout_in_step(Env& env, AgentT& agent, AttackT& attack, const EpisodesInStep& options) {
  return rollout_in_step(env, agent, attack, options, [](long, const auto&) {});
}

}  // namespace maximin
