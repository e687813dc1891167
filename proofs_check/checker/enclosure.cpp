#include "enclosure.hpp"

#include <algorithm>

namespace maximin::checker {
namespace {

/// v(t,a) by a: the least of Q over a belief.
std::vector<Integer> least(const Model& m, const Table& q, const Indices& belief) {
  std::vector<Integer> values;
  for (std::size_t a = 0; a < m.actions; ++a) {
    const Integer* worst = &q.top[m.at(belief[0], a)];
    for (const std::size_t state : belief) {
      if (q.top[m.at(state, a)] < *worst) worst = &q.top[m.at(state, a)];
    }
    values.push_back(*worst);
  }
  return values;
}

void expect_in_order(int sign, Side side, const std::string& path, const Rational& value, const Rational& end) {
  if (side == Side::below ? sign <= 0 : sign >= 0) return;
  refuse(path, shown(value) + ", expected at " + (side == Side::below ? "most " : "least ") + shown(end));
}

}  // namespace

Enclosure enclose(const Model& m, const Table& low, const Table& high) {
  Enclosure q{back(m, low), back(m, high)};
  align(q.low, q.high);
  return q;
}

Indices candidates(const Model& m, const Enclosure& q, const Indices& belief, bool highest) {
  const std::vector<Integer> low = least(m, q.low, belief), high = least(m, q.high, belief);
  // Who has the greatest v-, and comes first among those, beats all others that anyone beats.
  std::size_t first = 0;
  for (std::size_t a = 1; a < m.actions; ++a) {
    if (highest ? low[a] >= low[first] : low[a] > low[first]) first = a;
  }
  Indices found;
  for (std::size_t b = 0; b < m.actions; ++b) {
    const bool before = highest ? first > b : first < b;
    if (low[first] < high[b] || (low[first] == high[b] && !before)) found.push_back(b);
  }
  return found;
}

Choices choices(const Model& m, const Enclosure& q, bool highest) {
  Choices result;
  for (const Indices& ball : m.balls) result.candidates.push_back(candidates(m, q, ball, highest));
  result.low.bottom = result.high.bottom = q.low.bottom;
  for (std::size_t s = 0; s < m.states; ++s) {
    const auto high = [&](std::size_t a) -> const Integer& { return q.high.top[m.at(s, a)]; };
    const auto less = [&](std::size_t a, std::size_t b) { return high(a) < high(b); };
    std::vector<bool> possible(m.actions);
    const Integer* worst = nullptr;
    for (const std::size_t t : m.balls[s]) {
      const Indices& of_t = result.candidates[t];
      for (const std::size_t a : of_t) possible[a] = true;
      const Integer& greatest = high(*std::max_element(of_t.begin(), of_t.end(), less));
      if (worst == nullptr || greatest < *worst) worst = &greatest;
    }
    result.high.top.push_back(*worst);
    result.possible.emplace_back();
    for (std::size_t a = 0; a < m.actions; ++a) {
      if (!possible[a]) continue;
      const Integer& low = q.low.top[m.at(s, a)];
      if (result.possible[s].empty()) result.low.top.push_back(low);
      result.possible[s].push_back(a);
      if (low < result.low.top[s]) result.low.top[s] = low;
    }
  }
  return result;
}

std::vector<Indices> provoked(const Model& m, const Enclosure& q, const Choices& choices, const Table& most) {
  std::vector<Indices> result(m.states);
  for (std::size_t s = 0; s < m.states; ++s) {
    for (const std::size_t a : choices.possible[s]) {
      if (compare(q.low, m.at(s, a), most, s) <= 0) result[s].push_back(a);
    }
  }
  return result;
}

Table expect_side(const Model& m, const Table& values, const std::string& path, Side side,
                  const std::vector<Indices>& sets) {
  Table q = back(m, values);
  for (std::size_t s = 0; s < m.states; ++s) {
    for (const std::size_t a : sets[s]) {
      const std::size_t i = m.at(s, a);
      const int sign = compare(values, s, q, i);
      if (sign != 0) expect_in_order(sign, side, item(path, s), values[s], q[i]);
    }
  }
  return q;
}

void expect_side(const Table& values, const std::string& path, Side side, const Table& others) {
  for (std::size_t s = 0; s < values.size(); ++s) {
    const int sign = compare(values, s, others, s);
    if (sign != 0) expect_in_order(sign, side, item(path, s), values[s], others[s]);
  }
}

}  // namespace maximin::checker
