#include <maximin/proofs_check/certificate/limit.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <maximin/tabular/control.hpp>
#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/exact_solve.hpp>
#include <maximin/tabular/optimal_attack.hpp>

namespace maximin {
namespace {

/// Gathers positive gaps and keeps the least.
class LeastGap {
 public:
  void observe(const Integer& gap, const Integer& denominator) {
    if (gap <= 0) return;
    const Rational value(gap, denominator);
    if (!least_ || value < *least_) least_ = value;
  }

  /// A power of two (or of a half) at most a third of the least gap; 1 where there is none.
  Rational radius() const {
    Rational r(1);
    if (!least_) return r;
    while (3 * r > *least_) r /= 2;
    return r;
  }

 private:
  std::optional<Rational> least_;
};

/// U_j(s) = R(s,c) + gamma sum_s' P(s'|s,c) U_{j-1}(s') with c = composed[j][s], for all phases at once.
std::vector<Values<Rational>> solve_orbit(const FiniteMdp<Rational>& mdp, const std::vector<Policy>& composed) {
  const auto n = static_cast<std::size_t>(mdp.states());
  const std::size_t k = composed.size();
  ExactSystem system{mdp.discount(), {}, {}};
  for (std::size_t j = 0; j < k; ++j) {
    const auto offset = static_cast<State>((j + k - 1) % k * n);
    for (State s = 0; s < mdp.states(); ++s) {
      const Action a = composed[j][static_cast<std::size_t>(s)];
      system.rewards.push_back(mdp.reward(s, a));
      auto& row = system.rows.emplace_back();
      for (const auto& next : mdp.successors(s, a)) row.push_back({offset + next.target, next.probability});
    }
  }
  const Values<Rational> all = solve_exactly(system);
  std::vector<Values<Rational>> values;
  for (std::size_t j = 0; j < k; ++j) {
    values.push_back(all.segment(static_cast<Eigen::Index>(j * n), mdp.states()));
  }
  return values;
}

/// min_{m in B(t)} q(m,a) for every action, as integers over the table's denominator.
std::vector<Integer> worst_of(const ScaledTable& q, Perturbation<Rational>::Ball ball) {
  std::vector<Integer> worst;
  for (Action a = 0; a < q.numerators.cols(); ++a) {
    Integer least = q.numerators(ball.front(), a);
    for (const State m : ball.subspan(1)) least = std::min(least, q.numerators(m, a));
    worst.push_back(std::move(least));
  }
  return worst;
}

/// The actions that tie for the best of `worst`.
std::vector<Action> best_of(const std::vector<Integer>& worst) {
  const Integer& best = *std::max_element(worst.begin(), worst.end());
  std::vector<Action> choices;
  for (std::size_t a = 0; a < worst.size(); ++a) {
    if (worst[a] == best) choices.push_back(static_cast<Action>(a));
  }
  return choices;
}

/// The positive differences that decide what is done in one phase, where ties remain ties.
void observe_gaps(const ScaledTable& q, const Values<Rational>& value, const Perturbation<Rational>& balls,
                  LeastGap& gaps) {
  std::vector<std::vector<Action>> choices;
  for (State t = 0; t < balls.states(); ++t) {
    const std::vector<Integer> worst = worst_of(q, balls.ball(t));
    choices.push_back(best_of(worst));
    const Integer& best = worst[static_cast<std::size_t>(choices.back().front())];
    for (const Integer& w : worst) gaps.observe(best - w, q.denominator);
    if (choices.back().size() == 1) continue;
    for (const Action a : choices.back()) {
      for (const State m : balls.ball(t)) gaps.observe(q.numerators(m, a) - best, q.denominator);
    }
  }
  for (State s = 0; s < balls.states(); ++s) {
    for (const State t : balls.ball(s)) {
      for (const Action a : choices[static_cast<std::size_t>(t)]) {
        const Rational gap = q(s, a) - value[s];
        gaps.observe(numerator(gap), denominator(gap));
      }
    }
  }
}

/// Finds the classes of entries that stay equal and what they leave of the choices: classes are refined, from "equal
/// now", until they reproduce themselves.
class Settling {
 public:
  Settling(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const Orbit& orbit, TieBreak tie)
      : mdp_(mdp), balls_(balls), orbit_(orbit), tie_(tie) {}

  std::optional<SettledPhases> run(const ScaledTable& q) {
    start(q);
    do {
      find_choices();
      find_equivalent_states();
    } while (refine());
    return attacks_are_settled() ? std::optional(std::move(result_)) : std::nullopt;
  }

 private:
  std::size_t phases() const { return orbit_.tables.size(); }

