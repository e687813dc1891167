#include <maximin/tabular/belief_game.hpp>

#include <algorithm>
#include <cmath>
#include <deque>
#include <map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/certified.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

/// The attacker's graph. A position is (true state, belief) with the agent to move; after the move and a random
/// successor the attacker picks among `options`, positions that differ in the observation.
template <class Scalar>
class PositionGraph {
 public:
  PositionGraph(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, const BeliefPolicy& policy,
                long max_positions)
      : mdp_(mdp), perturbation_(perturbation), policy_(policy), max_positions_(max_positions) {
    for (State s = 0; s < mdp.states(); ++s) {
      Belief everything(static_cast<std::size_t>(mdp.states()));
      for (State m = 0; m < mdp.states(); ++m) everything[static_cast<std::size_t>(m)] = m;
      starts_.push_back(answers(s, everything));
    }
    for (std::size_t i = 0; i < positions_.size(); ++i) expand(i);  // grows while it is walked
  }

  /// V(s) = R + gamma sum p min over the attacker's answers.
  void sweep(const Values<Scalar>& w, Values<Scalar>& tw) const {
    tw.resize(w.size());
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      Scalar sum(0);
      for (const auto& branch : positions_[i].branches) sum += branch.probability * worst(w, branch.answers);
      tw[static_cast<Eigen::Index>(i)] = positions_[i].reward + mdp_.discount() * sum;
    }
  }

  /// min_{t in B(s)} W(s, B(t)).
  Values<Scalar> start_values(const Values<Scalar>& w) const {
    Values<Scalar> v(mdp_.states());
    for (State s = 0; s < mdp_.states(); ++s) v[s] = worst(w, starts_[static_cast<std::size_t>(s)]);
    return v;
  }

  /// W by true state and belief.
  std::map<std::pair<State, Belief>, Scalar> by_position(const Values<Scalar>& w) const {
    std::map<std::pair<State, Belief>, Scalar> result;
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const Belief& belief = *beliefs_[static_cast<std::size_t>(positions_[i].belief)];
      result.emplace(std::pair(positions_[i].truth, belief), w[static_cast<Eigen::Index>(i)]);
    }
    return result;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(positions_.size()); }
  long beliefs() const { return static_cast<long>(belief_ids_.size()); }

  /// The largest distance from the truth to a member of the belief, and the mean size of the belief.
  std::pair<Scalar, double> spread() const {
    Scalar reach(0);
    double members = 0;
    for (const auto& position : positions_) {
      const Belief& belief = *beliefs_[static_cast<std::size_t>(position.belief)];
      members += static_cast<double>(belief.size());
      for (const State m : belief) reach = std::max(reach, perturbation_.metric().distance(position.truth, m));
    }
    return {reach, members / static_cast<double>(positions_.size())};
  }

 private:
  using Answers = std::vector<int>;  // position indices

  struct Branch {
    Scalar probability;
    Answers answers;
  };
  struct Position {
    State truth;
    int belief;
    Scalar reward{0};
    std::vector<Branch> branches;
  };

  static Scalar worst(const Values<Scalar>& w, const Answers& answers) {
    Scalar least = w[answers.front()];
    for (const int i : answers) least = std::min(least, w[i]);
    return least;
  }

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
    if (is_new) {
      if (static_cast<long>(positions_.size()) >= max_positions_) {
        throw BudgetExhausted(
            fmt::format("belief game: more than {} reachable (state, belief) pairs; allow more or take "
                        "a smaller model or eps",
                        max_positions_));
      }
      positions_.push_back({truth, belief, Scalar(0), {}});
    }
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
    const State truth = positions_[i].truth;
    const auto belief = static_cast<std::size_t>(positions_[i].belief);
    const Action action = actions_[belief];
    Belief predicted;
    belief_successors(mdp_, std::span<const State>(*beliefs_[belief]), action, predicted);
    std::vector<Branch> branches;
    for (const auto& next : mdp_.successors(truth, action)) {
      branches.push_back({next.probability, answers(next.target, predicted)});
    }
    positions_[i].reward = mdp_.reward(truth, action);
    positions_[i].branches = std::move(branches);
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
  const PositionGraph<Scalar> graph(mdp, perturbation, policy, options.max_positions);
  const MacQueenBound<Scalar> bound(mdp);
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  const Scalar target = std::max(bound.target(solver), bound.target({}));
  Values<Scalar> w = Values<Scalar>::Zero(graph.size()), tw;
  for (long sweeps = 1; sweeps <= options.max_sweeps; ++sweeps) {
    graph.sweep(w, tw);
    const auto interval = bound(w, tw);
    if (interval.error <= target) {
      tw.array() += interval.shift;
      const auto [reach, mean_size] = graph.spread();
      BeliefGameValue<Scalar> value{graph.start_values(tw),
                                    interval.error,
                                    static_cast<long>(graph.size()),
                                    graph.beliefs(),
                                    reach,
                                    mean_size,
                                    sweeps};
      if (options.keep_positions) value.w = graph.by_position(tw);
      return value;
    }
    w.swap(tw);
  }
  throw BudgetExhausted(fmt::format("belief game: not certified after {} sweeps; allow more", options.max_sweeps));
}

template BeliefPolicy maximin_belief_policy(QTable<double>, TieBreak);
template Policy stationary_policy_of(const Perturbation<double>&, const BeliefPolicy&);
template BeliefGameValue<double> solve_belief_game(const FiniteMdp<double>&, const Perturbation<double>&,
                                                   const BeliefPolicy&, const BeliefGameOptions&);

}  // namespace maximin
