#include "model.hpp"

#include <algorithm>

namespace maximin::checker {
namespace {

using Points = std::vector<std::vector<Rational>>;

Table rewards(const Node& node, const Model& m) {
  std::vector<Rational> all;
  for (const Node& row : node.items(m.states)) {
    for (const Node& reward : row.items(m.actions)) all.push_back(reward.number());
  }
  return node.table_of(all);
}

void read_transitions(const Node& node, Model& m) {
  const std::vector<Node> items = node.items();
  std::vector<Rational> probabilities;
  std::vector<Indices> places;
  for (const Node& transition : items) {
    const std::vector<Node> parts = transition.items(4);
    places.push_back({parts[0].index(m.states), parts[1].index(m.actions), parts[2].index(m.states)});
    if (places.size() > 1 && !(places[places.size() - 2] < places.back())) {
      refuse(transition.path(), "not above the one before it, expected them ascending by (s, a, s')");
    }
    probabilities.push_back(parts[3].number());
    if (probabilities.back() <= 0) refuse(parts[3].path(), shown(probabilities.back()) + ", expected a number above 0");
  }
  const Table table = node.table_of(probabilities);
  m.whole = table.bottom;
  m.rows.resize(m.states * m.actions);
  std::vector<Integer> sums(m.rows.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t row = m.at(places[i][0], places[i][1]);
    m.rows[row].emplace_back(places[i][2], table.top[i]);
    sums[row] += table.top[i];
  }
  for (std::size_t row = 0; row < sums.size(); ++row) {
    if (sums[row] == m.whole) continue;
    Rational sum(sums[row], m.whole);
    sum.canonicalize();
    refuse(node.path(), "those of state " + std::to_string(row / m.actions) + ", action " +
                            std::to_string(row % m.actions) + " sum to " + shown(sum) + ", expected 1");
  }
}

Points read_points(const Node& node, const Model& m) {
  Points points;
  for (const Node& row : node.items(m.states)) {
    if (points.empty() && row.items().empty()) refuse(row.path(), "empty, expected a coordinate at least");
    const std::vector<Node> coordinates = points.empty() ? row.items() : row.items(points[0].size());
    points.emplace_back();
    for (const Node& x : coordinates) points.back().push_back(x.number());
  }
  return points;
}

/// The distance under a norm; under l2 its square.
Rational measure(const std::vector<Rational>& x, const std::vector<Rational>& y, std::size_t norm) {
  enum { l1, l2 };
  Rational d;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Rational difference = abs(Rational(x[i] - y[i]));
    if (norm == l1) {
      d += difference;
    } else if (norm == l2) {
      d += difference * difference;
    } else if (difference > d) {
      d = difference;
    }
  }
  return d;
}

/// Sets all that rests on distances, d(s,t) under l2 being given as its square.
void set_distances(const Node& node, Model& m, std::vector<Rational> d) {
  const Rational radius = m.l2 ? Rational(m.eps * m.eps) : m.eps;
  m.balls.resize(m.states);
  m.rounded.assign(d.size(), false);
  for (std::size_t i = 0; i < d.size(); ++i) {
    if (m.finite[i] && d[i] <= radius) m.balls[i / m.states].push_back(i % m.states);
    if (!m.l2) continue;
    const Root r = root(d[i]);
    d[i] = r.low;
    m.rounded[i] = !r.exact;
  }
  m.near = node.table_of(d);
}

void expect_metric(const Node& node, const Model& m) {
  const std::size_t n = m.states;
  const auto refuse_at = [&](std::size_t s, std::size_t t, const std::string& what) {
    refuse(item(item(node.path(), s), t), what);
  };
  for (std::size_t s = 0; s < n; ++s) {
    if (!m.finite[s * n + s] || m.near.top[s * n + s] != 0) refuse_at(s, s, "not 0, expected 0 on the diagonal");
    for (std::size_t t = 0; t < n; ++t) {
      const std::size_t st = s * n + t, ts = t * n + s;
      if (m.near.top[st] < 0) refuse_at(s, t, "negative, expected a distance");
      if (m.finite[st] != m.finite[ts] || m.near.top[st] != m.near.top[ts]) {
        refuse_at(s, t,
                  "not the distance of " + std::to_string(t) + " to " + std::to_string(s) + ", expected symmetry");
      }
    }
  }
  Integer detour;
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t u = 0; u < n; ++u) {
      if (!m.finite[s * n + u]) continue;
      for (std::size_t t = 0; t < n; ++t) {
        if (!m.finite[u * n + t]) continue;
        detour = m.near.top[s * n + u] + m.near.top[u * n + t];
        if (m.finite[s * n + t] && m.near.top[s * n + t] <= detour) continue;
        refuse_at(s, t, "more than by way of state " + std::to_string(u) + ", expected the triangle inequality");
      }
    }
  }
}

void read_points_and_norm(const Node& node, Model& m) {
  const std::size_t norm = node.member("norm").one_of({"l1", "l2", "linf"});
  const Points points = read_points(node.member("points"), m);
  m.l2 = norm == 1;
  m.finite.assign(m.states * m.states, true);
  std::vector<Rational> d;
  for (const auto& x : points) {
    for (const auto& y : points) d.push_back(measure(x, y, norm));
  }
  set_distances(node.member("points"), m, std::move(d));
}

void read_matrix(const Node& node, Model& m) {
  std::vector<Rational> d;
  for (const Node& row : node.items(m.states)) {
    for (const Node& distance : row.items(m.states)) {
      m.finite.push_back(!distance.is_null());
      d.push_back(distance.is_null() ? Rational(0) : distance.number());
    }
  }
  set_distances(node, m, std::move(d));
  expect_metric(node, m);
}

}  // namespace

