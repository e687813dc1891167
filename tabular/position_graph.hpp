#pragma once

#include <algorithm>
#include <cstddef>
#include <deque>
#include <functional>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::internal {

/// The attacker's graph on an agent that acts on beliefs. A position is (true state, belief) with the agent to move;
/// after the move and a random successor the attacker picks among `answers`, positions that differ in the observation.
/// Positions are numbered as they are reached, breadth first. The model, the perturbation and `choices` must outlive
/// it.
template <class Scalar>
class PositionGraph {
 public:
  using Answers = std::vector<int>;  ///< position indices, ascending, each once

  struct Branch {
    Scalar probability;
    Answers answers;
  };
  struct Move {
    Scalar reward{0};
    std::vector<Branch> branches = {};  ///< by successor of the truth
  };
  struct Position {
    State truth;
    int belief;                    ///< an id, for `belief`
    std::vector<Move> moves = {};  ///< by action that the agent may take; none where the position was not looked into
  };

  /// All actions that an agent may take on a belief, not none; a BeliefPolicy takes one.
  using BeliefChoices = std::function<std::vector<Action>(std::span<const State> belief)>;

  /// All positions that any attacker can bring about from any initial state; of more than `max_positions` the first are
  /// looked into, and those they lead to are named.
  PositionGraph(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, BeliefChoices choices,
                long max_positions)
      : mdp_(mdp), perturbation_(perturbation), choices_(std::move(choices)), max_positions_(max_positions) {
    Belief everything(static_cast<std::size_t>(mdp.states()));
    std::iota(everything.begin(), everything.end(), State(0));
    for (State s = 0; s < mdp.states(); ++s) starts_.push_back(answers(s, everything));
    const auto most = static_cast<std::size_t>(max_positions);
    for (std::size_t i = 0; i < positions_.size() && i < most; ++i) expand(i);  // grows while it is walked
  }

  /// Whether there are no more than `max_positions`, and so all were looked into.
  bool complete() const { return static_cast<long>(positions_.size()) <= max_positions_; }

  const std::deque<Position>& positions() const { return positions_; }
  long beliefs() const { return static_cast<long>(beliefs_.size()); }
  const Belief& belief(const Position& p) const { return *beliefs_[static_cast<std::size_t>(p.belief)]; }

  /// Whether all (s, B(t)), t in B(s), were looked into.
  bool looked_into_starts(State s) const {
    const Answers& start = starts(s);
    return std::none_of(start.begin(), start.end(),
                        [&](int i) { return positions_[static_cast<std::size_t>(i)].moves.empty(); });
  }

  /// (s, B(t)) for every t in B(s).
  const Answers& starts(State s) const { return starts_[static_cast<std::size_t>(s)]; }

 private:
  int intern_belief(const Belief& belief) {
    const auto [entry, is_new] = belief_ids_.try_emplace(belief, static_cast<int>(belief_ids_.size()));
    if (is_new) {
      beliefs_.push_back(&entry->first);
      actions_.push_back(choices_(entry->first));
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
    Belief predicted;
    for (const Action action : actions_[static_cast<std::size_t>(position.belief)]) {
      belief_successors(mdp_, std::span<const State>(belief(position)), action, predicted);
      Move& move = position.moves.emplace_back(Move{mdp_.reward(position.truth, action), {}});
      for (const auto& next : mdp_.successors(position.truth, action)) {
        move.branches.push_back({next.probability, answers(next.target, predicted)});
      }
    }
  }

  const FiniteMdp<Scalar>& mdp_;
  const Perturbation<Scalar>& perturbation_;
  BeliefChoices choices_;
  long max_positions_;
  std::map<Belief, int> belief_ids_;
  std::vector<const Belief*> beliefs_;       // by id, owned by the map
  std::deque<std::vector<Action>> actions_;  // by id: what the agent may do; a deque, as it grows while it is walked
  std::map<std::pair<State, int>, int> position_ids_;
  std::deque<Position> positions_;
  std::vector<Answers> starts_;  // by initial state
  Belief met_;
};

/// The least of the values of a branch's answers, i.e. what the attacker picks; `answers` holds one at least.
template <class Scalar>
Scalar worst(const Values<Scalar>& w, const std::vector<int>& answers) {
  Scalar least = w[answers.front()];
  for (const int i : answers) least = std::min(least, w[i]);
  return least;
}

}  // namespace maximin::internal
