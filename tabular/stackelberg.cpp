#include <maximin/tabular/stackelberg.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>

#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// |A|^|S|. Throws BudgetExhausted when it is above the limit.
long count_policies(State states, Action actions, long limit) {
  long count = 1;
  for (State s = 0; s < states; ++s) {
    if (count > limit / actions) {
      const double digits = std::log10(actions) * states;
      throw BudgetExhausted(
          fmt::format("stackelberg: {}^{} policies (about 10^{:.1f}), at most {} allowed; raise the limit "
                      "or take a smaller model",
                      actions, states, digits, limit));
    }
    count *= actions;
  }
  return count;
}

/// The next policy, the action of state 0 changing fastest. False after the last.
bool advance(Policy& policy, Action actions) {
  for (Action& a : policy) {
    if (++a < actions) return true;
    a = 0;
  }
  return false;
}

/// For every true state the set of actions that the attacker can provoke, as bits: all that a policy's value depends
/// on.
template <class Scalar>
std::vector<bool> provokable_actions(const Perturbation<Scalar>& perturbation, const Policy& policy, Action actions) {
  std::vector<bool> bits(policy.size() * static_cast<std::size_t>(actions));
  for (State s = 0; s < perturbation.states(); ++s) {
    const auto row = static_cast<std::size_t>(s) * static_cast<std::size_t>(actions);
    for (const State t : perturbation.ball(s)) {
      bits[row + static_cast<std::size_t>(policy[static_cast<std::size_t>(t)])] = true;
    }
  }
  return bits;
}

template <class Scalar>
void check(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, const std::vector<Scalar>& start) {
  if (perturbation.states() != mdp.states()) {
    throw InputError(fmt::format("balls: {} states, expected {} like the model", perturbation.states(), mdp.states()));
  }
  if (start.empty()) return;
  if (start.size() != static_cast<std::size_t>(mdp.states())) {
    throw InputError(fmt::format("start: {} probabilities, expected one per state, {}", start.size(), mdp.states()));
  }
  double sum = 0;
  for (std::size_t s = 0; s < start.size(); ++s) {
    if (!(start[s] >= Scalar(0)))
      throw InputError(fmt::format("start[{}]: negative or NaN, expected a probability", s));
    sum += static_cast<double>(start[s]);
  }
  if (!(std::abs(sum - 1) < 1e-9)) throw InputError(fmt::format("start: probabilities sum to {}, expected 1", sum));
}

template <class Scalar>
class Table {
 public:
  Table(State states, const std::vector<Scalar>& start) : start_(start) {
    result_.best_for_state.resize(static_cast<std::size_t>(states));
  }

  void enter(const Policy& policy, const Values<Scalar>& v, const Scalar& error) {
    const bool first = result_.distinct++ == 0;
    if (first) result_.v = v;
    for (Eigen::Index s = 0; s < v.size(); ++s) {
      if (!first && !(v[s] > result_.v[s])) continue;
      result_.v[s] = v[s];
      result_.best_for_state[static_cast<std::size_t>(s)] = policy;
    }
    if (first || v.sum() > result_.compromise_values.sum()) {
      result_.compromise = policy;
      result_.compromise_values = v;
    }
    result_.error = std::max(result_.error, error);
    enter_start(policy, v);
  }

  /// A policy that is best everywhere has at least the sum of the compromise, up to 2 |S| error; so where one exists,
  /// the compromise falls short nowhere by more than that, and 2 error for comparing.
  StackelbergValues<Scalar> finish(long policies) {
    result_.policies = policies;
    result_.shortfall = (result_.v - result_.compromise_values).maxCoeff();
    result_.slack = Scalar(2) * Scalar(static_cast<long>(result_.v.size()) + 1) * result_.error;
    return std::move(result_);
  }

 private:
  void enter_start(const Policy& policy, const Values<Scalar>& v) {
    if (start_.empty()) return;
    Scalar value(0);
    for (Eigen::Index s = 0; s < v.size(); ++s) value += start_[static_cast<std::size_t>(s)] * v[s];
    if (result_.best_for_start && !(value > result_.value_for_start)) return;
    result_.best_for_start = policy;
    result_.value_for_start = value;
  }

  const std::vector<Scalar>& start_;
  StackelbergValues<Scalar> result_;
};

}  // namespace

template <class Scalar>
StackelbergValues<Scalar> stackelberg_values(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                             const StackelbergOptions<Scalar>& options,
                                             const PolicyObserver<Scalar>& observe) {
  check(mdp, perturbation, options.start);
  const long policies = count_policies(mdp.states(), mdp.actions(), options.max_policies);
  Table<Scalar> table(mdp.states(), options.start);
  std::set<std::vector<bool>> seen;
  Policy policy(static_cast<std::size_t>(mdp.states()), 0);
  do {
    if (!seen.insert(provokable_actions(perturbation, policy, mdp.actions())).second) continue;
    const auto value = evaluate_against_optimal_attack(mdp, perturbation, policy, options.solver);
    table.enter(policy, value.v, value.error);
    if (observe) observe(policy, value.v);
  } while (advance(policy, mdp.actions()));
  return table.finish(policies);
}

template StackelbergValues<double> stackelberg_values(const FiniteMdp<double>&, const Perturbation<double>&,
                                                      const StackelbergOptions<double>&, const PolicyObserver<double>&);

}  // namespace maximin
