#include "model.hpp"

#include <algorithm>

namespace maximin::checker {
namespace {

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
  m.entries = places.size();
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

}  // namespace

Integer Model::length(std::size_t s, std::size_t t) const {
  std::vector<Integer> lengths(states);
  metric.from(s, lengths);
  return lengths[t];
}

void Model::spend(const std::string& path, double steps) const {
  work_left -= steps;
  if (work_left < 0) refuse(path, "more work than this checker takes on, expected a smaller model or fewer claims");
}

Model read_model(const Node& node, std::size_t most_states) {
  std::vector<const char*> names{"format", "version", "states", "actions", "discount", "eps", "rewards", "transitions"};
  if (node.has("points")) {
    names.insert(names.end(), {"points", "norm"});
  } else {
    names.push_back(node.has("metric") ? "metric" : "distances");
  }
  node.expect_members(names);
  node.member("format").one_of({"maximin-mdp"});
  node.member("version").integer(1, 1);
  Model m;
  m.most_bits = node.limits().table_bits;
  m.work_left = node.limits().work;
  m.states = node.member("states").integer(1, most_states);
  m.actions = node.member("actions").integer(1, node.limits().bytes);  // each has a reward in the file
  m.discount = node.member("discount").number();
  m.eps = node.member("eps").number();
  if (m.discount < 0 || m.discount >= 1) {
    refuse(node.path() + ".discount", shown(m.discount) + ", expected a number from 0 to below 1");
  }
  if (m.eps < 0) refuse(node.path() + ".eps", shown(m.eps) + ", expected a number from 0 on");
  m.rewards = rewards(node.member("rewards"), m);
  read_transitions(node.member("transitions"), m);
  read_metric(node, m);
  return m;
}

RowDifference row_difference(const Model& m, std::size_t s, std::size_t t, std::size_t a) {
  const auto &x = m.rows[m.at(s, a)], &y = m.rows[m.at(t, a)];
  RowDifference result;
  Integer size;
  for (auto i = x.begin(), j = y.begin(); i != x.end() || j != y.end();) {
    if (j == y.end() || (i != x.end() && i->first < j->first)) {
      size = (i++)->second;
    } else if (i == x.end() || j->first < i->first) {
      size = (j++)->second;
    } else {
      size = (i++)->second - (j++)->second;
    }
    size = abs(size);
    result.sum += size;
    if (size > result.most) result.most = size;
  }
  return result;
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

Table back_without_rewards(const Model& m, const Table& values) {
  return difference(back(m, values), m.rewards);
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
