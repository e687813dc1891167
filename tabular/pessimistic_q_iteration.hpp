#pragma once

#include <functional>
#include <optional>
#include <vector>

#include <maximin/theory/bellman.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The policies of one round: pi_n by observation, omega_{pi_n} by true state.
struct PolicyPair {
  Policy policy;
  AttackPolicy attack;

  friend bool operator==(const PolicyPair&, const PolicyPair&) = default;
};

/// How long pessimistic Q-iteration runs and what it keeps.
template <class Scalar>
struct PessimisticQIterationOptions {
  std::optional<QTable<Scalar>> initial;  ///< Q_0, |S| x |A|; zero if absent, as in the paper
  long max_iterations = 100'000;
  long max_period = 64;  ///< the longest cycle of policy pairs that is looked for
  /// |Q_{n+k} - Q_n| at which period k counts as reached: this fraction of max|R|/(1-gamma), times 1 - gamma^k, so that
  /// Q_n is then within that fraction of the orbit it approaches if the pairs go on like this (never below rounding)
  double tolerance = 1e-12;
  TieBreak tie = TieBreak::lowest_index;
  bool keep_trajectory = false;  ///< store every Q_n
  bool stop_when_periodic = true;
};

/// What became of the policy pairs.
enum class Fate {
  settled,       ///< one pair for ever, Q_n converges
  cycles,        ///< the pairs repeat with a period above 1, Q_n approaches a periodic orbit
  undetermined,  ///< neither was seen within the iterations allowed
};

template <class Scalar>
struct PessimisticQIteration {
  QTable<Scalar> q;     ///< the last Q_n
  long iterations = 0;  ///< n of `q`
  Fate fate = Fate::undetermined;
  long period = 0;                         ///< of the policy pairs, when they settled (1) or cycle
  long periodic_from = 0;                  ///< first n from which the pairs repeat, when they do
  std::vector<PolicyPair> pairs;           ///< the distinct pairs, in order of first use
  std::vector<int> pair_of;                ///< pair_of[n]: index into `pairs` of (pi_n, omega_n), n < iterations
  std::vector<QTable<Scalar>> trajectory;  ///< Q_0 ... Q_iterations, if asked for
};

/// Sees every round: n, Q_n, and the index of its policy pair (paired with the pair itself on first use and after).
template <class Scalar>
using RoundObserver = std::function<void(long n, const QTable<Scalar>& q, int pair, const PolicyPair& policies)>;

/// Pessimistic Q-iteration (paper, Algorithm 3): Q_{n+1} = T^{pi_n o omega_n} Q_n with pi_n the maximin policy of Q_n
/// and omega_n the attacker's best response to it.
///
/// The operator is not a contraction and Q_n need not converge. The iteration therefore watches the policy pairs: while
/// they repeat with period k, Q_{n+k} - Q_n shrinks by gamma each round, and once it is below the tolerance the fate is
/// settled (k = 1) or a cycle (k > 1). That is a numerical finding; a near-tie closer than the tolerance could still
/// undo it. Throws InputError when the sizes do not match.
template <class Scalar>
PessimisticQIteration<Scalar> pessimistic_q_iteration(const FiniteMdp<Scalar>& mdp,
                                                      const Perturbation<Scalar>& perturbation,
                                                      const PessimisticQIterationOptions<Scalar>& options = {},
                                                      const RoundObserver<Scalar>& observe = {});

}  // namespace maximin
