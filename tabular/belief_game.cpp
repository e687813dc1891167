#include <maximin/tabular/belief_game.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/position_graph.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {
namespace {

/// The game on the attacker's graph: functions of the position.
template <class Scalar>
class BeliefGame {
 public:
  BeliefGame(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, const BeliefPolicy& policy,
             long max_positions)
      : mdp_(mdp),
        perturbation_(perturbation),
        graph_(
            mdp, perturbation, [&](std::span<const State> belief) { return std::vector{policy(belief)}; },
            max_positions) {
    if (graph_.complete()) return;
    throw BudgetExhausted(
        fmt::format("belief game: more than {} reachable (state, belief) pairs; allow more or take "
                    "a smaller model or eps",
                    max_positions));
  }

  /// V(s) = R + gamma sum p min over the attacker's answers.
  void sweep(const Values<Scalar>& w, Values<Scalar>& tw) const {
    tw.resize(w.size());
    Eigen::Index i = 0;
    for (const auto& position : graph_.positions()) {
      const auto& move = position.moves.front();
      Scalar sum(0);
      for (const auto& branch : move.branches) sum += branch.probability * internal::worst(w, branch.answers);
      tw[i++] = move.reward + mdp_.discount() * sum;
    }
  }

  /// min_{t in B(s)} W(s, B(t)).
  Values<Scalar> start_values(const Values<Scalar>& w) const {
    Values<Scalar> v(mdp_.states());
    for (State s = 0; s < mdp_.states(); ++s) v[s] = internal::worst(w, graph_.starts(s));
    return v;
  }

  /// W by true state and belief.
  std::map<std::pair<State, Belief>, Scalar> by_position(const Values<Scalar>& w) const {
    std::map<std::pair<State, Belief>, Scalar> result;
    Eigen::Index i = 0;
    for (const auto& p : graph_.positions()) result.emplace(std::pair(p.truth, graph_.belief(p)), w[i++]);
    return result;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(graph_.positions().size()); }
  long beliefs() const { return graph_.beliefs(); }

  /// The largest distance from the truth to a member of the belief, and the mean size of the belief.
  std::pair<Scalar, double> spread() const {
    Scalar reach(0);
    double members = 0;
    for (const auto& position : graph_.positions()) {
      const Belief& belief = graph_.belief(position);
      members += static_cast<double>(belief.size());
      for (const State m : belief) reach = std::max(reach, perturbation_.metric().distance(position.truth, m));
    }
    return {reach, members / static_cast<double>(size())};
  }

 private:
  const FiniteMdp<Scalar>& mdp_;
  const Perturbation<Scalar>& perturbation_;
  internal::PositionGraph<Scalar> graph_;
};

}  // namespace

template <class Scalar>
BeliefPolicy maximin_belief_policy(QTable<Scalar> q, TieBreak tie) {
  return [q = std::move(q), tie, scratch = std::vector<Scalar>()](std::span<const State> belief) mutable {
    return belief_action(q, belief, scratch, MinAggregator{}, tie);
  };
}

template <class Scalar>
Policy stationary_policy_of(const Perturbation<Scalar>& perturbation, const BeliefPolicy& policy) {
  Policy result(static_cast<std::size_t>(perturbation.states()));
  for (State t = 0; t < perturbation.states(); ++t) result[static_cast<std::size_t>(t)] = policy(perturbation.ball(t));
  return result;
}

template <class Scalar>
BeliefGameValue<Scalar> solve_belief_game(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                          const BeliefPolicy& policy, const BeliefGameOptions& options) {
  const BeliefGame<Scalar> game(mdp, perturbation, policy, options.max_positions);
  const MacQueenBound<Scalar> bound(mdp);
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  const Scalar target = std::max(bound.target(solver), bound.target({}));
  Values<Scalar> w = Values<Scalar>::Zero(game.size()), tw;
  for (long sweeps = 1; sweeps <= options.max_sweeps; ++sweeps) {
    game.sweep(w, tw);
    const auto interval = bound(w, tw);
    if (interval.error <= target) {
      tw.array() += interval.shift;
      const auto [reach, mean_size] = game.spread();
      BeliefGameValue<Scalar> value{game.start_values(tw),
                                    interval.error,
                                    static_cast<long>(game.size()),
                                    game.beliefs(),
                                    reach,
                                    mean_size,
                                    sweeps};
      if (options.keep_positions) value.w = game.by_position(tw);
      return value;
    }
    w.swap(tw);
  }
  throw BudgetExhausted(fmt::format("belief game: not certified after {} sweeps; allow more", options.max_sweeps));
}

template BeliefPolicy maximin_belief_policy(QTable<double>, TieBreak);
template BeliefPolicy maximin_belief_policy(QTable<Rational>, TieBreak);
template Policy stationary_policy_of(const Perturbation<double>&, const BeliefPolicy&);
template BeliefGameValue<double> solve_belief_game(const FiniteMdp<double>&, const Perturbation<double>&,
                                                   const BeliefPolicy&, const BeliefGameOptions&);

}  // namespace maximin
