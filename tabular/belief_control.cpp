#include <maximin/tabular/belief_control.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>

#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

struct HashOfStates {
  std::size_t operator()(const Belief& belief) const {
    std::size_t h = 0xcbf29ce484222325u;
    for (const State s : belief) h = (h ^ static_cast<std::size_t>(s)) * 0x100000001b3u;
    return h ^ (h >> 29);
  }
};

/// The beliefs that can be reached and what each action may lead to, in order of their discovery.
template <class Scalar>
class BeliefGraph {
 public:
  static constexpr int ended = -1;

  /// The attacker's answer to an action.
  struct Answer {
    int next;       ///< a belief, or `ended`
    Scalar reward;  ///< the least that the step may pay then
  };

  BeliefGraph(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, long max_beliefs)
      : mdp_(mdp), perturbation_(perturbation), environment_(mdp), max_beliefs_(max_beliefs) {
    Belief belief;
    for (State t = 0; t < mdp.states(); ++t) {
      belief.clear();
      for (const State s : perturbation.ball(t)) {
        if (!environment_.terminal(s)) belief.push_back(s);
      }
      starts_.push_back(belief.empty() ? ended : intern(belief));
    }
    begin_.push_back(0);
    for (std::size_t m = 0; m < beliefs_.size(); ++m) {  // grows while it is walked
      for (Action a = 0; a < mdp.actions(); ++a) {
        expand(*beliefs_[m], a);
        begin_.push_back(answers_.size());
      }
    }
  }

  int size() const { return static_cast<int>(beliefs_.size()); }
  const Belief& belief(int m) const { return *beliefs_[static_cast<std::size_t>(m)]; }
  /// The belief after t is shown first, or `ended` where no truth behind it goes on.
  int start(State t) const { return starts_[static_cast<std::size_t>(t)]; }
  bool terminal(State s) const { return environment_.terminal(s); }

  std::span<const Answer> answers(int m, Action a) const {
    const auto row =
        static_cast<std::size_t>(m) * static_cast<std::size_t>(mdp_.actions()) + static_cast<std::size_t>(a);
    return std::span(answers_).subspan(begin_[row], begin_[row + 1] - begin_[row]);
  }

 private:
  int intern(const Belief& belief) {
    const auto [entry, is_new] = ids_.try_emplace(belief, static_cast<int>(beliefs_.size()));
    if (is_new) {
      beliefs_.push_back(&entry->first);
      if (static_cast<long>(beliefs_.size()) > max_beliefs_) {
        throw BudgetExhausted(
            fmt::format("guarantee: more than {} reachable beliefs; allow more or take a smaller "
                        "model or eps",
                        max_beliefs_));
      }
    }
    return entry->second;
  }

  /// Successors in which the episode goes on, with the least reward on the way there; and the least of what ends it.
  std::optional<Scalar> successors_of(const Belief& belief, Action a) {
    std::optional<Scalar> least_end;
    arrivals_.clear();
    for (const State s : belief) {
      const Scalar& reward = mdp_.reward(s, a);
      for (const auto& next : mdp_.successors(s, a)) {
        if (!environment_.terminal(next.target)) {
          arrivals_.emplace_back(next.target, reward);
        } else if (!least_end || reward < *least_end) {
          least_end = reward;
        }
      }
    }
    std::sort(arrivals_.begin(), arrivals_.end());
    const auto same_state = [](const auto& x, const auto& y) { return x.first == y.first; };
    arrivals_.erase(std::unique(arrivals_.begin(), arrivals_.end(), same_state), arrivals_.end());
    return least_end;
  }

