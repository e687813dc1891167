#pragma once

#include <functional>
#include <optional>

#include "enclosure.hpp"

/// The sections of a certificate, a function each: what it reads and verifies, and what is then known.
namespace maximin::checker {

/// What is known of V* and Q*; by bounds no more than that they lie between two tables, else both are the same.
struct Optimal {
  Table high;   ///< V*, or values above it
  Enclosure q;  ///< Q*, or tables below and above it
};
/// "optimal": V*, or its `low` and `high`.
Optimal check_optimal(const Node& node, const Model& model);
Optimal check_optimal_by_bounds(const Node& node, const Model& model);

struct Constants {
  Rational l_r, l_p, k, l_star, r_min, r_max;
};
Constants check_constants(const Node& node, const Model& model, const Enclosure& q_star, bool bounds);

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
/// The last round, N-1: values that its x_{N-1} lies between, or which it is, and Q_N (not by bounds).
struct LastRound {
  Table low, high, q;
};
/// "rounds", replayed from Q_0 = 0: `visit` sees every round.
LastRound check_rounds(const Indices& rounds, const Model& model, const std::vector<Pair>& pairs, bool highest,
                       const std::function<void(const Round&)>& visit);

/// Values V <= W, by what follows from them.
struct Bracket {
  Enclosure back;
  Rational half;  ///< max (W - V)/2
};

/// What is known of one round n, or of all those of a phase, where values are only enclosed.
struct Box {
  std::size_t n = 0;
  bool first = true;  ///< of its pair
  Bracket iterate;    ///< Lo, Hi, and the values x_{n-1} they come from
  Table low;          ///< below x_n
  Bracket policies;   ///< the values of pi_n when om_n attacks, and against its optimal attacker
};
/// "pairs", "rounds" and "bits" of a certificate by bounds.
LastRound check_rounds_by_bounds(const Node& root, const Model& model, bool highest,
                                 const std::function<void(const Box&)>& visit);

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
/// "limit" with an orbit.
Limit check_limit(const Node& node, const Model& model, const Table& q_n, bool highest);

/// "limit" with boxes: `visit` sees every phase j, as n = `rounds` + j.
void check_boxes(const Node& node, const Model& model, const LastRound& last, std::size_t rounds, bool highest,
                 const std::function<void(const Box&)>& visit);

/// "test_time": returns back of the values of the maximin policy of Q* against its optimal attacker, or of lower ones.
Table check_test_time(const Node& node, const Model& model, const Table& q_star, bool highest);
Table check_test_time_by_bounds(const Node& node, const Model& model, const Enclosure& q_star, bool highest);

struct BeliefGame {
  Table worst;  ///< min_{t in B(s)} W(s,B(t)) by s
  Rational reach;
  bool exact = false;  ///< else a lower bound
};
/// "belief_game", not null.
BeliefGame check_belief_game(const Node& node, const Model& model, const Enclosure& q_star, bool highest, bool bounds);

}  // namespace maximin::checker
