#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "strict_json.hpp"

namespace maximin::checker {

using Indices = std::vector<std::size_t>;

/// The distances of a model, worked out as they are asked for. A length is a distance, under l2 its square, as a
/// multiple of 1/unit; -1 is that of an infinite one.
struct Metric {
  bool l2 = false;
  Integer unit{1};
  std::function<void(std::size_t s, std::vector<Integer>& lengths)> from;  ///< the lengths from s to every state

  Rational near(const Integer& length) const;     ///< d-
  Rational far(const Integer& length) const;      ///< d+
  Integer reach(const Rational& distance) const;  ///< the largest length of distances up to that one, >= 0
};

/// The model of a certificate, with what follows from it alone. Tables by (s,a) have their entry at s * actions + a.
struct Model {
  std::size_t states = 0, actions = 0;
  Rational discount, eps;
  Table rewards;
  std::vector<std::vector<std::pair<std::size_t, Integer>>> rows;  ///< of (s,a): s' and P(s'|s,a) `whole`
  Integer whole{1};
  Metric metric;
  std::vector<Indices> balls;  ///< states ascending
  bool has_pairs = false;      ///< of states at a finite distance
  std::size_t entries = 0;     ///< what a sweep over the model looks at: transitions, and all balls for each action
  std::size_t most_bits = 0;   ///< of one table
  mutable double work_left = 0;

  std::size_t at(std::size_t s, std::size_t a) const { return s * actions + a; }
  Integer length(std::size_t s, std::size_t t) const;

  /// To be called before what takes so many steps: refuses what would take too many in all.
  void spend(const std::string& path, double steps) const;
};

/// Of so many states at most.
Model read_model(const Node& node, std::size_t most_states);

/// Of a model all else of which was read: its distances and balls.
void read_metric(const Node& node, Model& model);

/// |P(s'|s,a) - P(s'|t,a)| `whole`: the largest over s', and their sum.
struct RowDifference {
  Integer most, sum;
};
RowDifference row_difference(const Model& model, std::size_t s, std::size_t t, std::size_t a);

/// back(V)(s,a) = R(s,a) + g sum_s' P(s'|s,a) V(s').
Table back(const Model& model, const Table& values);

/// The same without R.
Table back_without_rewards(const Model& model, const Table& values);

/// Q(s, actions[s]), as values.
Table taken(const Model& model, const Table& q, const Indices& actions);

/// max_a Q(s,a), as values.
Table best_values(const Model& model, const Table& q);

/// argmax_a min_{m in belief} Q(m,a), among equals the lowest or the highest.
std::size_t maximin_action(const Model& model, const Table& q, const Indices& belief, bool highest);

/// The maximin action of every ball.
Indices maximin_policy(const Model& model, const Table& q, bool highest);

/// argmin_{t in B(s)} Q(s,pi(t)), among equals the lowest or the highest.
std::size_t best_response(const Model& model, const Table& q, const Indices& policy, std::size_t s, bool highest);

/// Refuses values, read at that path, that are not V(s) = q(s, action(s)) for q = back(V). Returns q.
Table expect_values(const Model& model, const Table& values, const std::string& path,
                    const std::function<std::size_t(const Table& q, std::size_t s)>& action);

/// The same for V(s) = min_{t in B(s)} q(s, pi(t)): the value of pi against its optimal attacker.
Table expect_robust_values(const Model& model, const Table& values, const Indices& policy, const std::string& path);

}  // namespace maximin::checker