  /// The largest sets, by inclusion, that an observation leaves of the arrivals.
  const std::vector<Belief>& largest_beliefs() {
    Belief predicted, shown;
    for (const auto& [state, reward] : arrivals_) {
      predicted.push_back(state);
      const auto ball = perturbation_.ball(state);
      shown.insert(shown.end(), ball.begin(), ball.end());
    }
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    candidates_.clear();
    for (const State t : shown) {
      Belief& met = candidates_.emplace_back();
      const auto ball = perturbation_.ball(t);
      std::set_intersection(predicted.begin(), predicted.end(), ball.begin(), ball.end(), std::back_inserter(met));
      if (met.size() < predicted.size()) continue;
      candidates_.assign(1, predicted);  // one observation tells nothing
      return candidates_;
    }
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const Belief& x, const Belief& y) { return x.size() > y.size(); });
    std::size_t kept = 0;
    for (std::size_t k = 0; k < candidates_.size(); ++k) {
      const Belief& small = candidates_[k];
      const bool covered = std::any_of(
          candidates_.begin(), candidates_.begin() + static_cast<long>(kept),
          [&](const Belief& large) { return std::includes(large.begin(), large.end(), small.begin(), small.end()); });
      if (covered) continue;
      if (k != kept) candidates_[kept] = std::move(candidates_[k]);
      ++kept;
    }
    candidates_.resize(kept);
    return candidates_;
  }

  void expand(const Belief& belief, Action a) {
    if (const auto least_end = successors_of(belief, a)) answers_.push_back({ended, *least_end});
    if (arrivals_.empty()) return;
    for (const Belief& next : largest_beliefs()) {
      std::optional<Scalar> least;
      for (const auto& [state, reward] : arrivals_) {
        if ((!least || reward < *least) && std::binary_search(next.begin(), next.end(), state)) least = reward;
      }
      answers_.push_back({intern(next), *least});
    }
  }

  const FiniteMdp<Scalar>& mdp_;
  const Perturbation<Scalar>& perturbation_;
  TabularEnvironment<Scalar> environment_;
  long max_beliefs_;
  std::unordered_map<Belief, int, HashOfStates> ids_;
  std::vector<const Belief*> beliefs_;  // by id, owned by the map
  std::vector<int> starts_;
  std::vector<std::size_t> begin_;  // offsets into answers_, by belief and action
  std::vector<Answer> answers_;
  std::vector<std::pair<State, Scalar>> arrivals_;
  std::vector<Belief> candidates_;
};

/// What is sure on a belief when `w` is sure of what follows. The last entry of w is the end's.
template <class Scalar>
typename GuaranteedValue<Scalar>::Choice best_choice(const BeliefGraph<Scalar>& graph, int m, Action actions,
                                                     const Scalar& discount, const Values<Scalar>& w) {
  std::optional<typename GuaranteedValue<Scalar>::Choice> best;
  for (Action a = 0; a < actions; ++a) {
    std::optional<Scalar> least;
    for (const auto& answer : graph.answers(m, a)) {
      const Scalar value = answer.reward + discount * w[answer.next == graph.ended ? graph.size() : answer.next];
      if (!least || value < *least) least = value;
    }
    if (!best || *least > best->value) best = {*least, a};
  }
  return *best;
}

template <class Scalar>
void sweep(const BeliefGraph<Scalar>& graph, const FiniteMdp<Scalar>& mdp, const Scalar& discount,
           const Values<Scalar>& w, Values<Scalar>& tw) {
  tw.resize(w.size());
  for (int m = 0; m < graph.size(); ++m) tw[m] = best_choice(graph, m, mdp.actions(), discount, w).value;
  tw[graph.size()] = discount * w[graph.size()];
}

/// Values by belief, the end's last, and what is known of them.
template <class Scalar>
struct Solved {
  Values<Scalar> w, before;  ///< `before`: from which the last sweep made w
  Scalar error;
  long sweeps;
};

template <class Scalar>
Solved<Scalar> solve_for_ever(const BeliefGraph<Scalar>& graph, const FiniteMdp<Scalar>& mdp,
                              const GuaranteeOptions& options) {
  const MacQueenBound<Scalar> bound(mdp);
  SolverOptions solver;
  solver.tolerance = options.tolerance;
  const Scalar target = std::max(bound.target(solver), bound.target({}));
  Values<Scalar> w = Values<Scalar>::Zero(graph.size() + 1), tw;
  for (long sweeps = 1; sweeps <= options.max_sweeps; ++sweeps) {
    sweep(graph, mdp, mdp.discount(), w, tw);
    const auto interval = bound(w, tw);
    if (interval.error <= target) {
      tw.array() += interval.shift;
      return {tw, tw, interval.error, sweeps};
    }
    w.swap(tw);
  }
  throw BudgetExhausted(fmt::format("guarantee: not certified after {} sweeps; allow more", options.max_sweeps));
}

