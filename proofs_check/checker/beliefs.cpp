#include <algorithm>
#include <iterator>
#include <map>
#include <set>

#include "sections.hpp"

namespace maximin::checker {
namespace {

using Position = std::pair<std::size_t, Indices>;  // the true state and the belief

/// The belief game of one model: its positions as they were listed, looked up by what leads to them.
class Game {
 public:
  Game(const Model& m, const Enclosure& q_star, bool highest, const Node& node) : m_(m), path_(node.path()) {
    for (const Node& entry : node.items()) {
      const std::vector<Node> parts = entry.items(2);
      Position position{parts[0].index(m.states), {}};
      for (const Node& member : parts[1].items()) position.second.push_back(member.index(m.states));
      const Indices& belief = position.second;
      if (belief.empty() || std::adjacent_find(belief.begin(), belief.end(), std::greater_equal<>()) != belief.end()) {
        refuse(parts[1].path(), "expected states, one at least, ascending");
      }
      if (!positions_.empty() && !(positions_.back()->first < position)) {
        refuse(entry.path(), "not above the one before it, expected them ascending");
      }
      positions_.push_back(numbers_.emplace(std::move(position), positions_.size()).first);
      actions_.push_back(candidates(m, q_star, positions_.back()->first.second, highest));
    }
  }

  std::size_t size() const { return positions_.size(); }
  const Position& operator[](std::size_t i) const { return positions_[i]->first; }
  const Indices& actions(std::size_t i) const { return actions_[i]; }  ///< C(M): one where Q* is known

  /// The number of the position that `belief` narrowed to B(t) makes, of true state s. Everything is possible at first.
  /// Of a game that need not be complete it is size() where only a start would have to be listed.
  std::size_t meet(std::size_t s, std::size_t t, const Indices* belief, bool complete) const {
    Position position{s, {}};
    if (belief == nullptr) {
      position.second = m_.balls[t];
    } else {
      m_.spend(path_, static_cast<double>(m_.balls[t].size() + belief->size()));
      std::set_intersection(m_.balls[t].begin(), m_.balls[t].end(), belief->begin(), belief->end(),
                            std::back_inserter(position.second));
    }
    const auto found = numbers_.find(position);
    if (found != numbers_.end()) return found->second;
    if (belief != nullptr && !complete) return size();
    std::string text;
    for (const std::size_t state : position.second) text += (text.empty() ? "" : ", ") + std::to_string(state);
    refuse(path_, "none of state " + std::to_string(s) + " and belief {" + text + "}, expected all that are reached");
  }

  /// The states that may follow a belief under an action, as far as the agent can tell.
  Indices successors(std::size_t i, std::size_t action) const {
    std::set<std::size_t> next;
    for (const std::size_t state : positions_[i]->first.second) {
      for (const auto& entry : m_.rows[m_.at(state, action)]) next.insert(entry.first);
      m_.spend(path_, static_cast<double>(m_.rows[m_.at(state, action)].size()));
    }
    return {next.begin(), next.end()};
  }

 private:
  const Model& m_;
  std::string path_;
  std::map<Position, std::size_t> numbers_;
  std::vector<std::map<Position, std::size_t>::const_iterator> positions_;
  std::vector<Indices> actions_;
};

}  // namespace

Table check_test_time(const Node& node, const Model& m, const Table& q_star, bool highest) {
  node.expect_members({"policy", "robust"});
  const Node policy = node.member("policy"), robust = node.member("robust");
  const Indices expected = maximin_policy(m, q_star, highest);
  expect_equal(policy.path(), policy.indices(m.states, m.actions), expected, " of the maximin policy of Q*");
  return expect_robust_values(m, robust.table(m.states), expected, robust.path());
}

Table check_test_time_by_bounds(const Node& node, const Model& m, const Enclosure& q_star, bool highest) {
  node.expect_members({"below"});
  const Node below = node.member("below");
  return expect_side(m, below.table(m.states), below.path(), Side::below, choices(m, q_star, highest).possible);
}

BeliefGame check_belief_game(const Node& node, const Model& m, const Enclosure& q_star, bool highest, bool bounds) {
  std::vector<const char*> names{"positions", "values", "reach"};
  if (!bounds) names.push_back("exact");
  node.expect_members(names);
  const Game game(m, q_star, highest, node.member("positions"));
  const Node values_node = node.member("values"), reach = node.member("reach");
  Table values = values_node.table(game.size());
  BeliefGame result;
  result.exact = !bounds && node.member("exact").boolean();
  // Of what is not listed, no value is below r_min/(1-g): an entry more.
  const Integer& least = *std::min_element(m.rewards.top.begin(), m.rewards.top.end());
  const Rational of_unlisted = Table{{least}, m.rewards.bottom}[0] / (1 - m.discount);
  Table more{{of_unlisted.get_num()}, of_unlisted.get_den()};
  align(values, more);
  values.top.push_back(more.top[0]);

  std::vector<bool> reached(game.size());
  Indices to_visit;
  // The least over t in B(s) of the values of the positions that t leads to, all of which are marked as reached.
  const auto worst_of = [&](std::size_t s, const Indices* belief) -> const Integer& {
    const Integer* worst = nullptr;
    for (const std::size_t t : m.balls[s]) {
      const std::size_t i = game.meet(s, t, belief, result.exact);
      if (i < game.size() && !reached[i]) to_visit.push_back(i);
      if (i < game.size()) reached[i] = true;
      if (worst == nullptr || values.top[i] < *worst) worst = &values.top[i];
    }
    return *worst;
  };
  result.worst.bottom = values.bottom;
  for (std::size_t s = 0; s < m.states; ++s) result.worst.top.push_back(worst_of(s, nullptr));
  while (!to_visit.empty()) {
    const std::size_t i = to_visit.back(), s = game[i].first;
    to_visit.pop_back();
    for (const std::size_t a : game.actions(i)) {
      const Indices successors = game.successors(i, a);
      Integer sum;
      for (const auto& [next, p] : m.rows[m.at(s, a)]) sum += p * worst_of(next, &successors);
      const Rational follows = m.rewards[m.at(s, a)] + m.discount * Rational(sum) / Rational(m.whole * values.bottom);
      const Rational value = values[i];
      if (result.exact ? value == follows : value <= follows) continue;
      refuse(item(values_node.path(), i),
             shown(value) + ", expected " + (result.exact ? "" : "at most ") + shown(follows));
    }
  }
  const auto unreached = std::find(reached.begin(), reached.end(), false);
  if (unreached != reached.end()) {
    refuse(item(node.path() + ".positions", static_cast<std::size_t>(unreached - reached.begin())),
           "not reached, expected only positions that are");
  }
  std::vector<Integer> lengths(m.states);
  for (std::size_t i = 0; i < game.size(); ++i) {
    if (i == 0 || game[i].first != game[i - 1].first) m.metric.from(game[i].first, lengths);
    Integer longest;
    for (const std::size_t member : game[i].second) longest = std::max(longest, lengths[member]);
    result.reach = std::max(result.reach, m.metric.near(longest));
  }
  expect_equal(reach.path(), reach.number(), result.reach);
  return result;
}

}  // namespace maximin::checker
