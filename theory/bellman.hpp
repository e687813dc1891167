#pragma once

#include <cstddef>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/types.hpp>

/// The Bellman operators. Each is a backup of some state values V,
///
///     (backup V)(s,a) = R(s,a) + gamma sum_{s'} P(s'|s,a) V(s'),
///
/// and they differ only in how V is read off Q:
///
///     T*              V(s) = max_a Q(s,a)
///     T^{pi o omega}  V(s) = Q(s, pi(omega(s)))
///     T^{pi}_rob      V(s) = min_{t in B(s)} Q(s, pi(t))
///     pessimistic     V(s) = Q(s, pi_Q(omega_Q(s))), both policies derived from Q itself
///
/// Nothing here allocates once the outputs have their size.
namespace maximin {

/// R + gamma P v, for state values v. out: |S| x |A|.
template <class Scalar>
void backup(const FiniteMdp<Scalar>& mdp, const Values<Scalar>& v, QTable<Scalar>& out) {
  out.resize(mdp.states(), mdp.actions());
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      out(s, a) = mdp.reward(s, a) + mdp.discount() * mdp.expectation(s, a, v);
    }
  }
}

/// V(s) = max_a q(s,a).
template <class Scalar>
void greedy_values(const QTable<Scalar>& q, Values<Scalar>& out) {
  out = q.rowwise().maxCoeff();
}

/// V(s) = q(s, action[s]), `action` being the action taken in each true state.
template <class Scalar>
void policy_values(const QTable<Scalar>& q, const Policy& action, Values<Scalar>& out) {
  out.resize(q.rows());
  for (Eigen::Index s = 0; s < q.rows(); ++s) out[s] = q(s, action[static_cast<std::size_t>(s)]);
}

/// V(s) = min_{t in B(s)} q(s, pi(t)): what is left of q when the attacker answers pi greedily.
template <class Scalar>
void attacked_values(const QTable<Scalar>& q, const Policy& policy, const Perturbation<Scalar>& perturbation,
                     Values<Scalar>& out) {
  out.resize(q.rows());
  for (State s = 0; s < q.rows(); ++s) {
    const auto ball = perturbation.ball(s);
    Scalar worst = q(s, policy[static_cast<std::size_t>(ball.front())]);
    for (const State t : ball.subspan(1)) {
      const Scalar& v = q(s, policy[static_cast<std::size_t>(t)]);
      if (v < worst) worst = v;
    }
    out[s] = worst;
  }
}

/// The Bellman optimality operator T*Q (paper, section 3.6, equation 2). `v` is scratch.
template <class Scalar>
void bellman_optimality(const FiniteMdp<Scalar>& mdp, const QTable<Scalar>& q, Values<Scalar>& v, QTable<Scalar>& out) {
  greedy_values(q, v);
  backup(mdp, v, out);
}

/// The Bellman operator T^{pi o omega}Q of a fixed pair (paper, Definition 3, equation 1), given the composed policy pi
/// o omega.
template <class Scalar>
void bellman_pair(const FiniteMdp<Scalar>& mdp, const Policy& composed, const QTable<Scalar>& q, Values<Scalar>& v,
                  QTable<Scalar>& out) {
  policy_values(q, composed, v);
  backup(mdp, v, out);
}

/// T^{pi}_rob Q: the fixed agent pi against the attacker that is greedy for Q. Its fixed point is the value of pi
/// against the optimal attacker.
template <class Scalar>
void bellman_robust(const FiniteMdp<Scalar>& mdp, const Policy& policy, const Perturbation<Scalar>& perturbation,
                    const QTable<Scalar>& q, Values<Scalar>& v, QTable<Scalar>& out) {
  attacked_values(q, policy, perturbation, v);
  backup(mdp, v, out);
}

/// The policies that Q induces and the room to compute them in.
template <class Scalar>
struct PessimisticStep {
  Policy policy;          ///< pi_Q, by observation
  AttackPolicy attack;    ///< omega_{pi_Q}, by true state
  Policy composed;        ///< pi_Q o omega_{pi_Q}, by true state
  Values<Scalar> values;  ///< Q(s, pi_Q(omega_{pi_Q}(s)))
  std::vector<Scalar> scratch;
};

/// One step of pessimistic Q-iteration (paper, Algorithm 3): derives pi_Q and omega_{pi_Q} from Q, and returns in `out`
/// T^{pi_Q o omega_{pi_Q}} Q. Not a contraction (paper, appendix C.2).
template <class Scalar>
void pessimistic_update(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation, const QTable<Scalar>& q,
                        PessimisticStep<Scalar>& step, QTable<Scalar>& out, TieBreak tie = TieBreak::lowest_index) {
  maximin_policy(q, perturbation, step.policy, step.scratch, MinAggregator{}, tie);
  best_response_attack(q, step.policy, perturbation, step.attack, tie);
  compose(step.policy, step.attack, step.composed);
  bellman_pair(mdp, step.composed, q, step.values, out);
}

}  // namespace maximin