  /// Numbers anything by first occurrence.
  template <class Key>
  static int number(std::map<Key, int>& known, Key key) {
    const int next = static_cast<int>(known.size());
    return known.try_emplace(std::move(key), next).first->second;
  }

  void start(const ScaledTable& q) {
    std::map<std::pair<Integer, Rational>, int> known;
    result_.classes.resize(mdp_.states(), mdp_.actions());
    for (State s = 0; s < mdp_.states(); ++s) {
      for (Action a = 0; a < mdp_.actions(); ++a) {
        result_.classes(s, a) = number(known, std::pair(q.numerators(s, a), mdp_.reward(s, a)));
      }
    }
    count_ = known.size();
  }

  void find_choices() {
    result_.choices.assign(phases(), {});
    result_.provoked.assign(phases(), {});
    result_.unique.assign(phases(), true);
    for (std::size_t j = 0; j < phases(); ++j) {
      for (State t = 0; t < mdp_.states(); ++t) {
        result_.choices[j].push_back(choices_at(orbit_.tables[j], t));
        if (result_.choices[j].back().size() > 1) result_.unique[j] = false;
      }
      for (State s = 0; s < mdp_.states(); ++s) result_.provoked[j].push_back(provoked_in(j, s));
    }
  }

  /// C_j(t): of the actions that tie, one whose worst classes are among those of a later one rules that one out.
  std::vector<Action> choices_at(const ScaledTable& q, State t) const {
    const std::vector<Integer> worst = worst_of(q, balls_.ball(t));
    const std::vector<Action> tied = best_of(worst);
    if (tied.size() == 1) return tied;
    std::vector<std::set<int>> classes;
    for (const Action a : tied) {
      auto& of_a = classes.emplace_back();
      for (const State m : balls_.ball(t)) {
        if (q.numerators(m, a) == worst[static_cast<std::size_t>(a)]) of_a.insert(result_.classes(m, a));
      }
    }
    std::vector<Action> left;
    for (std::size_t b = 0; b < tied.size(); ++b) {
      bool ruled_out = false;
      for (std::size_t a = 0; a < tied.size() && !ruled_out; ++a) {
        const bool before = tie_ == TieBreak::lowest_index ? a < b : a > b;
        ruled_out = before && std::includes(classes[b].begin(), classes[b].end(), classes[a].begin(), classes[a].end());
      }
      if (!ruled_out) left.push_back(tied[b]);
    }
    return left;
  }

  /// A_j(s).
  std::vector<Action> provoked_in(std::size_t j, State s) const {
    std::set<Action> actions;
    for (const State t : balls_.ball(s)) {
      for (const Action a : result_.choices[j][static_cast<std::size_t>(t)]) {
        if (orbit_.tables[j](s, a) == orbit_.values[j][s]) actions.insert(a);
      }
    }
    return {actions.begin(), actions.end()};
  }

  bool is_settled(std::size_t j, State s) const {
    const auto ball = balls_.ball(s);
    return std::all_of(ball.begin(), ball.end(),
                       [&](State t) { return result_.choices[j][static_cast<std::size_t>(t)].size() == 1; });
  }

  void find_equivalent_states() {
    equivalent_.assign(phases(), {});
    for (std::size_t j = 0; j < phases(); ++j) {
      std::map<std::set<int>, int> known;
      for (State s = 0; s < mdp_.states(); ++s) {
        std::set<int> key{-1 - s};  // equivalent to itself alone
        if (is_settled(j, s)) {
          key.clear();
          for (const Action a : result_.provoked[j][static_cast<std::size_t>(s)]) key.insert(result_.classes(s, a));
        }
        equivalent_[j].push_back(number(known, std::move(key)));
      }
    }
  }

  /// Splits classes whose members move differently. Returns whether any was split.
  bool refine() {
    using Moves = std::map<std::pair<std::size_t, int>, Rational>;  // by phase and set of states
    std::vector<long> members(count_, 0);
    for (Eigen::Index i = 0; i < result_.classes.size(); ++i) {
      ++members[static_cast<std::size_t>(result_.classes.data()[i])];
    }
    std::map<std::pair<int, Moves>, int> known;
    QTable<int> refined(mdp_.states(), mdp_.actions());
    for (State s = 0; s < mdp_.states(); ++s) {
      for (Action a = 0; a < mdp_.actions(); ++a) {
        Moves moves;
        const int old = result_.classes(s, a);
        for (std::size_t j = 0; j < phases() && members[static_cast<std::size_t>(old)] > 1; ++j) {
          for (const auto& next : mdp_.successors(s, a)) {
            moves[{j, equivalent_[j][static_cast<std::size_t>(next.target)]}] += next.probability;
          }
        }
        refined(s, a) = number(known, std::pair(old, std::move(moves)));
      }
    }
    result_.classes = std::move(refined);
    const bool split = known.size() > count_;
    count_ = known.size();
    return split;
  }

