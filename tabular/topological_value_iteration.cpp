#include <maximin/tabular/topological_value_iteration.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/tabular/control.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/transition_graph.hpp>

namespace maximin {
namespace {

/// Components above this size are swept rather than solved by factorisation.
constexpr std::size_t largest_factorised_component = 1000;

template <class Scalar>
class ComponentSolver {
 public:
  ComponentSolver(const FiniteMdp<Scalar>& mdp, const SolverOptions& options, Scalar target)
      : mdp_(mdp), options_(options), target_(target), v_(Values<Scalar>::Zero(mdp.states())) {
    position_.resize(static_cast<std::size_t>(mdp.states()), outside);
  }

  /// Solves every component in turn and returns V*, to about the target.
  Values<Scalar> solve(const StrongComponents& components) {
    for (const auto& members : components.members) {
      if (members.size() == 1) {
        v_[members.front()] = value_of_single(members.front());
        work_ += 1;
      } else {
        solve_component(members);
      }
    }
    return std::move(v_);
  }

  /// Passes over the whole model that the work so far amounts to.
  long sweeps() const { return static_cast<long>(std::ceil(work_ / static_cast<double>(mdp_.states()))); }

 private:
  static constexpr State outside = -1;

  /// V(s) = max_a (R + gamma sum_{s' != s} P V) / (1 - gamma P(s|s,a)).
  Scalar value_of_single(State s) const {
    Scalar best(0);
    for (Action a = 0; a < mdp_.actions(); ++a) {
      Scalar stay(0), leave(0);
      for (const auto& next : mdp_.successors(s, a)) {
        if (next.target == s) {
          stay += next.probability;
        } else {
          leave += next.probability * v_[next.target];
        }
      }
      const Scalar value = (mdp_.reward(s, a) + mdp_.discount() * leave) / (Scalar(1) - mdp_.discount() * stay);
      if (a == 0 || value > best) best = value;
    }
    return best;
  }

  void solve_component(const std::vector<State>& members) {
    const FiniteMdp<Scalar> part = component_model(members);
    const MacQueenBound<Scalar> bound(part);
    if (!(bound.scale() > Scalar(0))) {
      for (const State s : members) v_[s] = Scalar(0);
      return;
    }
    SolverOptions options = options_;
    // Errors of later components add up along the way back, by at most 1/(1-gamma) in all.
    const Scalar wanted = target_ * (Scalar(1) - mdp_.discount()) / Scalar(2);
    options.tolerance = static_cast<double>(std::max(wanted, bound.target({})) / bound.scale());
    const auto solution = members.size() <= largest_factorised_component ? policy_iteration(part, options)
                                                                         : modified_policy_iteration(part, options);
    for (std::size_t i = 0; i < members.size(); ++i) v_[members[i]] = solution.v[static_cast<Eigen::Index>(i)];
    work_ += static_cast<double>(solution.sweeps) * static_cast<double>(members.size());
  }

  /// The component as a model of its own: whatever leaves it goes to one more state, worth nothing, and the known value
  /// of where it really goes is paid as a reward on leaving.
  FiniteMdp<Scalar> component_model(const std::vector<State>& members) {
    for (std::size_t i = 0; i < members.size(); ++i) position_[index(members[i])] = static_cast<State>(i);
    const auto exit = static_cast<State>(members.size());
    FiniteMdpBuilder<Scalar> part(exit + 1, mdp_.actions(), mdp_.discount());
    for (State i = 0; i < exit; ++i) {
      const State s = members[index(i)];
      for (Action a = 0; a < mdp_.actions(); ++a) {
        Scalar leaving(0), paid(0);
        for (const auto& next : mdp_.successors(s, a)) {
          const State to = position_[index(next.target)];
          if (to != outside) {
            part.transition(i, a, to, next.probability);
          } else {
            leaving += next.probability;
            paid += next.probability * v_[next.target];
          }
        }
        part.transition(i, a, exit, leaving);
        part.reward(i, a, mdp_.reward(s, a) + mdp_.discount() * paid);
      }
    }
    for (Action a = 0; a < mdp_.actions(); ++a) part.transition(exit, a, exit, Scalar(1));
    for (const State s : members) position_[index(s)] = outside;
    return std::move(part).build();
  }

  static std::size_t index(State s) { return static_cast<std::size_t>(s); }

  const FiniteMdp<Scalar>& mdp_;
  const SolverOptions& options_;
  Scalar target_;
  Values<Scalar> v_;
  std::vector<State> position_;  // of each state in the component at hand
  double work_ = 0;              // states backed up
};

}  // namespace

template <class Scalar>
CertifiedSolution<Scalar> topological_value_iteration(const FiniteMdp<Scalar>& mdp, const SolverOptions& options) {
  const auto problem = ControlProblem<Scalar>::optimal_control(mdp);
  const MacQueenBound<Scalar> bound(mdp);
  const Scalar target = bound.target(options);
  ComponentSolver<Scalar> parts(mdp, options, target);
  Values<Scalar> v = parts.solve(strong_components(transition_graph(mdp))), tv;
  Policy policy;
  for (long sweeps = parts.sweeps() + 1;; ++sweeps) {
    problem.sweep(v, tv, policy, options.tie);
    const auto interval = bound(v, tv);
    if (interval.error <= target) {
      tv.array() += interval.shift;
      return internal::finish(problem, bound, std::move(tv), std::move(policy), interval.error, sweeps);
    }
    if (sweeps >= options.max_sweeps) {
      throw BudgetExhausted(
          fmt::format("topological value iteration: certified error {:.3g} after {} sweeps, asked for {:.3g}; allow "
                      "more sweeps or a "
                      "larger tolerance",
                      interval.error, sweeps, target));
    }
    v.swap(tv);
  }
}

template CertifiedSolution<double> topological_value_iteration(const FiniteMdp<double>&, const SolverOptions&);

}  // namespace maximin
