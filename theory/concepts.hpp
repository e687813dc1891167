#pragma once

#include <concepts>
#include <span>
#include <type_traits>

#include <maximin/theory/random.hpp>

/// The vocabulary that the exact and the deep layer share. A table of three states and a network on pixels model the
/// same concepts, so that one `rollout` serves both and the exact layer can judge the deep one.
namespace maximin {

/// What one step of an environment returns.
template <class StateT>
struct Outcome {
  StateT next;            ///< the new true state
  double reward = 0;      ///< of this step
  bool terminal = false;  ///< the episode is over: nothing follows `next`
};

/// Something to act in: a FiniteMdp, a continuous Gridworld, a game.
template <class E>
concept Environment = requires(E& env, const typename E::StateType& s, const typename E::ActionType& a, Stream& rng) {
  { env.reset(rng) } -> std::convertible_to<typename E::StateType>;
  { env.step(s, a, rng) } -> std::convertible_to<Outcome<typename E::StateType>>;
};

/// Action values: q(s) gives one value per action. A Q table, or a network.
template <class Q, class StateT>
concept ActionValues = requires(const Q& q, const StateT& s) {
  { q(s)[0] } -> std::convertible_to<double>;
};

/// What the agent holds possible: the ball, the exact set, a particle filter, a purifier.
/// `reset` takes the first observation of an episode, `update` the action taken and the observation that followed.
template <class B>
concept BeliefModel = requires(B& belief, const typename B::ObservationType& o, const typename B::ActionType& a) {
  typename B::BeliefType;
  { belief.reset(o) } -> std::convertible_to<const typename B::BeliefType&>;
  { belief.update(a, o) } -> std::convertible_to<const typename B::BeliefType&>;
};

/// Whatever acts on observations: usually action values, a belief model and an aggregator.
/// `begin` takes the first observation of an episode and returns the first action; `act` each later observation.
template <class A>
concept Agent = requires(A& agent, const typename A::ObservationType& o, Stream& rng) {
  { agent.begin(o, rng) } -> std::convertible_to<typename A::ActionType>;
  { agent.act(o, rng) } -> std::convertible_to<typename A::ActionType>;
};

/// Whoever perturbs what the agent observes. It sees the true state and, being adaptive if it likes, the agent with all
/// its memory.
template <class K, class StateT, class AgentT>
concept Attack = requires(K& attack, const StateT& truth, const AgentT& agent, Stream& rng) {
  { attack.perturb(truth, agent, rng) } -> std::convertible_to<typename AgentT::ObservationType>;
};

}  // namespace maximin
