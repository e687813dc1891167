#include <algorithm>

#include "sections.hpp"

namespace maximin::checker {
namespace {

/// What a constant is the largest of, but for the distance: numerators for s, t and a, one for each s' or a single one.
using Numerators = std::function<std::vector<Integer>(std::size_t s, std::size_t t, std::size_t a)>;

Numerators differences(const Model& m, const Table& table) {
  return [&m, &table](std::size_t s, std::size_t t, std::size_t a) -> std::vector<Integer> {
    return {abs(Integer(table.top[m.at(s, a)] - table.top[m.at(t, a)]))};
  };
}

/// One constant and its witness, `bottom` being the denominator of the numerators.
Rational check_constant(const Node& node, const Model& m, const Integer& bottom, const Numerators& numerators) {
  node.expect_members({"value", "at"});
  const auto quotient = [&](const Integer& top, std::size_t s, std::size_t t) {
    return Rational(Table{{top}, bottom}[0] / m.far_at(s, t));
  };
  Rational most;
  for (std::size_t s = 0; s < m.states; ++s) {
    for (std::size_t t = s + 1; t < m.states; ++t) {
      if (!m.finite[s * m.states + t]) continue;
      Integer top;
      for (std::size_t a = 0; a < m.actions; ++a) {
        for (const Integer& x : numerators(s, t, a)) top = std::max(top, x);
      }
      if (top == 0) continue;
      if (m.far_at(s, t) == 0) {
        refuse(node.path(), "states " + std::to_string(s) + " and " + std::to_string(t) +
                                " differ at distance 0, expected a model where the constants are finite");
      }
      most = std::max(most, quotient(top, s, t));
    }
  }
  const Node at = node.member("at");
  expect_equal(node.path() + ".value", node.member("value").number(), most);
  if (at.is_null() != (most == 0)) refuse(at.path(), "expected null where the value is 0, a place elsewhere");
  if (most == 0) return most;
  const bool of_row = numerators(0, 0, 0).size() > 1;
  const std::vector<Node> place = at.items(of_row ? 4 : 3);
  const std::size_t s = place[0].index(m.states), t = place[1].index(m.states), a = place[2].index(m.actions);
  if (s >= t || !m.finite[s * m.states + t]) refuse(at.path(), "expected states s < t at a finite distance");
  const Integer top = numerators(s, t, a)[of_row ? place[3].index(m.states) : 0];
  if (top == 0 || quotient(top, s, t) != most) refuse(at.path(), "expected a place that attains " + shown(most));
  return most;
}

}  // namespace

Constants check_constants(const Node& node, const Model& m, const Table& q_star) {
  node.expect_members({"l_r", "l_p", "k", "l_star", "r_min", "r_max"});
  const auto row = [&m](std::size_t s, std::size_t t, std::size_t a) { return row_differences(m, s, t, a); };
  const auto sum_of_row = [&m](std::size_t s, std::size_t t, std::size_t a) -> std::vector<Integer> {
    return {sum(row_differences(m, s, t, a))};
  };
  Constants c;
  c.l_r = check_constant(node.member("l_r"), m, m.rewards.bottom, differences(m, m.rewards));
  c.l_p = check_constant(node.member("l_p"), m, m.whole, row);
  c.k = check_constant(node.member("k"), m, 2 * m.whole, sum_of_row);
  c.l_star = check_constant(node.member("l_star"), m, q_star.bottom, differences(m, q_star));
  const auto [least, most] = std::minmax_element(m.rewards.top.begin(), m.rewards.top.end());
  const Table ends{{*least, *most}, m.rewards.bottom};
  c.r_min = node.member("r_min").number();
  c.r_max = node.member("r_max").number();
  expect_equal(node.path() + ".r_min", c.r_min, ends[0]);
  expect_equal(node.path() + ".r_max", c.r_max, ends[1]);
  return c;
}

}  // namespace maximin::checker
