#pragma once

#include <span>
#include <vector>

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// Who picks the action in each state, and among which actions: one player on the transitions of an MDP. The plain
/// problem is "maximise over all actions" (T*). The optimal attacker of a policy pi is "minimise over { pi(t) : t in
/// B(s) }" (T^{pi}_rob). A fixed policy is a choice of one. One set of solvers serves all three.
template <class Scalar>
class ControlProblem {
 public:
  enum class Player { maximise, minimise };

  /// T*: the agent picks among all actions. The model must outlive the problem.
  static ControlProblem optimal_control(const FiniteMdp<Scalar>& mdp) {
    ControlProblem problem(mdp, Player::maximise);
    for (Action a = 0; a < mdp.actions(); ++a) problem.choices_.push_back(a);
    return problem;
  }

  /// The player picks among choices[s], not empty, in state s.
  ControlProblem(const FiniteMdp<Scalar>& mdp, Player player, const std::vector<std::vector<Action>>& choices)
      : ControlProblem(mdp, player) {
    begin_.push_back(0);
    for (const auto& list : choices) {
      choices_.insert(choices_.end(), list.begin(), list.end());
      begin_.push_back(choices_.size());
    }
  }

  const FiniteMdp<Scalar>& mdp() const { return *mdp_; }

  /// The actions that the player may pick in s.
  std::span<const Action> choices(State s) const {
    if (begin_.empty()) return choices_;
    const auto i = static_cast<std::size_t>(s);
    return std::span(choices_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
  }

  /// Whether x is better than y for the player.
  bool better(const Scalar& x, const Scalar& y) const { return player_ == Player::maximise ? x > y : x < y; }

  bool maximises() const { return player_ == Player::maximise; }

  /// (R + gamma P v)(s,a).
  Scalar backup(State s, Action a, const Values<Scalar>& v) const {
    return mdp_->reward(s, a) + mdp_->discount() * mdp_->expectation(s, a, v);
  }

  /// tv(s) = best of (R + gamma P v)(s,a) over the choices, and the first choice that attains it (the last one, for
  /// TieBreak::highest_index). v and tv must be distinct.
  void sweep(const Values<Scalar>& v, Values<Scalar>& tv, Policy& policy, TieBreak tie) const {
    tv.resize(v.size());
    policy.resize(static_cast<std::size_t>(v.size()));
    for (State s = 0; s < mdp_->states(); ++s) {
      const auto actions = choices(s);
      Action best = actions.front();
      Scalar best_value = backup(s, best, v);
      for (const Action a : actions.subspan(1)) {
        const Scalar value = backup(s, a, v);
        if (tie == TieBreak::lowest_index ? better(value, best_value) : !better(best_value, value)) {
          best = a;
          best_value = value;
        }
      }
      tv[s] = best_value;
      policy[static_cast<std::size_t>(s)] = best;
    }
  }

  /// tv(s) = (R + gamma P v)(s, policy[s]).
  void sweep_policy(const Values<Scalar>& v, const Policy& policy, Values<Scalar>& tv) const {
    tv.resize(v.size());
    for (State s = 0; s < mdp_->states(); ++s) tv[s] = backup(s, policy[static_cast<std::size_t>(s)], v);
  }

 private:
  ControlProblem(const FiniteMdp<Scalar>& mdp, Player player) : mdp_(&mdp), player_(player) {}

  const FiniteMdp<Scalar>* mdp_;
  Player player_;
  std::vector<std::size_t> begin_;  // |S| + 1 offsets into choices_, or empty: the same choices everywhere
  std::vector<Action> choices_;
};

namespace internal {

/// Q, V and error from state values certified to within `error`: one more backup, and its rounding.
template <class Scalar>
CertifiedSolution<Scalar> finish(const ControlProblem<Scalar>& problem, const MacQueenBound<Scalar>& bound,
                                 Values<Scalar> v, Policy policy, Scalar error, long sweeps);

/// Modified policy iteration: greedy sweeps, each followed by `partial_sweeps` sweeps of the greedy policy. None is
/// value iteration.
template <class Scalar>
CertifiedSolution<Scalar> iterate_values(const ControlProblem<Scalar>& problem, const SolverOptions& options,
                                         long partial_sweeps);

/// Policy iteration: exact evaluation (a linear solve) and greedy improvement until the policy stays.
template <class Scalar>
CertifiedSolution<Scalar> iterate_policies(const ControlProblem<Scalar>& problem, const SolverOptions& options);

}  // namespace internal
}  // namespace maximin
