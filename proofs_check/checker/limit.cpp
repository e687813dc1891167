#include <algorithm>
#include <set>

#include "sections.hpp"

namespace maximin::checker {
namespace {

/// One phase: U_j and Q^j with the conditions that the format numbers 1 to 3. Numbers are numerators of Q^j.
class Conditions {
 public:
  Conditions(const Model& m, const Table& q, const Rational& radius, std::string path)
      : m_(m), q_(q), two_r_(2 * radius), path_(std::move(path)) {}

  /// Condition 1. Returns C_j(t).
  Indices candidates(std::size_t t) const {
    std::vector<Integer> v;
    for (std::size_t a = 0; a < m_.actions; ++a) {
      v.push_back(q_.top[m_.at(t, a)]);
      for (const std::size_t state : m_.balls[t]) v[a] = std::min(v[a], q_.top[m_.at(state, a)]);
    }
    const Integer best = *std::max_element(v.begin(), v.end());
    Indices found;
    for (std::size_t a = 0; a < m_.actions; ++a) {
      if (!within_two_r(best - v[a])) continue;
      if (v[a] != best) {
        refuse(path_, "at state " + std::to_string(t) + ", action " + std::to_string(a) +
                          " is a candidate with a value of its own, expected equal values or a smaller radius");
      }
      found.push_back(a);
    }
    return found;
  }

  /// Conditions 2 and 3. Returns { a in C_j(t), t in B(s) : Q^j(s,a) = U_j(s) }.
  std::set<std::size_t> attaining(const std::vector<Indices>& candidates, const Table& values, std::size_t s) const {
    const auto q = [&](std::size_t a) -> const Integer& { return q_.top[m_.at(s, a)]; };
    Table ends{{}, q_.bottom};  // the least over the ball of the least and of the greatest candidate
    for (const std::size_t t : m_.balls[s]) {
      const auto [least, greatest] = std::minmax_element(candidates[t].begin(), candidates[t].end(),
                                                         [&](std::size_t a, std::size_t b) { return q(a) < q(b); });
      if (ends.size() == 0) ends.top = {q(*least), q(*greatest)};
      ends.top = {std::min(ends.top[0], q(*least)), std::min(ends.top[1], q(*greatest))};
    }
    for (std::size_t end = 0; end < 2; ++end) {
      if (compare(values, s, ends, end) == 0) continue;
      refuse(item(path_, s), shown(values[s]) + ", expected " + shown(ends[end]) + ", the least over the ball of the " +
                                 (end == 0 ? "least" : "greatest") + " candidate");
    }
    std::set<std::size_t> found;
    for (const std::size_t t : m_.balls[s]) {
      for (const std::size_t a : candidates[t]) {
        const Integer above = q(a) - ends.top[0];
        if (above == 0) found.insert(a);
        if (above <= 0 || !within_two_r(above)) continue;
        refuse(item(path_, s), "action " + std::to_string(a) + ", shown state " + std::to_string(t) +
                                   ", is above it by 2 radius or less, expected more or nothing");
      }
    }
    return found;
  }

 private:
  bool within_two_r(const Integer& x) const { return x * two_r_.get_den() <= two_r_.get_num() * q_.bottom; }

  const Model& m_;
  const Table& q_;
  Rational two_r_;
  std::string path_;
};

/// V(s) = min_{t in B(s)} min_{a in C(t)} back(V)(s,a). Returns back(V).
Table expect_low_values(const Model& m, const Table& values, const std::vector<Indices>& candidates,
                        const std::string& path) {
  return expect_values(m, values, path, [&](const Table& q, std::size_t s) {
    std::size_t worst = candidates[s][0];
    for (const std::size_t t : m.balls[s]) {
      for (const std::size_t a : candidates[t]) {
        if (q.top[m.at(s, a)] < q.top[m.at(s, worst)]) worst = a;
      }
    }
    return worst;
  });
}

/// `orbit` is U_j where k = 1, and null elsewhere.
std::optional<Table> check_fixed(const Node& node, const Model& m, const std::vector<std::set<std::size_t>>& attaining,
                                 const Table* orbit) {
  const bool one = std::all_of(attaining.begin(), attaining.end(), [](const auto& set) { return set.size() == 1; });
  if (node.is_null() != (!one && orbit == nullptr)) {
    refuse(node.path(), node.is_null() ? "null, expected the values of the pair, which are known"
                                       : "values, expected null where several actions attain a value of the orbit");
  }
  if (node.is_null()) return {};
  const Table values = node.table(m.states);
  if (one) {
    return expect_values(m, values, node.path(), [&](const Table&, std::size_t s) { return *attaining[s].begin(); });
  }
  for (std::size_t s = 0; s < m.states; ++s) expect_equal(item(node.path(), s), values[s], (*orbit)[s]);
  return back(m, values);
}

/// Condition 4.
void expect_near(const Table& last, const Table& q, const Rational& radius, const std::string& path, const Model& m) {
  const Table distance = absolute(difference(last, q));
  const std::size_t i = largest(distance);
  if (distance[i] <= radius) return;
  refuse(path, shown(radius) + ", expected at least " + shown(distance[i]) + ", how far Q_N is from Q^0 at state " +
                   std::to_string(i / m.actions) + ", action " + std::to_string(i % m.actions));
}

}  // namespace

Limit check_limit(const Node& node, const Model& m, const Table& last) {
  node.expect_members({"period", "radius", "orbit", "low", "fixed"});
  const std::vector<Node> orbit = node.member("orbit").items();
  const std::size_t period = orbit.size();
  if (period == 0) refuse(node.path() + ".orbit", "empty, expected a phase at least");
  node.member("period").integer(period, period);
  const std::vector<Node> low = node.member("low").items(period), fixed = node.member("fixed").items(period);
  Limit limit;
  limit.radius = node.member("radius").number();
  if (limit.radius <= 0) refuse(node.path() + ".radius", shown(limit.radius) + ", expected a number above 0");
  std::vector<Table> values;  // U_j
  for (const Node& phase : orbit) values.push_back(phase.table(m.states));
  for (std::size_t j = 0; j < period; ++j) {
    Phase phase;
    phase.q = back(m, values[(j + period - 1) % period]);
    if (j == 0) expect_near(last, phase.q, limit.radius, node.path() + ".radius", m);
    const Conditions conditions(m, phase.q, limit.radius, orbit[j].path());
    std::vector<Indices> candidates;
    for (std::size_t t = 0; t < m.states; ++t) candidates.push_back(conditions.candidates(t));
    std::vector<std::set<std::size_t>> attaining;
    for (std::size_t s = 0; s < m.states; ++s) attaining.push_back(conditions.attaining(candidates, values[j], s));
    phase.settled = std::all_of(candidates.begin(), candidates.end(), [](const auto& c) { return c.size() == 1; });
    phase.back_of_low = expect_low_values(m, low[j].table(m.states), candidates, low[j].path());
    phase.back_of_fixed = check_fixed(fixed[j], m, attaining, period == 1 ? &values[j] : nullptr);
    limit.phases.push_back(std::move(phase));
  }
  return limit;
}

}  // namespace maximin::checker
