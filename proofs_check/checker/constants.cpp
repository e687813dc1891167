#include <algorithm>

#include "sections.hpp"

namespace maximin::checker {
namespace {

/// What a constant is the largest of, but for the distance: numerators for s, t and a, over `bottom`.
struct Kind {
  const char* name;
  Integer bottom;
  std::function<Integer(std::size_t s, std::size_t t, std::size_t a)> most;                       // of s' too
  std::function<Integer(std::size_t s, std::size_t t, std::size_t a, std::size_t next)> of_next;  // where there are s'
};

Integer probability(const Model& m, std::size_t row, std::size_t next) {
  const auto below = [](const auto& entry, std::size_t state) { return entry.first < state; };
  const auto found = std::lower_bound(m.rows[row].begin(), m.rows[row].end(), next, below);
  return found == m.rows[row].end() || found->first != next ? Integer(0) : found->second;
}

/// By bounds, the difference of Q* is one that is proved, and negative where none is.
std::vector<Kind> kinds(const Model& m, const Enclosure& q_star, bool bounds) {
  const auto move = [&m](std::size_t s, std::size_t t, std::size_t a) { return row_difference(m, s, t, a).most; };
  const auto total = [&m](std::size_t s, std::size_t t, std::size_t a) { return row_difference(m, s, t, a).sum; };
  const auto move_to = [&m](std::size_t s, std::size_t t, std::size_t a, std::size_t next) {
    return Integer(abs(probability(m, m.at(s, a), next) - probability(m, m.at(t, a), next)));
  };
  const auto reward = [&m](std::size_t s, std::size_t t, std::size_t a) {
    return Integer(abs(m.rewards.top[m.at(s, a)] - m.rewards.top[m.at(t, a)]));
  };
  const auto value = [&m, &q_star, bounds](std::size_t s, std::size_t t, std::size_t a) {
    const Integer apart = q_star.low.top[m.at(s, a)] - q_star.high.top[m.at(t, a)];
    return bounds ? apart : Integer(abs(apart));
  };
  return {{"l_r", m.rewards.bottom, reward, {}},
          {"l_p", m.whole, move, move_to},
          {"k", 2 * m.whole, total, {}},
          {"l_star", q_star.low.bottom, value, {}}};
}

Rational quotient(const Kind& kind, const Integer& top, const Rational& far) {
  return Table{{top}, kind.bottom}[0] / far;
}

/// The largest quotient of each kind.
std::vector<Rational> largest_quotients(const std::string& path, const Model& m, const std::vector<Kind>& all) {
  m.spend(path, static_cast<double>(m.states) * static_cast<double>(m.entries));
  std::vector<Rational> most(all.size());
  std::vector<Integer> lengths(m.states);
  for (std::size_t s = 0; s < m.states; ++s) {
    m.metric.from(s, lengths);
    for (std::size_t t = s + 1; t < m.states; ++t) {
      if (lengths[t] < 0) continue;
      const Rational far = m.metric.far(lengths[t]);
      for (std::size_t i = 0; i < all.size(); ++i) {
        Integer top;
        for (std::size_t a = 0; a < m.actions; ++a) top = std::max(top, all[i].most(s, t, a));
        if (top == 0) continue;
        if (far == 0) {
          refuse(path + "." + all[i].name, "states " + std::to_string(s) + " and " + std::to_string(t) +
                                               " differ at distance 0, expected a model where it is finite");
        }
        most[i] = std::max(most[i], quotient(all[i], top, far));
      }
    }
  }
  return most;
}

/// What the quotient is at the place of a constant; `ordered`: the states must be s < t.
Rational at_place(const Node& at, const Model& m, const Kind& kind, bool ordered) {
  const std::vector<Node> place = at.items(kind.of_next ? 4 : 3);
  const std::size_t s = place[0].index(m.states), t = place[1].index(m.states), a = place[2].index(m.actions);
  const Integer length = m.length(s, t);
  if (ordered ? s >= t : s == t) {
    refuse(at.path(), std::string("expected states ") + (ordered ? "s < t" : "that differ"));
  }
  if (length < 0 || m.metric.far(length) == 0) refuse(at.path(), "expected a finite distance above 0");
  const Integer top = kind.of_next ? kind.of_next(s, t, a, place[3].index(m.states)) : kind.most(s, t, a);
  return quotient(kind, top, m.metric.far(length));
}

}  // namespace

Constants check_constants(const Node& node, const Model& m, const Enclosure& q_star, bool bounds) {
  node.expect_members({"l_r", "l_p", "k", "l_star", "r_min", "r_max"});
  const std::vector<Kind> all = kinds(m, q_star, bounds);
  std::vector<Rational> values;
  if (!bounds) values = largest_quotients(node.path(), m, all);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Node constant = node.member(all[i].name);
    constant.expect_members({"value", "at"});
    const Node at = constant.member("at"), value = constant.member("value");
    const Rational x = value.number();
    if (!bounds) expect_equal(value.path(), x, values[i]);
    if (x < 0) refuse(value.path(), shown(x) + ", expected a number from 0 on");
    if (at.is_null() != (x == 0)) refuse(at.path(), "expected null where the value is 0, a place elsewhere");
    if (bounds) values.push_back(x);
    if (x == 0) continue;
    const Rational found = at_place(at, m, all[i], !bounds);
    if (!bounds && found != x) refuse(at.path(), "expected a place that attains " + shown(x));
    if (x > found)
      refuse(value.path(), shown(x) + ", expected at most " + shown(found) + ", which is that of the place");
  }
  const auto [least, most] = std::minmax_element(m.rewards.top.begin(), m.rewards.top.end());
  const Table ends{{*least, *most}, m.rewards.bottom};
  const Rational r_min = node.member("r_min").number(), r_max = node.member("r_max").number();
  expect_equal(node.path() + ".r_min", r_min, ends[0]);
  expect_equal(node.path() + ".r_max", r_max, ends[1]);
  return {values[0], values[1], values[2], values[3], r_min, r_max};
}

}  // namespace maximin::checker