  /// Whether every selection from the choices leaves the attacker the same best value in every state, and it is U_j(s).
  bool attacks_are_settled() const {
    for (std::size_t j = 0; j < phases(); ++j) {
      for (State s = 0; s < mdp_.states(); ++s) {
        if (!attack_is_settled(j, s)) return false;
      }
    }
    return true;
  }

  bool attack_is_settled(std::size_t j, State s) const {
    const ScaledTable& q = orbit_.tables[j];
    std::optional<Integer> lowest, highest;  // min over t of the least and of the greatest over the choices at t
    for (const State t : balls_.ball(s)) {
      const auto& at_t = result_.choices[j][static_cast<std::size_t>(t)];
      Integer low = q.numerators(s, at_t.front()), high = low;
      for (const Action a : at_t) {
        low = std::min(low, q.numerators(s, a));
        high = std::max(high, q.numerators(s, a));
      }
      if (!lowest || low < *lowest) lowest = low;
      if (!highest || high < *highest) highest = high;
    }
    return *lowest == *highest && Rational(*lowest, q.denominator) == orbit_.values[j][s];
  }

  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  const Orbit& orbit_;
  TieBreak tie_;
  SettledPhases result_;
  std::vector<std::vector<int>> equivalent_;  // by phase, the set of each state
  std::size_t count_ = 0;                     // of classes
};

/// a_j(s), the action of the policy pair in every true state, where it is known.
std::optional<Policy> action_of_pair(const Perturbation<Rational>& balls, const SettledPhases& phases, std::size_t j,
                                     TieBreak tie) {
  Policy policy;
  for (State s = 0; s < balls.states(); ++s) {
    const auto& provoked = phases.provoked[j][static_cast<std::size_t>(s)];
    if (provoked.size() == 1) {
      policy.push_back(provoked.front());
      continue;
    }
    for (const Action a : provoked) {
      if (phases.classes(s, a) != phases.classes(s, provoked.front())) return std::nullopt;
    }
    Action first = -1;
    for (const State t : balls.ball(s)) {
      const auto& at_t = phases.choices[j][static_cast<std::size_t>(t)];
      if (at_t.size() > 1) return std::nullopt;
      const bool minimises = std::find(provoked.begin(), provoked.end(), at_t.front()) != provoked.end();
      if (minimises && (first < 0 || tie == TieBreak::highest_index)) first = at_t.front();
    }
    policy.push_back(first);
  }
  return policy;
}

}  // namespace

Orbit find_orbit(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const Perturbation<Rational>& balls,
                 const std::vector<Policy>& composed) {
  Orbit orbit;
  orbit.values = solve_orbit(mdp, composed);
  LeastGap gaps;
  const std::size_t k = composed.size();
  for (std::size_t j = 0; j < k; ++j) {
    orbit.tables.push_back(scaled.backup(ScaledValues(orbit.values[(j + k - 1) % k])));
    observe_gaps(orbit.tables.back(), orbit.values[j], balls, gaps);
  }
  orbit.radius = gaps.radius();
  return orbit;
}

std::optional<SettledPhases> settle(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls,
                                    const Orbit& orbit, const ScaledTable& q, TieBreak tie) {
  return Settling(mdp, balls, orbit, tie).run(q);
}

CertifiedLimit certify_limit(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const Orbit& orbit,
                             SettledPhases phases, TieBreak tie) {
  CertifiedLimit limit;
  limit.period = orbit.period();
  limit.radius = orbit.radius;
  limit.orbit = orbit.values;
  for (std::size_t j = 0; j < orbit.tables.size(); ++j) {
    const auto provokable = internal::provokable(
        balls, [&](State t) { return std::span<const Action>(phases.choices[j][static_cast<std::size_t>(t)]); });
    const ControlProblem<Rational> attacker(mdp, ControlProblem<Rational>::Player::minimise, provokable);
    limit.low.push_back(internal::iterate_policies(attacker, SolverOptions{}).v);
    const auto policy = action_of_pair(balls, phases, j, tie);
    limit.attained.push_back(phases.unique[j] || orbit.period() == 1);
    auto& fixed = limit.fixed.emplace_back();
    if (policy) {
      fixed = internal::solve_policy_values_exactly(mdp, *policy);
    } else if (orbit.period() == 1) {
      fixed = orbit.values[j];
    }
  }
  limit.classes = std::move(phases.classes);
  return limit;
}

}  // namespace maximin
