#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

/// Values straight from the definitions, in long double, by none of the library's algorithms: what these are held
/// against. Slow, for models of a few states.
namespace maximin::reference {

using Real = long double;

/// R + gamma P v.
inline QTable<Real> backup(const FiniteMdp<double>& mdp, const Values<Real>& v) {
  QTable<Real> q(mdp.states(), mdp.actions());
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      Real sum = 0;
      for (const auto& next : mdp.successors(s, a)) sum += Real(next.probability) * v[next.target];
      q(s, a) = Real(mdp.reward(s, a)) + Real(mdp.discount()) * sum;
    }
  }
  return q;
}

/// max|R|/(1-gamma), or 1 where all rewards are 0.
inline Real scale(const FiniteMdp<double>& mdp) {
  const Real largest = mdp.rewards().cwiseAbs().maxCoeff();
  return largest > 0 ? largest / (1 - Real(mdp.discount())) : Real(1);
}

/// The fixed point of Q = R + gamma P V with V(s) = value_of(Q, s), by as many sweeps as its contraction needs for
/// 1e-18 of the scale.
template <class ValueOf>
QTable<Real> fixed_point(const FiniteMdp<double>& mdp, ValueOf value_of) {
  QTable<Real> q = QTable<Real>::Zero(mdp.states(), mdp.actions());
  Values<Real> v(mdp.states());
  for (Real left = 1; left > 1e-18L; left *= Real(mdp.discount())) {
    for (State s = 0; s < mdp.states(); ++s) v[s] = value_of(q, s);
    q = backup(mdp, v);
  }
  return q;
}

/// Q*.
inline QTable<Real> optimal(const FiniteMdp<double>& mdp) {
  return fixed_point(mdp, [](const QTable<Real>& q, State s) { return q.row(s).maxCoeff(); });
}

/// The fixed point of T^{pi}_rob: pi against the strongest attacker.
inline QTable<Real> attacked(const FiniteMdp<double>& mdp, const Perturbation<double>& balls, const Policy& policy) {
  return fixed_point(mdp, [&](const QTable<Real>& q, State s) {
    Real worst = INFINITY;
    for (const State t : balls.ball(s)) worst = std::min(worst, q(s, policy[static_cast<std::size_t>(t)]));
    return worst;
  });
}

/// V of what is done in each true state, by elimination.
inline Values<Real> values_of(const FiniteMdp<double>& mdp, const Policy& action) {
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  Matrix system = Matrix::Identity(mdp.states(), mdp.states());
  Values<Real> rewards(mdp.states());
  for (State s = 0; s < mdp.states(); ++s) {
    const Action a = action[static_cast<std::size_t>(s)];
    rewards[s] = Real(mdp.reward(s, a));
    for (const auto& next : mdp.successors(s, a)) {
      system(s, next.target) -= Real(mdp.discount()) * Real(next.probability);
    }
  }
  return system.partialPivLu().solve(rewards);
}

/// Q^{pi o omega}: one action now, what is done in each true state ever after.
inline QTable<Real> of_pair(const FiniteMdp<double>& mdp, const Policy& composed) {
  return backup(mdp, values_of(mdp, composed));
}

}  // namespace maximin::reference
