#pragma once

#include <functional>
#include <optional>

#include "model.hpp"

/// The sections of a certificate, a function each: what it reads and verifies, and what is then known.
namespace maximin::checker {

/// "optimal": V*. Returns Q*.
Table check_optimal(const Node& node, const Model& model);

struct Constants {
  Rational l_r, l_p, k, l_star, r_min, r_max;
};
Constants check_constants(const Node& node, const Model& model, const Table& q_star);

struct Pair {
  Indices policy, attack;
  Indices composed;                     ///< c(s) = pi(om(s))
  Table back_of_fixed, back_of_robust;  ///< back of its values
};
/// "pairs": their values are those of their policies. That the policies are those of rounds is for check_rounds.
std::vector<Pair> check_pairs(const Node& node, const Model& model);

struct Round {
  std::size_t n, pair;
  bool first;  ///< of its pair
  Table q;     ///< Q_n
  Table next;  ///< Q_{n+1}
};
/// "rounds", replayed from Q_0 = 0: `visit` sees every round. Returns Q_N.
Table check_rounds(const Indices& rounds, const Model& model, const std::vector<Pair>& pairs, bool highest,
                   const std::function<void(const Round&)>& visit);

struct Phase {
  Table q;                             ///< Q^j
  bool attained = false;               ///< back_of_low is that of the policy's value, not only below it
  Table back_of_low;                   ///< back of its V_j
  std::optional<Table> back_of_fixed;  ///< back of its `fixed`, where that is not null
};
struct Limit {
  Rational delta;  ///< max |Q_N - Q^0|
  std::vector<Phase> phases;
};
/// "limit", not null; `last` is Q_N.
Limit check_limit(const Node& node, const Model& model, const Table& last, bool highest);

/// "test_time": returns back of the values of the maximin policy of Q* against its optimal attacker.
Table check_test_time(const Node& node, const Model& model, const Table& q_star, bool highest);

struct BeliefGame {
  Table worst;  ///< min_{t in B(s)} W(s,B(t)) by s
  Rational reach;
  bool exact = false;  ///< else a lower bound
};
/// "belief_game", not null.
BeliefGame check_belief_game(const Node& node, const Model& model, const Table& q_star, bool highest);

}  // namespace maximin::checker
