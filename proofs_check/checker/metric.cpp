#include <algorithm>

#include "model.hpp"

namespace maximin::checker {
namespace {

constexpr unsigned root_bits = 64;  // of d-, after the point

void set_points(const Node& node, const Node& norm_node, Model& m) {
  enum { l1, l2 };
  const std::size_t norm = norm_node.one_of({"l1", "l2", "linf"});
  std::vector<Rational> coordinates;
  std::size_t length = 0;
  for (const Node& row : node.items(m.states)) {
    if (length == 0) length = row.items().size();
    if (length == 0) refuse(row.path(), "empty, expected a coordinate at least");
    for (const Node& x : row.items(length)) coordinates.push_back(x.number());
  }
  Table table = node.table_of(coordinates);
  m.metric.l2 = norm == l2;
  m.metric.unit = norm == l2 ? Integer(table.bottom * table.bottom) : table.bottom;
  m.spend(node.path(), static_cast<double>(coordinates.size()) * static_cast<double>(m.states));
  m.metric.from = [norm, length, points = std::move(table.top)](std::size_t s, std::vector<Integer>& lengths) {
    Integer apart;
    for (std::size_t t = 0; t < lengths.size(); ++t) {
      lengths[t] = 0;
      for (std::size_t i = 0; i < length; ++i) {
        apart = points[s * length + i] - points[t * length + i];
        apart = abs(apart);
        if (norm == l1) {
          lengths[t] += apart;
        } else if (norm == l2) {
          lengths[t] += apart * apart;
        } else if (apart > lengths[t]) {
          lengths[t] = apart;
        }
      }
    }
  };
}

void expect_metric(const Node& node, const Model& m, const std::vector<Integer>& d) {
  const std::size_t n = m.states;
  const auto refuse_at = [&](std::size_t s, std::size_t t, const std::string& what) {
    refuse(item(item(node.path(), s), t), what);
  };
  for (std::size_t s = 0; s < n; ++s) {
    if (d[s * n + s] != 0) refuse_at(s, s, "not 0, expected 0 on the diagonal");
    for (std::size_t t = 0; t < n; ++t) {
      if (d[s * n + t] == d[t * n + s]) continue;
      refuse_at(s, t, "not the distance of " + std::to_string(t) + " to " + std::to_string(s) + ", expected symmetry");
    }
  }
  m.spend(node.path(), static_cast<double>(n) * static_cast<double>(n) * static_cast<double>(n));
  Integer detour;
  for (std::size_t s = 0; s < n; ++s) {
    for (std::size_t u = 0; u < n; ++u) {
      if (d[s * n + u] < 0) continue;
      for (std::size_t t = 0; t < n; ++t) {
        if (d[u * n + t] < 0) continue;
        detour = d[s * n + u] + d[u * n + t];
        if (d[s * n + t] >= 0 && d[s * n + t] <= detour) continue;
        refuse_at(s, t, "more than by way of state " + std::to_string(u) + ", expected the triangle inequality");
      }
    }
  }
}

void set_matrix(const Node& node, Model& m) {
  std::vector<Rational> d;
  std::vector<std::size_t> infinite;
  for (const Node& row : node.items(m.states)) {
    for (const Node& distance : row.items(m.states)) {
      if (distance.is_null()) infinite.push_back(d.size());
      d.push_back(distance.is_null() ? Rational(0) : distance.number());
      if (d.back() < 0) refuse(distance.path(), "negative, expected a distance");
    }
  }
  Table table = node.table_of(d);
  for (const std::size_t i : infinite) table.top[i] = -1;
  expect_metric(node, m, table.top);
  m.metric.unit = table.bottom;
  m.metric.from = [all = std::move(table.top)](std::size_t s, std::vector<Integer>& lengths) {
    for (std::size_t t = 0; t < lengths.size(); ++t) lengths[t] = all[s * lengths.size() + t];
  };
}

/// The fewest steps, one of them joining two states where an action takes one to the other.
void set_hops(const Node& node, Model& m) {
  std::vector<Indices> neighbours(m.states);
  for (std::size_t row = 0; row < m.rows.size(); ++row) {
    for (const auto& [next, p] : m.rows[row]) {
      neighbours[row / m.actions].push_back(next);
      neighbours[next].push_back(row / m.actions);
    }
  }
  std::size_t joined = 0;
  for (Indices& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    joined += list.size();
  }
  m.spend(node.path(), static_cast<double>(joined) * static_cast<double>(m.states));
  m.metric.from = [neighbours = std::move(neighbours)](std::size_t s, std::vector<Integer>& lengths) {
    std::fill(lengths.begin(), lengths.end(), -1);
    lengths[s] = 0;
    Indices met{s};
    for (std::size_t i = 0; i < met.size(); ++i) {
      for (const std::size_t t : neighbours[met[i]]) {
        if (lengths[t] >= 0) continue;
        lengths[t] = lengths[met[i]] + 1;
        met.push_back(t);
      }
    }
  };
}

void set_balls(const Node& node, Model& m) {
  const Integer reach = m.metric.reach(m.eps);
  std::vector<Integer> lengths(m.states);
  std::size_t members = 0;
  for (std::size_t s = 0; s < m.states; ++s) {
    m.metric.from(s, lengths);
    m.balls.emplace_back();
    for (std::size_t t = 0; t < m.states; ++t) {
      if (lengths[t] < 0) continue;
      m.has_pairs = m.has_pairs || s != t;
      if (lengths[t] <= reach) m.balls[s].push_back(t);
    }
    members += m.balls[s].size();
    if (members > m.most_bits / 64) refuse(node.path() + ".eps", "balls that take too much memory, expected smaller");
  }
  m.entries += members * m.actions;
}

}  // namespace

Rational Metric::near(const Integer& length) const {
  const Rational d = Table{{length}, unit}[0];
  return l2 ? root(d).low : d;
}

Rational Metric::far(const Integer& length) const {
  const Rational d = Table{{length}, unit}[0];
  if (!l2) return d;
  const Root r = root(d);
  return r.exact ? r.low : Rational(r.low + Rational(1, Integer(1) << root_bits));
}

Integer Metric::reach(const Rational& distance) const {
  const Rational scaled = (l2 ? Rational(distance * distance) : distance) * unit;
  return scaled.get_num() / scaled.get_den();
}

void read_metric(const Node& node, Model& m) {
  if (node.has("points")) {
    set_points(node.member("points"), node.member("norm"), m);
  } else if (node.has("distances")) {
    set_matrix(node.member("distances"), m);
  } else if (node.member("metric").one_of({"hops", "discrete"}) == 0) {
    set_hops(node.member("metric"), m);
  } else {
    m.metric.from = [](std::size_t s, std::vector<Integer>& lengths) {
      std::fill(lengths.begin(), lengths.end(), 1);
      lengths[s] = 0;
    };
  }
  set_balls(node, m);
}

}  // namespace maximin::checker
