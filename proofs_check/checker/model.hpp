#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "strict_json.hpp"

namespace maximin::checker {

using Indices = std::vector<std::size_t>;

/// The model of a certificate, with what follows from it alone. Tables by (s,a) have their entry at s * actions + a,
/// those by (s,t) at s * states + t.
struct Model {
  std::size_t states = 0, actions = 0;
  Rational discount, eps;
  Table rewards;
  std::vector<std::vector<std::pair<std::size_t, Integer>>> rows;  ///< of (s,a): s' and P(s'|s,a) `whole`
  Integer whole{1};
  bool l2 = false;
  Table near;                 ///< d-(s,t); 0 where infinite
  std::vector<bool> rounded;  ///< d+(s,t) is 2^-64 above d-(s,t)
  std::vector<bool> finite;   ///< d(s,t) is
  std::vector<Indices> balls;
  std::size_t most_bits = 0;  ///< of one table

  std::size_t at(std::size_t s, std::size_t a) const { return s * actions + a; }
  Rational near_at(std::size_t s, std::size_t t) const { return near[s * states + t]; }
  Rational far_at(std::size_t s, std::size_t t) const;
};

Model read_model(const Node& node);

/// |P(s'|s,a) - P(s'|t,a)| `whole` by s'.
std::vector<Integer> row_differences(const Model& model, std::size_t s, std::size_t t, std::size_t a);
Integer sum(const std::vector<Integer>& numbers);

/// back(V)(s,a) = R(s,a) + g sum_s' P(s'|s,a) V(s').
Table back(const Model& model, const Table& values);

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
