#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The states the agent holds possible (the paper's M_t), ascending, never empty.
using Belief = std::vector<State>;

/// M'_t = { s' : exists s in M_t with P(s'|s,a) > 0 } (paper, section 3.3): everything that the action may have led to.
template <class Scalar>
void belief_successors(const FiniteMdp<Scalar>& mdp, std::span<const State> belief, Action action, Belief& out) {
  out.clear();
  for (const State s : belief) {
    for (const auto& next : mdp.successors(s, action)) out.push_back(next.target);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

/// What meeting a prediction with the ball of an observation came to.
enum class BeliefUpdate {
  met,    ///< M_{t+1} = M'_t intersected with B(observation)
  empty,  ///< they do not meet; M_{t+1} = B(observation) instead
};

/// M_{t+1} = M'_t intersected with B(observation) (paper, Belief Update, Algorithm 2 of the appendix).
///
/// If the model is right and the attacker keeps to the ball, the truth is in both and they always meet. If they do not,
/// one of the two is false; the observation is then trusted over the history, M_{t+1} = B(observation), and the caller
/// is told.
template <class Scalar>
BeliefUpdate meet_observation(const Perturbation<Scalar>& perturbation, std::span<const State> predicted,
                              State observation, Belief& out) {
  const auto ball = perturbation.ball(observation);
  out.clear();
  std::set_intersection(predicted.begin(), predicted.end(), ball.begin(), ball.end(), std::back_inserter(out));
  if (!out.empty()) return BeliefUpdate::met;
  out.assign(ball.begin(), ball.end());
  return BeliefUpdate::empty;
}

/// The exact belief of an agent that knows the model and eps: M_0 = B(first observation), then one update per step.
/// Models the BeliefModel concept. The model and the perturbation must outlive it.
///
///     BeliefFilter filter(mdp, perturbation);
///     filter.reset(observation);
///     filter.update(action, next_observation);
template <class Scalar>
class BeliefFilter {
 public:
  using BeliefType = Belief;
  using ObservationType = State;
  using ActionType = Action;

  BeliefFilter(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation)
      : mdp_(&mdp), perturbation_(&perturbation) {}

  /// Starts an episode: the belief is the ball of the first observation.
  const Belief& reset(State observation) {
    const auto ball = perturbation_->ball(observation);
    belief_.assign(ball.begin(), ball.end());
    return belief_;
  }

  /// Takes the action that was taken and the observation that followed.
  const Belief& update(Action action, State observation) {
    belief_successors(*mdp_, std::span<const State>(belief_), action, predicted_);
    if (meet_observation(*perturbation_, predicted_, observation, belief_) == BeliefUpdate::empty) ++empty_;
    return belief_;
  }

  /// M_t.
  const Belief& belief() const { return belief_; }
  /// M'_{t-1}: what the last action may have led to, before the observation.
  const Belief& predicted() const { return predicted_; }
  /// How often, over all episodes, prediction and observation did not meet.
  long empty_intersections() const { return empty_; }

 private:
  const FiniteMdp<Scalar>* mdp_;
  const Perturbation<Scalar>* perturbation_;
  Belief belief_;
  Belief predicted_;
  long empty_ = 0;
};

}  // namespace maximin