Rational Model::far_at(std::size_t s, std::size_t t) const {
  const Rational step(1, Integer(1) << 64U);
  return rounded[s * states + t] ? Rational(near_at(s, t) + step) : near_at(s, t);
}

Model read_model(const Node& node) {
  const bool points = node.has("points");
  std::vector<const char*> names{"format", "version", "states", "actions", "discount", "eps", "rewards", "transitions"};
  names.push_back(points ? "points" : "distances");
  if (points) names.push_back("norm");
  node.expect_members(names);
  node.member("format").one_of({"maximin-mdp"});
  node.member("version").integer(1, 1);
  Model m;
  m.most_bits = node.limits().table_bits;
  m.states = node.member("states").integer(1, node.limits().states);
  m.actions = node.member("actions").integer(1, node.limits().bytes);  // each has a reward in the file
  m.discount = node.member("discount").number();
  m.eps = node.member("eps").number();
  if (m.discount < 0 || m.discount >= 1) {
    refuse(node.path() + ".discount", shown(m.discount) + ", expected a number from 0 to below 1");
  }
  if (m.eps < 0) refuse(node.path() + ".eps", shown(m.eps) + ", expected a number from 0 on");
  m.rewards = rewards(node.member("rewards"), m);
  read_transitions(node.member("transitions"), m);
  if (points) {
    read_points_and_norm(node, m);
  } else {
    read_matrix(node.member("distances"), m);
  }
  return m;
}

std::vector<Integer> row_differences(const Model& m, std::size_t s, std::size_t t, std::size_t a) {
  std::vector<Integer> differences(m.states);
  for (const auto& [next, p] : m.rows[m.at(s, a)]) differences[next] += p;
  for (const auto& [next, p] : m.rows[m.at(t, a)]) differences[next] -= p;
  for (Integer& x : differences) x = abs(x);
  return differences;
}

Integer sum(const std::vector<Integer>& numbers) {
  Integer total;
  for (const Integer& x : numbers) total += x;
  return total;
}

Table back(const Model& m, const Table& values) {
  Table q;
  const Integer below = m.discount.get_den() * m.whole * values.bottom;
  q.bottom = lcm(below, m.rewards.bottom);
  if (bits(m.rows.size(), q.bottom) > m.most_bits) {
    refuse("$", "values over " + std::to_string(bits(1, q.bottom)) + " bits each, expected less to compute with");
  }
  const Integer of_mean = q.bottom / below * m.discount.get_num(), of_reward = q.bottom / m.rewards.bottom;
  q.top.reserve(m.rows.size());
  for (std::size_t i = 0; i < m.rows.size(); ++i) {
    Integer mean;
    for (const auto& [next, p] : m.rows[i]) mpz_addmul(mean.get_mpz_t(), p.get_mpz_t(), values.top[next].get_mpz_t());
    q.top.emplace_back(m.rewards.top[i] * of_reward + mean * of_mean);
  }
  return q;
}

Table taken(const Model& m, const Table& q, const Indices& actions) {
  Table values{{}, q.bottom};
  for (std::size_t s = 0; s < m.states; ++s) values.top.push_back(q.top[m.at(s, actions[s])]);
  return values;
}

Table best_values(const Model& m, const Table& q) {
  Table values{{}, q.bottom};
  for (std::size_t s = 0; s < m.states; ++s) {
    const auto row = q.top.begin() + static_cast<std::ptrdiff_t>(m.at(s, 0));
    values.top.push_back(*std::max_element(row, row + static_cast<std::ptrdiff_t>(m.actions)));
  }
  return values;
}

std::size_t maximin_action(const Model& m, const Table& q, const Indices& belief, bool highest) {
  std::size_t best = 0;
  const Integer* best_value = nullptr;
  for (std::size_t a = 0; a < m.actions; ++a) {
    const Integer* worst = &q.top[m.at(belief[0], a)];
    for (const std::size_t state : belief)
      worst = std::min(worst, &q.top[m.at(state, a)], [](auto x, auto y) { return *x < *y; });
    if (best_value == nullptr || *worst > *best_value || (highest && *worst == *best_value)) {
      best = a;
      best_value = worst;
    }
  }
  return best;
}

Indices maximin_policy(const Model& m, const Table& q, bool highest) {
  Indices policy;
  for (const Indices& ball : m.balls) policy.push_back(maximin_action(m, q, ball, highest));
  return policy;
}

std::size_t best_response(const Model& m, const Table& q, const Indices& policy, std::size_t s, bool highest) {
  std::size_t best = m.balls[s][0];
  for (const std::size_t t : m.balls[s]) {
    const Integer &value = q.top[m.at(s, policy[t])], &best_value = q.top[m.at(s, policy[best])];
    if (value < best_value || (highest && value == best_value)) best = t;
  }
  return best;
}

Table expect_values(const Model& m, const Table& values, const std::string& path,
                    const std::function<std::size_t(const Table& q, std::size_t s)>& action) {
  Table q = back(m, values);
  for (std::size_t s = 0; s < m.states; ++s) {
    const std::size_t i = m.at(s, action(q, s));
    if (compare(values, s, q, i) != 0) expect_equal(item(path, s), values[s], q[i]);
  }
  return q;
}

Table expect_robust_values(const Model& m, const Table& values, const Indices& policy, const std::string& path) {
  return expect_values(m, values, path,
                       [&](const Table& q, std::size_t s) { return policy[best_response(m, q, policy, s, false)]; });
}

}  // namespace maximin::checker
