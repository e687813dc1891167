#include "sections.hpp"

namespace maximin::checker {

Optimal check_optimal(const Node& node, const Model& m) {
  Table values = node.table(m.states);
  const Table q = expect_values(m, values, node.path(), [&m](const Table& table, std::size_t s) {
    std::size_t best = 0;
    for (std::size_t a = 1; a < m.actions; ++a) {
      if (table.top[m.at(s, a)] > table.top[m.at(s, best)]) best = a;
    }
    return best;
  });
  return {std::move(values), {q, q}};
}

Optimal check_optimal_by_bounds(const Node& node, const Model& m) {
  node.expect_members({"low", "high"});
  const Node low_node = node.member("low"), high_node = node.member("high");
  const Table low = low_node.table(m.states), high = high_node.table(m.states);
  const Enclosure q = enclose(m, low, high);
  expect_side(low, low_node.path(), Side::below, best_values(m, q.low));
  expect_side(high, high_node.path(), Side::above, best_values(m, q.high));
  return {high, q};
}

std::vector<Pair> check_pairs(const Node& node, const Model& m) {
  std::vector<Pair> pairs;
  for (const Node& entry : node.items()) {
    entry.expect_members({"policy", "attack", "fixed", "robust"});
    const Node fixed = entry.member("fixed"), robust = entry.member("robust");
    Pair pair;
    pair.policy = entry.member("policy").indices(m.states, m.actions);
    pair.attack = entry.member("attack").indices(m.states, m.states);
    for (const std::size_t t : pair.attack) pair.composed.push_back(pair.policy[t]);
    pair.back_of_fixed = expect_values(m, fixed.table(m.states), fixed.path(),
                                       [&pair](const Table&, std::size_t s) { return pair.composed[s]; });
    pair.back_of_robust = expect_robust_values(m, robust.table(m.states), pair.policy, robust.path());
    for (const Pair& earlier : pairs) {
      if (earlier.policy != pair.policy || earlier.attack != pair.attack) continue;
      refuse(entry.path(), "the policies of a pair before it, expected none twice");
    }
    pairs.push_back(std::move(pair));
  }
  return pairs;
}

LastRound check_rounds(const Indices& rounds, const Model& m, const std::vector<Pair>& pairs, bool highest,
                       const std::function<void(const Round&)>& visit) {
  Table values, q{std::vector<Integer>(m.rows.size()), 1};
  std::size_t met = 0;  // pairs so far
  for (std::size_t n = 0; n < rounds.size(); ++n) {
    m.spend("$.rounds", static_cast<double>(m.entries) * (1 + static_cast<double>(bits(1, q.bottom)) / 1000));
    const std::size_t i = rounds[n];
    const bool first = i == met;
    if (i > met)
      refuse(item("$.rounds", n), "a pair that skips pair " + std::to_string(met) + ", expected none to be skipped");
    if (first) ++met;
    const std::string of_round = " of the policies of round " + std::to_string(n);
    expect_equal(item("$.pairs", i) + ".policy", pairs[i].policy, maximin_policy(m, q, highest), of_round);
    Indices attack;
    for (std::size_t s = 0; s < m.states; ++s) attack.push_back(best_response(m, q, pairs[i].policy, s, highest));
    expect_equal(item("$.pairs", i) + ".attack", pairs[i].attack, attack, of_round);
    values = taken(m, q, pairs[i].composed);
    Table next = back(m, values);
    Round round{n, i, first, std::move(q), std::move(next)};
    visit(round);
    q = std::move(round.next);
  }
  if (met != pairs.size()) refuse(item("$.pairs", met), "in no round, expected only pairs that occur");
  return {values, values, q};
}

}  // namespace maximin::checker
