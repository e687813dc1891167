#pragma once

#include <span>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/aggregators.hpp>
#include <maximin/theory/concepts.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// An agent that tells what it would do if it were shown an observation now, without doing it: what an attack that
/// answers the agent's next action needs to know.
template <class A>
concept TransparentAgent = Agent<A> && requires(const A& agent, const typename A::ObservationType& o) {
  { agent.would_do(o) } -> std::convertible_to<typename A::ActionType>;
};

/// An agent with a stationary policy pi: it does policy[t] when it sees t, and remembers nothing. Throws
/// std::out_of_range on an observation that it has no action for.
class TabularAgent {
 public:
  using ObservationType = State;
  using ActionType = Action;

  explicit TabularAgent(Policy policy) : policy_(std::move(policy)) {}

  Action begin(State observation, Stream&) const { return would_do(observation); }
  Action act(State observation, Stream&) const { return would_do(observation); }
  Action would_do(State observation) const { return policy_.at(static_cast<std::size_t>(observation)); }

  const Policy& policy() const { return policy_; }

 private:
  Policy policy_;
};

/// The belief of an agent without memory: the ball of what it sees (paper, Algorithm 1). Models the BeliefModel
/// concept. The perturbation must outlive it.
template <class Scalar>
class BallBelief {
 public:
  using BeliefType = Belief;
  using ObservationType = State;
  using ActionType = Action;

  explicit BallBelief(const Perturbation<Scalar>& perturbation) : perturbation_(&perturbation) {}

  const Belief& reset(State observation) {
    const auto ball = perturbation_->ball(observation);
    belief_.assign(ball.begin(), ball.end());
    return belief_;
  }
  const Belief& update(Action, State observation) { return reset(observation); }
  const Belief& belief() const { return belief_; }

 private:
  const Perturbation<Scalar>* perturbation_;
  Belief belief_;
};

/// Action values, a belief model and an aggregator: acts by argmax_a Aggregate_{m in M_t} Q(m,a), the belief-maximin
/// agent when the aggregator is the minimum (paper, section 3.3). Copies the table.
///
///     BeliefAgent agent(q, BeliefFilter(mdp, perturbation));
///
/// `would_do` is const but uses the agent's scratch memory: one thread per agent.
template <class Scalar, BeliefModel BeliefT, class Agg = MinAggregator>
requires Aggregator<Agg, Scalar>
class BeliefAgent {
 public:
  using ObservationType = State;
  using ActionType = Action;

  BeliefAgent(QTable<Scalar> q, BeliefT belief, Agg aggregate = {}, TieBreak tie = TieBreak::lowest_index)
      : q_(std::move(q)), belief_(belief), probe_(std::move(belief)), aggregate_(std::move(aggregate)), tie_(tie) {}

  /// Before an episode: whatever comes next is a first observation.
  void forget() { started_ = false; }

  Action begin(State observation, Stream&) {
    last_ = decide(belief_.reset(observation));
    started_ = true;
    return last_;
  }

  Action act(State observation, Stream&) {
    last_ = decide(belief_.update(last_, observation));
    return last_;
  }

  Action would_do(State observation) const { return decide(would_believe(observation)); }

  /// The belief that the observation would lead to now. Valid until the next call.
  const Belief& would_believe(State observation) const {
    probe_ = belief_;
    return started_ ? probe_.update(last_, observation) : probe_.reset(observation);
  }

  /// What the agent holds possible: M_t after `begin` or `act`.
  const BeliefT& belief_model() const { return belief_; }

 private:
  Action decide(const Belief& belief) const {
    return belief_action(q_, std::span<const State>(belief), scratch_, aggregate_, tie_);
  }

  QTable<Scalar> q_;
  BeliefT belief_;
  mutable BeliefT probe_;
  Agg aggregate_;
  TieBreak tie_;
  mutable std::vector<Scalar> scratch_;
  Action last_ = 0;
  bool started_ = false;
};

}  // namespace maximin