/// The rounding of a sum is at most one unit of the largest partial sum for each addend.
template <class Scalar>
Solved<Scalar> solve_for_steps(const BeliefGraph<Scalar>& graph, const FiniteMdp<Scalar>& mdp, long steps) {
  Values<Scalar> w = Values<Scalar>::Zero(graph.size() + 1), tw = w;
  for (long k = 0; k < steps; ++k) {
    if (k > 0) w.swap(tw);
    sweep(graph, mdp, Scalar(1), w, tw);
  }
  const Scalar n = static_cast<Scalar>(steps);
  return {tw, w, unit_roundoff<Scalar>() * n * n * mdp.rewards().cwiseAbs().maxCoeff(), steps};
}

}  // namespace

template <class Scalar>
GuaranteedValue<Scalar> guaranteed_value(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                         const GuaranteeOptions& options) {
  if (perturbation.states() != mdp.states()) {
    throw InputError(fmt::format("balls: {} states, expected {} like the model", perturbation.states(), mdp.states()));
  }
  if (options.steps < 0) throw InputError(fmt::format("steps: {}, expected 0 or more", options.steps));
  const BeliefGraph<Scalar> graph(mdp, perturbation, options.max_beliefs);
  const auto solved =
      options.steps > 0 ? solve_for_steps(graph, mdp, options.steps) : solve_for_ever(graph, mdp, options);
  GuaranteedValue<Scalar> result;
  result.error = solved.error;
  result.sweeps = solved.sweeps;
  result.beliefs = graph.size();
  const Scalar discount = options.steps > 0 ? Scalar(1) : mdp.discount();
  for (int m = 0; m < graph.size(); ++m) {
    const Action action = best_choice(graph, m, mdp.actions(), discount, solved.before).action;
    result.choices.emplace(graph.belief(m), typename GuaranteedValue<Scalar>::Choice{solved.w[m], action});
  }
  const auto sure = [&](State t) { return graph.start(t) == graph.ended ? Scalar(0) : solved.w[graph.start(t)]; };
  result.shown.resize(mdp.states());
  result.v.resize(mdp.states());
  for (State t = 0; t < mdp.states(); ++t) result.shown[t] = sure(t);
  for (State s = 0; s < mdp.states(); ++s) {
    result.v[s] = Scalar(0);
    if (graph.terminal(s)) continue;
    const auto ball = perturbation.ball(s);
    result.v[s] = result.shown[*std::min_element(ball.begin(), ball.end(),
                                                 [&](State x, State y) { return result.shown[x] < result.shown[y]; })];
  }
  return result;
}

template <class Scalar>
BeliefPolicy guaranteed_policy(const FiniteMdp<Scalar>& mdp, GuaranteedValue<Scalar> guarantee) {
  return
      [guarantee = std::move(guarantee), environment = TabularEnvironment<Scalar>(mdp)](std::span<const State> belief) {
        Belief open;
        std::copy_if(belief.begin(), belief.end(), std::back_inserter(open),
                     [&](State s) { return !environment.terminal(s); });
        if (open.empty()) return Action(0);
        const auto entry = guarantee.choices.find(open);
        if (entry != guarantee.choices.end()) return entry->second.action;
        const typename GuaranteedValue<Scalar>::Choice* best = nullptr;
        for (const auto& [larger, choice] : guarantee.choices) {
          if (best && choice.value <= best->value) continue;
          if (std::includes(larger.begin(), larger.end(), open.begin(), open.end())) best = &choice;
        }
        return best ? best->action : Action(0);
      };
}

template GuaranteedValue<double> guaranteed_value(const FiniteMdp<double>&, const Perturbation<double>&,
                                                  const GuaranteeOptions&);
template BeliefPolicy guaranteed_policy(const FiniteMdp<double>&, GuaranteedValue<double>);

}  // namespace maximin
