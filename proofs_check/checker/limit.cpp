#include <algorithm>
#include <map>
#include <set>

#include "sections.hpp"

namespace maximin::checker {
namespace {

using Set = std::set<std::size_t>;

/// One phase j of the limit, under the names of the format. Numbers are numerators of Q^j.
class PhaseCheck {
 public:
  PhaseCheck(const Model& m, const Table& q, const Rational& radius, const Indices& classes, bool highest)
      : m_(m), q_(q), two_r_(2 * radius), classes_(classes), highest_(highest) {
    for (std::size_t t = 0; t < m_.states; ++t) candidates_.push_back(candidates(t));
  }

  /// Whether every C_j(t) has one member.
  bool all_settled() const { return std::all_of(candidates_.begin(), candidates_.end(), is_one); }

  /// Conditions 1 and 2, for U_j read at that path; makes A_j.
  void expect_orbit(const Table& values, const std::string& path) {
    for (std::size_t s = 0; s < m_.states; ++s) {
      Table ends{{}, q_.bottom};  // the least over the ball of the least and of the greatest candidate
      for (const std::size_t t : m_.balls[s]) {
        const auto less = [&](std::size_t a, std::size_t b) { return q(s, a) < q(s, b); };
        const auto [least, greatest] = std::minmax_element(candidates_[t].begin(), candidates_[t].end(), less);
        if (ends.size() == 0) ends.top = {q(s, *least), q(s, *greatest)};
        ends.top = {std::min(ends.top[0], q(s, *least)), std::min(ends.top[1], q(s, *greatest))};
      }
      for (std::size_t end = 0; end < 2; ++end) {
        if (compare(values, s, ends, end) == 0) continue;
        refuse(item(path, s), shown(values[s]) + ", expected " + shown(ends[end]) +
                                  ", the least over the ball of the " + (end == 0 ? "least" : "greatest") +
                                  " candidate");
      }
      attaining_.emplace_back();
      for (const std::size_t t : m_.balls[s]) {
        for (const std::size_t a : candidates_[t]) {
          const Integer above = q(s, a) - ends.top[0];
          if (above == 0) attaining_[s].insert(a);
          if (above <= 0 || !within_two_r(above)) continue;
          refuse(item(path, s), "action " + std::to_string(a) + ", shown state " + std::to_string(t) +
                                    ", is above it by 2 radius or less, expected more or nothing");
        }
      }
    }
  }

  /// Of condition 4, that a class moves as one among equivalent states.
  void expect_classes(const std::string& path) const {
    std::map<Set, std::size_t> kinds;
    Indices kind;  // of a state: a settled one is what it attains, any other is itself
    for (std::size_t s = 0; s < m_.states; ++s) {
      const std::size_t own = m_.states + s;
      kind.push_back(settled(s) ? kinds.emplace(attained_classes(s), kinds.size()).first->second : own);
    }
    std::map<std::size_t, std::map<std::size_t, Integer>> moves;  // by class: the probability of each kind
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      std::map<std::size_t, Integer> move;
      for (const auto& [next, p] : m_.rows[i]) move[kind[next]] += p;
      if (moves.emplace(classes_[i], move).first->second == move) continue;
      refuse(item(item(path, i / m_.actions), i % m_.actions),
             "an entry that moves unlike the first of its class, expected one probability of each set of equivalents");
    }
  }

  /// a_j, where it is known in every state.
  std::optional<Indices> provoked() const {
    Indices actions;
    for (std::size_t s = 0; s < m_.states; ++s) {
      if (attaining_[s].size() > 1 && !(settled(s) && attained_classes(s).size() == 1)) return {};
      Indices ball = m_.balls[s];
      if (highest_) std::reverse(ball.begin(), ball.end());
      const auto attains = [&](std::size_t t) { return attaining_[s].count(candidates_[t][0]) > 0; };
      actions.push_back(attaining_[s].size() == 1 ? *attaining_[s].begin()
                                                  : candidates_[*std::find_if(ball.begin(), ball.end(), attains)][0]);
    }
    return actions;
  }

  /// V_j, read at that path. Returns back(V_j).
  Table expect_low(const Table& values, const std::string& path) const {
    return expect_values(m_, values, path, [&](const Table& table, std::size_t s) {
      std::size_t worst = candidates_[s][0];
      for (const std::size_t t : m_.balls[s]) {
        for (const std::size_t a : candidates_[t]) {
          if (table.top[m_.at(s, a)] < table.top[m_.at(s, worst)]) worst = a;
        }
      }
      return worst;
    });
  }

 private:
  static bool is_one(const Indices& candidates) { return candidates.size() == 1; }

  const Integer& q(std::size_t s, std::size_t a) const { return q_.top[m_.at(s, a)]; }
  bool within_two_r(const Integer& x) const { return x * two_r_.get_den() <= two_r_.get_num() * q_.bottom; }

