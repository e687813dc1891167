#pragma once

#include <maximin/theory/types.hpp>

/// What pessimism can cost, as closed formulas. Every function takes the constants it needs and nothing else; who
/// computes them is `model_constants`. Units: Lipschitz constants of R in reward per distance, of P per distance; eps
/// in distance; results in reward. All need 0 <= gamma < 1 and eps >= 0.
namespace maximin::bounds {

/// gamma^n.
template <class Scalar>
Scalar power(const Scalar& gamma, long n) {
  Scalar result(1), base(gamma);
  for (; n > 0; n /= 2) {
    if (n % 2 == 1) result *= base;
    base *= base;
  }
  return result;
}

/// L_Q = l_r + R_max/(1-gamma) |S| l_p, as Lemma 1 prints it: a Lipschitz constant of Q^{pi o omega}.
template <class Scalar>
Scalar lipschitz_of_q_printed(const Scalar& gamma, const Scalar& l_r, const Scalar& l_p, State states,
                              const Scalar& r_max) {
  return l_r + l_p * Scalar(states) * r_max / (Scalar(1) - gamma);
}

/// L = l_r + gamma |S| l_p R_max/(1-gamma): Lemma 1 with the factor gamma it drops, valid for every iterate Q_n too
/// when Q_0 = 0 and |R| <= R_max.
template <class Scalar>
Scalar lipschitz_of_q(const Scalar& gamma, const Scalar& l_r, const Scalar& l_p, State states, const Scalar& r_max) {
  return l_r + gamma * l_p * Scalar(states) * r_max / (Scalar(1) - gamma);
}

/// L_tv = l_r + gamma K span(R)/(1-gamma), K the Lipschitz constant of P in total variation (strengthening D). Never
/// larger than `lipschitz_of_q`, and free of any assumption on the sign of R.
template <class Scalar>
Scalar lipschitz_of_q_tv(const Scalar& gamma, const Scalar& l_r, const Scalar& k_tv, const Scalar& span) {
  return l_r + gamma * k_tv * span / (Scalar(1) - gamma);
}

/// Delta = 2 eps gamma L, the most that one pessimistic backup can lose against T* when Q is L-Lipschitz (Lemma 2).
/// With `lipschitz_of_q_printed` it is the paper's Delta.
template <class Scalar>
Scalar delta(const Scalar& eps, const Scalar& gamma, const Scalar& lipschitz) {
  return Scalar(2) * eps * gamma * lipschitz;
}

/// Theorem 1: limsup_n |Q* - Q^{pi_n o omega_n}| <= (1+gamma)/(1-gamma)^2 Delta.
template <class Scalar>
Scalar theorem_1(const Scalar& gamma, const Scalar& delta) {
  const Scalar rest = Scalar(1) - gamma;
  return (Scalar(1) + gamma) / (rest * rest) * delta;
}

/// Strengthening B: 1/(1-gamma)^2 Delta, since asymptotically Q_n <= Q*.
template <class Scalar>
Scalar theorem_1_one_sided(const Scalar& gamma, const Scalar& delta) {
  const Scalar rest = Scalar(1) - gamma;
  return delta / (rest * rest);
}

/// Strengthening C, for every n, where Delta bounds T*Q_n - Q_{n+1} in every round. The Delta of a Lipschitz constant
/// does for Q_0 = 0; and for any Q_0 that is Lipschitz with it and has span(Q_0) <= span(R)/(1-gamma) (2
/// R_max/(1-gamma) for the constant L). Lipschitz alone is not enough (proofs_check/coq/counterexample.v, steep_start).
///     gap_n <= [ gamma ( gamma^n (d_0 + u_0) + Delta (1-gamma^n)/(1-gamma) ) + Delta ] / (1-gamma),
/// d_0 = max (Q*-Q_0)^+, u_0 = max (Q_0-Q*)^+.
template <class Scalar>
Scalar finite_n(const Scalar& gamma, const Scalar& delta, const Scalar& d_0, const Scalar& u_0, long n) {
  const Scalar decay = power(gamma, n);
  const Scalar rest = Scalar(1) - gamma;
  return (gamma * (decay * (d_0 + u_0) + delta * (Scalar(1) - decay) / rest) + delta) / rest;
}

/// Strengthening E: the maximin policy of Q* itself, against the optimal attacker, loses at most
/// 2 eps gamma L*/(1-gamma) in Q, L* the exact Lipschitz constant of Q*.
template <class Scalar>
Scalar test_time_pessimism(const Scalar& eps, const Scalar& gamma, const Scalar& lipschitz_of_q_star) {
  return delta(eps, gamma, lipschitz_of_q_star) / (Scalar(1) - gamma);
}

/// Strengthening F: with a belief that contains the truth and lies within rho of it (rho <= 2 eps), the maximin action
/// of Q* over the belief loses at most rho L*/(1-gamma) in V, against any history-dependent attack.
template <class Scalar>
Scalar belief(const Scalar& rho, const Scalar& gamma, const Scalar& lipschitz_of_q_star) {
  return rho * lipschitz_of_q_star / (Scalar(1) - gamma);
}

/// gamma span(R)/(1-gamma): the values Q of no two policies differ by more, for the first reward is the same whatever
/// they do later. A bound at or above it says nothing ("vacuous"). (Values V may differ by span(R)/(1-gamma); bounds in
/// V are held to the smaller number as well.)
template <class Scalar>
Scalar trivial(const Scalar& gamma, const Scalar& span) {
  return gamma * span / (Scalar(1) - gamma);
}

}  // namespace maximin::bounds
