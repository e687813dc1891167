#pragma once

#include <map>
#include <vector>

#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// What to be sure of.
struct GuaranteeOptions {
  /// 0: the discounted return for ever. Otherwise the total reward of so many steps, not discounted.
  long steps = 0;
  long max_beliefs = 1'000'000;  ///< reachable beliefs before BudgetExhausted is thrown
  double tolerance = 1e-12;      ///< certified error to reach, as a fraction of max|R|/(1-gamma); for ever only
  long max_sweeps = 1'000'000;
};

/// The most that an agent can be sure of, and how.
template <class Scalar>
struct GuaranteedValue {
  /// What to do on a belief, and what the agent is sure of if it does so.
  struct Choice {
    Scalar value;
    Action action;  ///< the first of the best; with finitely many steps left, the best in the first of them
  };

  Values<Scalar> shown;  ///< |S|: sure once state t is shown first, U(B(t))
  Values<Scalar> v;      ///< |S|: sure to be got in an episode that starts in s, min_{t in B(s)} U(B(t))
  Scalar error{0};       ///< certified, in the maximum norm
  long beliefs = 0;      ///< as many as were looked into
  long sweeps = 0;
  std::map<Belief, Choice> choices;  ///< by belief: those that an attacker who is worth fearing brings about
};

/// The best that an agent with a belief can guarantee against every attacker, every random event of the model included.
/// On belief M, a set of states in which the episode goes on,
///
///     U(M) = max_a min_{s in M, s' with P(s'|s,a) > 0, t in B(s')} R(s,a) + gamma U(M'),
///     M'   = those successors of M that do not end the episode, intersected with B(t),
///
/// a zero-sum game of perfect information on beliefs: the attacker chooses the truth together with what it shows. A
/// state that no action leaves and that pays nothing ends the episode, as in TabularEnvironment, and the agent notices:
/// nothing follows. Only the largest M' count, since a smaller belief is worth no less, and only they are enumerated.
///
/// U(M) is a lower bound on the return that the agent attains from every truth in M; no agent, with memory or without,
/// randomising or not, can guarantee more on every single run when transitions are deterministic and R does not depend
/// on the state as long as the episode goes on (elsewhere U may be too low, since reward and successor may be judged by
/// different truths). Averaged over starts, an agent may do better against the optimal attacker: that one knows the
/// truth, but cannot choose it.
///
/// Throws BudgetExhausted when there are too many beliefs or sweeps, InputError when sizes do not match.
template <class Scalar>
GuaranteedValue<Scalar> guaranteed_value(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                         const GuaranteeOptions& options = {});

/// The policy that keeps the guarantee, from the answer for ever. On a belief that was not enumerated it does what is
/// best on a larger one that was; on one without such (no filter of the model holds it) and on the end, action 0.
/// States that end the episode may be in the belief, and do not count. The model must outlive it.
template <class Scalar>
BeliefPolicy guaranteed_policy(const FiniteMdp<Scalar>& mdp, GuaranteedValue<Scalar> guarantee);

}  // namespace maximin
