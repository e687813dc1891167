#include "sections.hpp"

namespace maximin::checker {
namespace {

/// Max (W - V)/2.
Rational half_width(const Table& low, const Table& high) {
  const Table width = difference(high, low);
  return width[largest(width)] / 2;
}

/// "below" and "above" of a pair or a phase.
Bracket expect_policies(const Node& node, const Model& m, const std::vector<Indices>& possible,
                        const std::vector<Indices>& provoked) {
  const Node below = node.member("below"), above = node.member("above");
  const Table low = below.table(m.states), high = above.table(m.states);
  Bracket policies{{expect_side(m, low, below.path(), Side::below, possible),
                    expect_side(m, high, above.path(), Side::above, provoked)},
                   half_width(low, high)};
  align(policies.back.low, policies.back.high);
  return policies;
}

/// x rounded to a multiple of 2^-bits, down or up.
Table rounded(const Table& x, std::size_t bits, bool up) {
  Table result{{}, Integer(1) << bits};
  for (const Integer& top : x.top) {
    result.top.emplace_back();
    Integer& to = result.top.back();
    to = top << bits;
    (up ? mpz_cdiv_q : mpz_fdiv_q)(to.get_mpz_t(), to.get_mpz_t(), x.bottom.get_mpz_t());
  }
  return result;
}

using Lists = std::vector<Indices>;

std::string listed(const Indices& actions) {
  std::string text;
  for (const std::size_t a : actions) text += (text.empty() ? "{" : ", ") + std::to_string(a);
  return text + "}";
}

void expect_lists(const Node& node, const Model& m, const Lists& expected, std::size_t n) {
  const std::vector<Node> lists = node.items(m.states);
  for (std::size_t s = 0; s < m.states; ++s) {
    const Indices found = lists[s].indices(lists[s].items().size(), m.actions);
    if (found == expected[s]) continue;
    refuse(lists[s].path(), "not the actions of round " + std::to_string(n) + ", expected " + listed(expected[s]));
  }
}

}  // namespace

void check_boxes(const Node& node, const Model& m, const LastRound& last, std::size_t rounds, bool highest,
                 const std::function<void(const Box&)>& visit) {
  node.expect_members({"boxes"});
  const std::vector<Node> boxes = node.member("boxes").items();
  if (boxes.empty()) refuse(node.path() + ".boxes", "empty, expected a phase at least");
  m.spend(node.path(), static_cast<double>(boxes.size()) * static_cast<double>(m.entries));
  for (const Node& box : boxes) box.expect_members({"low", "high", "below", "above"});
  const Node last_low = boxes.back().member("low"), last_high = boxes.back().member("high");
  Table before_low = last_low.table(m.states), before_high = last_high.table(m.states);
  expect_side(before_low, last_low.path(), Side::below, last.low);  // condition 1
  expect_side(before_high, last_high.path(), Side::above, last.high);
  for (const Node& entry : boxes) {
    const Node low_node = entry.member("low"), high_node = entry.member("high");
    Table low = low_node.table(m.states), high = high_node.table(m.states);
    Box box;
    box.n = rounds++;
    box.iterate = {enclose(m, before_low, before_high), half_width(before_low, before_high)};
    const Choices choice = choices(m, box.iterate.back, highest);
    expect_side(low, low_node.path(), Side::below, choice.low);  // condition 2
    expect_side(high, high_node.path(), Side::above, choice.high);
    box.policies = expect_policies(entry, m, choice.possible, provoked(m, box.iterate.back, choice, high));  // 3
    box.low = low;
    before_low = std::move(low);
    before_high = std::move(high);
    visit(box);
  }
}

LastRound check_rounds_by_bounds(const Node& root, const Model& m, bool highest,
                                 const std::function<void(const Box&)>& visit) {
  const std::vector<Node> pairs = root.member("pairs").items(), rounds = root.member("rounds").items();
  const std::size_t most = 100'000, bits_of = root.member("bits").integer(0, most);
  if (pairs.empty()) refuse("$.pairs", "empty, expected that of a round at least");
  if (bits(m.states, Integer(1) << bits_of) > m.most_bits) refuse("$.bits", "too many, expected fewer");
  std::vector<Lists> candidates, attackers;
  std::vector<Bracket> policies;
  std::size_t kept = 0;  // bits of all policies
  LastRound last;
  last.low.top = last.high.top = std::vector<Integer>(m.states);
  for (std::size_t n = 0; n < rounds.size(); ++n) {
    m.spend("$.rounds", static_cast<double>(m.entries) * (1 + static_cast<double>(bits_of) / 1000));
    const std::size_t i = rounds[n].index(pairs.size()), met = policies.size();
    if (i > met) {
      refuse(rounds[n].path(), "a pair that skips pair " + std::to_string(met) + ", expected none to be skipped");
    }
    Box box;
    box.n = n;
    box.first = i == met;
    box.iterate = {enclose(m, last.low, last.high), half_width(last.low, last.high)};
    if (n == 0) box.iterate.back.low.top = box.iterate.back.high.top = std::vector<Integer>(m.rows.size());
    const Choices choice = choices(m, box.iterate.back, highest);
    last.low = rounded(choice.low, bits_of, false);
    last.high = rounded(choice.high, bits_of, true);
    const Lists attacker = provoked(m, box.iterate.back, choice, last.high);
    if (box.first) {
      pairs[i].expect_members({"choices", "provoked", "below", "above"});
      for (std::size_t earlier = 0; earlier < met; ++earlier) {
        if (candidates[earlier] != choice.candidates || attackers[earlier] != attacker) continue;
        refuse(rounds[n].path(), "the second pair of the same actions, expected " + std::to_string(earlier));
      }
      policies.push_back(expect_policies(pairs[i], m, choice.possible, attacker));
      kept += bits(2 * m.rows.size(), policies.back().back.low.bottom);
      if (kept > 8 * m.most_bits) refuse(pairs[i].path(), "pairs that take too much memory, expected fewer");
      candidates.push_back(choice.candidates);
      attackers.push_back(attacker);
    }
    expect_lists(pairs[i].member("choices"), m, choice.candidates, n);
    expect_lists(pairs[i].member("provoked"), m, attacker, n);
    box.policies = policies[i];
    box.low = last.low;
    visit(box);
  }
  if (policies.size() < pairs.size()) {
    refuse(pairs[policies.size()].path(), "in no round, expected only pairs that occur");
  }
  return last;
}

}  // namespace maximin::checker
