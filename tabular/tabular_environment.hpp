#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/concepts.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// A finite model to act in. Models the Environment concept. An episode is over when it enters a state that no action
/// leaves and that pays nothing: the rest of its return is zero.
///
/// Every reset and every step takes exactly one number from the stream, whatever the model, so that two runs that
/// differ in one decision still share all other randomness. The model must outlive the environment.
///
///     TabularEnvironment env(mdp, State{0});
///     evaluate(env, agent, attack, mdp.discount(), horizon, episodes, seed);
template <class Scalar>
class TabularEnvironment {
 public:
  using StateType = State;
  using ActionType = Action;

  /// Every state equally likely to start.
  explicit TabularEnvironment(const FiniteMdp<Scalar>& mdp)
      : TabularEnvironment(mdp, std::vector<Scalar>(static_cast<std::size_t>(mdp.states()),
                                                    Scalar(1) / Scalar(static_cast<long>(mdp.states())))) {}

  /// Always the same start. Throws InputError when it is no state.
  TabularEnvironment(const FiniteMdp<Scalar>& mdp, State start)
      : TabularEnvironment(mdp, point_mass(mdp.states(), start)) {}

  /// Starts drawn from Pr(s_0), one probability per state. Throws InputError unless they are not negative and sum to 1
  /// (up to rounding).
  TabularEnvironment(const FiniteMdp<Scalar>& mdp, const std::vector<Scalar>& start) : mdp_(&mdp) {
    const auto n = static_cast<std::size_t>(mdp.states());
    if (start.size() != n) {
      throw InputError("start: " + std::to_string(start.size()) + " probabilities, expected one per state, " +
                       std::to_string(n));
    }
    double sum = 0;
    for (std::size_t s = 0; s < n; ++s) {
      const auto p = static_cast<double>(start[s]);
      if (!(p >= 0)) throw InputError("start[" + std::to_string(s) + "]: negative or NaN, expected a probability");
      if (p > 0) start_.emplace_back(static_cast<State>(s), p);
      sum += p;
    }
    if (!(sum > 1 - 1e-9 && sum < 1 + 1e-9)) {
      throw InputError("start: probabilities sum to " + std::to_string(sum) + ", expected 1");
    }
    for (State s = 0; s < mdp.states(); ++s) terminal_.push_back(is_dead_end(s));
  }

  /// Draws s_0.
  State reset(Stream& rng) const {
    double left = rng.uniform();
    for (const auto& [state, probability] : start_) {
      left -= probability;
      if (left < 0) return state;
    }
    return start_.back().first;
  }

  /// Draws s' from P(.|s,a), by inversion in order of s'.
  Outcome<State> step(State s, Action a, Stream& rng) const {
    const auto row = mdp_->successors(s, a);
    State next = row.back().target;
    double left = rng.uniform();
    for (const auto& successor : row) {
      left -= static_cast<double>(successor.probability);
      if (left < 0) {
        next = successor.target;
        break;
      }
    }
    return {next, static_cast<double>(mdp_->reward(s, a)), terminal(next)};
  }

  /// Whether an episode ends on entering s.
  bool terminal(State s) const { return terminal_[static_cast<std::size_t>(s)]; }

  const FiniteMdp<Scalar>& mdp() const { return *mdp_; }

 private:
  static std::vector<Scalar> point_mass(State states, State start) {
    if (start < 0 || start >= states) {
      throw InputError("start: state " + std::to_string(start) + " does not exist, expected 0 to " +
                       std::to_string(states - 1));
    }
    std::vector<Scalar> mass(static_cast<std::size_t>(states), Scalar(0));
    mass[static_cast<std::size_t>(start)] = Scalar(1);
    return mass;
  }

  bool is_dead_end(State s) const {
    for (Action a = 0; a < mdp_->actions(); ++a) {
      const auto row = mdp_->successors(s, a);
      if (mdp_->reward(s, a) != Scalar(0) || row.size() != 1 || row.front().target != s) return false;
    }
    return true;
  }

  const FiniteMdp<Scalar>* mdp_;
  std::vector<std::pair<State, double>> start_;
  std::vector<bool> terminal_;
};

}  // namespace maximin
