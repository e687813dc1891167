#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::internal {

/// The attacker's graph on a belief policy. A position is (true state, belief) with the agent to move; after the move
/// and a random successor the attacker picks among `answers`, positions that differ in the observation. Positions are
/// numbered as they are reached, breadth first. The model and the perturbation must outlive it.
template <class Scalar>
class PositionGraph {
 public:
  using Answers = std::vector<int>;  ///< position indices, ascending, each once

  struct Branch {
    Scalar probability;
    Answers answers;
  };
  struct Position {
    State truth;
    int belief;  ///< an id, for `belief`
    Scalar reward{0};
    std::vector<Branch> branches = {};  ///< by successor of the truth
  };

  /// All positions that any attacker can bring about from any initial state; no longer looked for when there are more
  /// than `max_positions`.
  PositionGraph(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, const BeliefPolicy& policy,
                long max_positions)
      : mdp_(mdp), perturbation_(perturbation), policy_(policy), max_positions_(max_positions) {
    Belief everything(static_cast<std::size_t>(mdp.states()));
    std::iota(everything.begin(), everything.end(), State(0));
    for (State s = 0; s < mdp.states() && complete(); ++s) starts_.push_back(answers(s, everything));
    for (std::size_t i = 0; i < positions_.size() && complete(); ++i) expand(i);  // grows while it is walked
  }

  /// Whether there are no more than `max_positions`. Otherwise the graph is of no use.
  bool complete() const { return static_cast<long>(positions_.size()) <= max_positions_; }

  const std::deque<Position>& positions() const { return positions_; }
  long beliefs() const { return static_cast<long>(beliefs_.size()); }
  const Belief& belief(const Position& p) const { return *beliefs_[static_cast<std::size_t>(p.belief)]; }

  /// (s, B(t)) for every t in B(s).
  const Answers& starts(State s) const { return starts_[static_cast<std::size_t>(s)]; }

 private:
  int intern_belief(const Belief& belief) {
    const auto [entry, is_new] = belief_ids_.try_emplace(belief, static_cast<int>(belief_ids_.size()));
    if (is_new) {
      beliefs_.push_back(&entry->first);
      actions_.push_back(policy_(entry->first));
    }
    return entry->second;
  }

  int intern_position(State truth, int belief) {
    const auto [entry, is_new] = position_ids_.try_emplace({truth, belief}, static_cast<int>(positions_.size()));
    if (is_new) positions_.push_back({truth, belief});
    return entry->second;
  }

  /// The positions that the attacker can bring about when `truth` is true and the agent has predicted `predicted`.
  Answers answers(State truth, const Belief& predicted) {
    Answers result;
    for (const State shown : perturbation_.ball(truth)) {
      meet_observation(perturbation_, predicted, shown, met_);
      result.push_back(intern_position(truth, intern_belief(met_)));
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  void expand(std::size_t i) {
    Position& position = positions_[i];  // stays where it is: a deque
    const Action action = actions_[static_cast<std::size_t>(position.belief)];
    Belief predicted;
    belief_successors(mdp_, std::span<const State>(belief(position)), action, predicted);
    position.reward = mdp_.reward(position.truth, action);
    for (const auto& next : mdp_.successors(position.truth, action)) {
      position.branches.push_back({next.probability, answers(next.target, predicted)});
    }
  }

  const FiniteMdp<Scalar>& mdp_;
  const Perturbation<Scalar>& perturbation_;
  const BeliefPolicy& policy_;
  long max_positions_;
  std::map<Belief, int> belief_ids_;
  std::vector<const Belief*> beliefs_;  // by id, owned by the map
  std::vector<Action> actions_;         // by id: what the policy does
  std::map<std::pair<State, int>, int> position_ids_;
  std::deque<Position> positions_;
  std::vector<Answers> starts_;  // by initial state
  Belief met_;
};

}  // namespace maximin::internal
