#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <maximin/theory/aggregators.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

namespace internal {

/// The index in [0, count) with the best value(i), where better(x, y) says that x beats y.
template <class Index, class ValueOf, class Better>
Index arg_best(Index count, ValueOf value, Better better, TieBreak tie) {
  Index best = 0;
  auto best_value = value(Index(0));
  for (Index i = 1; i < count; ++i) {
    const auto v = value(i);
    const bool wins = tie == TieBreak::lowest_index ? better(v, best_value) : !better(best_value, v);
    if (wins) {
      best = i;
      best_value = v;
    }
  }
  return best;
}

}  // namespace internal

/// argmax_a q(s,a) for every s: the greedy policy of an agent that sees the truth.
template <class Scalar>
void greedy_policy(const QTable<Scalar>& q, Policy& out, TieBreak tie = TieBreak::lowest_index) {
  out.resize(static_cast<std::size_t>(q.rows()));
  for (Eigen::Index s = 0; s < q.rows(); ++s) {
    out[static_cast<std::size_t>(s)] = internal::arg_best<Action>(
        static_cast<Action>(q.cols()), [&](Action a) { return q(s, a); }, [](auto& x, auto& y) { return x > y; }, tie);
  }
}

/// The action argmax_a Aggregate_{m in belief} q(m,a). `scratch` holds the values over the belief and is grown to
/// |belief| on first use. `belief` must not be empty.
template <class Scalar, class Agg = MinAggregator>
requires Aggregator<Agg, Scalar> Action belief_action(const QTable<Scalar>& q, std::span<const State> belief,
                                                      std::vector<Scalar>& scratch, const Agg& aggregate = {},
                                                      TieBreak tie = TieBreak::lowest_index) {
  scratch.resize(std::max(scratch.size(), belief.size()));
  const auto value = [&](Action a) {
    for (std::size_t i = 0; i < belief.size(); ++i) scratch[i] = q(belief[i], a);
    return Scalar(aggregate(std::span<Scalar>(scratch.data(), belief.size())));
  };
  return internal::arg_best<Action>(
      static_cast<Action>(q.cols()), value, [](auto& x, auto& y) { return x > y; }, tie);
}

/// pi(t) = argmax_a min_{m in B(t)} q(m,a) for every observation t (paper, Algorithm 1 line 5 and Algorithm 3), or with
/// another aggregator in the place of min. Values and distances may be of different scalars.
template <class Scalar, class Distance, class Agg = MinAggregator>
requires Aggregator<Agg, Scalar>
void maximin_policy(const QTable<Scalar>& q, const Perturbation<Distance>& perturbation, Policy& out,
                    std::vector<Scalar>& scratch, const Agg& aggregate = {}, TieBreak tie = TieBreak::lowest_index) {
  out.resize(static_cast<std::size_t>(q.rows()));
  for (State t = 0; t < q.rows(); ++t) {
    out[static_cast<std::size_t>(t)] = belief_action(q, perturbation.ball(t), scratch, aggregate, tie);
  }
}

/// omega_pi(s) = argmin_{t in B(s)} q(s, pi(t)) for every true state s: the attacker's best response to pi, judged by q
/// (paper, Algorithm 1 line 6).
template <class Scalar, class Distance>
void best_response_attack(const QTable<Scalar>& q, const Policy& policy, const Perturbation<Distance>& perturbation,
                          AttackPolicy& out, TieBreak tie = TieBreak::lowest_index) {
  out.resize(static_cast<std::size_t>(q.rows()));
  for (State s = 0; s < q.rows(); ++s) {
    const auto ball = perturbation.ball(s);
    const auto shown = internal::arg_best<std::size_t>(
        ball.size(), [&](std::size_t i) { return q(s, policy[static_cast<std::size_t>(ball[i])]); },
        [](auto& x, auto& y) { return x < y; }, tie);
    out[static_cast<std::size_t>(s)] = ball[shown];
  }
}

/// pi o omega: the action actually taken in each true state (the paper's pi-tilde).
inline void compose(const Policy& policy, const AttackPolicy& attack, Policy& out) {
  out.resize(attack.size());
  for (std::size_t s = 0; s < attack.size(); ++s) out[s] = policy[static_cast<std::size_t>(attack[s])];
}

/// The attack that shows the truth.
inline AttackPolicy no_attack(State states) {
  AttackPolicy attack(static_cast<std::size_t>(states));
  for (State s = 0; s < states; ++s) attack[static_cast<std::size_t>(s)] = s;
  return attack;
}

}  // namespace maximin