  /// C_j(t).
  Indices candidates(std::size_t t) const {
    std::vector<Integer> v;
    std::vector<Set> least_classes;  // M_j(t,a)
    for (std::size_t a = 0; a < m_.actions; ++a) {
      v.push_back(q(t, a));
      for (const std::size_t state : m_.balls[t]) v[a] = std::min(v[a], q(state, a));
      least_classes.emplace_back();
      for (const std::size_t state : m_.balls[t]) {
        if (within_two_r(q(state, a) - v[a])) least_classes[a].insert(classes_[m_.at(state, a)]);
      }
    }
    const Integer best = *std::max_element(v.begin(), v.end());
    const auto near = [&](std::size_t a) { return within_two_r(best - v[a]); };
    Indices found;
    for (std::size_t b = 0; b < m_.actions; ++b) {
      bool beaten = !near(b);
      for (std::size_t a = 0; a < m_.actions; ++a) {
        const bool before = highest_ ? a > b : a < b;
        beaten = beaten || (before && near(a) &&
                            std::includes(least_classes[b].begin(), least_classes[b].end(), least_classes[a].begin(),
                                          least_classes[a].end()));
      }
      if (!beaten) found.push_back(b);
    }
    return found;
  }

  bool settled(std::size_t s) const {
    return std::all_of(m_.balls[s].begin(), m_.balls[s].end(), [&](std::size_t t) { return is_one(candidates_[t]); });
  }

  /// { class of (s,a) : a in A_j(s) }.
  Set attained_classes(std::size_t s) const {
    Set found;
    for (const std::size_t a : attaining_[s]) found.insert(classes_[m_.at(s, a)]);
    return found;
  }

  const Model& m_;
  const Table& q_;
  Rational two_r_;
  const Indices& classes_;
  bool highest_;
  std::vector<Indices> candidates_;
  std::vector<Set> attaining_;  // A_j
};

/// `orbit` is U_0 where k = 1, and null elsewhere.
std::optional<Table> check_fixed(const Node& node, const Model& m, const std::optional<Indices>& actions,
                                 const Table* orbit) {
  if (node.is_null() != (!actions && orbit == nullptr)) {
    refuse(node.path(), node.is_null() ? "null, expected the values of the pair, which are known"
                                       : "values, expected null where several actions attain a value of the orbit");
  }
  if (node.is_null()) return {};
  const Table values = node.table(m.states);
  if (actions) {
    return expect_values(m, values, node.path(), [&](const Table&, std::size_t s) { return (*actions)[s]; });
  }
  for (std::size_t s = 0; s < m.states; ++s) expect_equal(item(node.path(), s), values[s], (*orbit)[s]);
  return back(m, values);
}

/// Of condition 4, what does not depend on the phase. Returns the classes by (s,a).
Indices read_classes(const Node& node, const Model& m, const Table& last) {
  Indices classes, first;  // first: the first entry of each class
  for (const Node& row : node.items(m.states)) {
    for (const Node& entry : row.items(m.actions)) {
      const std::size_t i = classes.size(), number = entry.integer(0, first.size());
      if (number == first.size()) first.push_back(i);
      if (last.top[i] != last.top[first[number]] || m.rewards.top[i] != m.rewards.top[first[number]]) {
        refuse(entry.path(), "unlike the first of its class in Q_N or in reward, expected both to be equal");
      }
      classes.push_back(number);
    }
  }
  return classes;
}

}  // namespace

Limit check_limit(const Node& node, const Model& m, const Table& last, bool highest) {
  node.expect_members({"period", "radius", "classes", "orbit", "low", "fixed"});
  const std::vector<Node> orbit = node.member("orbit").items();
  const std::size_t period = orbit.size();
  if (period == 0) refuse(node.path() + ".orbit", "empty, expected a phase at least");
  node.member("period").integer(period, period);
  const std::vector<Node> low = node.member("low").items(period), fixed = node.member("fixed").items(period);
  const Node classes_node = node.member("classes"), radius_node = node.member("radius");
  const Indices classes = read_classes(classes_node, m, last);
  const Rational radius = radius_node.number();
  if (radius <= 0) refuse(radius_node.path(), shown(radius) + ", expected a number above 0");
  std::vector<Table> values;  // U_j
  for (const Node& phase : orbit) values.push_back(phase.table(m.states));
  Limit limit;
  for (std::size_t j = 0; j < period; ++j) {
    Phase phase;
    phase.q = back(m, values[(j + period - 1) % period]);
    if (j == 0) {
      const Table distance = absolute(difference(last, phase.q));
      limit.delta = distance[largest(distance)];
      if (limit.delta > radius) {  // condition 3
        refuse(radius_node.path(),
               shown(radius) + ", expected at least " + shown(limit.delta) + ", between Q_N and Q^0");
      }
    }
    PhaseCheck check(m, phase.q, radius, classes, highest);
    check.expect_orbit(values[j], orbit[j].path());
    check.expect_classes(classes_node.path());
    phase.attained = period == 1 || check.all_settled();
    phase.back_of_low = check.expect_low(low[j].table(m.states), low[j].path());
    phase.back_of_fixed = check_fixed(fixed[j], m, check.provoked(), period == 1 ? &values[j] : nullptr);
    limit.phases.push_back(std::move(phase));
  }
  return limit;
}

}  // namespace maximin::checker
