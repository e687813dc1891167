#pragma once

#include <boost/rational.hpp>
#include <cstdint>
#include <utility>

#include <maximin/theory/bellman.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

/// The pessimistic backup Q -> T^{pi_Q o omega_Q} Q is not a contraction (paper, appendix C.2, Table 4).
///
/// Three states, three actions. Every action leads from every state to s2 (index 1), and every ball holds all states.
/// Two tables Q1 and Q2 lie 10 apart; their maximin policies are "always a1" and "always a2", so that the two backups
/// read Q1(s2,a1) = 11 and Q2(s2,a2) = 0 and lie 11 gamma apart. That is more than 10 if and only if gamma > 10/11. The
/// paper leaves the rewards open; they cancel in the difference and are 0 here.
namespace maximin::non_contraction {

/// An exact discount. Compare fractions with fractions only: in C++20 boost::rational == int calls itself for ever.
using Fraction = boost::rational<std::int64_t>;

/// The model with discount gamma, 0 <= gamma < 1.
template <class Scalar>
FiniteMdp<Scalar> model(const Scalar& gamma) {
  FiniteMdpBuilder<Scalar> builder(3, 3, gamma);
  for (State s = 0; s < 3; ++s) {
    for (Action a = 0; a < 3; ++a) builder.transition(s, a, 1, Scalar(1));
  }
  return std::move(builder).build();
}

/// B(s) = S for every s.
template <class Scalar>
Perturbation<Scalar> balls() {
  return Perturbation<Scalar>(Metric<Scalar>::discrete(3), Scalar(1));
}

/// Q1 of Table 4, one row per state (the paper prints one column per state).
template <class Scalar>
QTable<Scalar> q1() {
  QTable<Scalar> q(3, 3);
  q << Scalar(12), Scalar(12), Scalar(12), Scalar(11), Scalar(10), Scalar(8), Scalar(3), Scalar(2), Scalar(1);
  return q;
}

/// Q2 of Table 4, one row per state.
template <class Scalar>
QTable<Scalar> q2() {
  QTable<Scalar> q(3, 3);
  q << Scalar(4), Scalar(4), Scalar(4), Scalar(2), Scalar(0), Scalar(1), Scalar(-2), Scalar(-1), Scalar(-3);
  return q;
}

/// One of the two tables and what a pessimistic backup makes of it.
struct Side {
  QTable<double> q;
  PessimisticStep<double> step;  ///< pi_Q, omega_Q, the composed policy and the values it reads off
  QTable<double> backup;         ///< T^{pi_Q o omega_Q} Q
};

/// Both sides, by the general algorithms, and how far apart they are.
struct Examination {
  Side first, second;
  double distance_before = 0;  ///< |Q1 - Q2|
  double distance_after = 0;   ///< |T Q1 - T Q2|
};

/// Throws InputError unless 0 <= gamma < 1.
Examination examine(double gamma, TieBreak tie = TieBreak::lowest_index);

/// The two distances in whole numbers, with no rounding anywhere.
struct ExactDistances {
  std::int64_t before = 0;           ///< |Q1 - Q2|
  std::int64_t after_per_gamma = 0;  ///< |T Q1 - T Q2| / gamma

  /// The discount above which the backup drives Q1 and Q2 apart.
  Fraction threshold() const { return {before, after_per_gamma}; }
  /// |T Q1 - T Q2|, exactly.
  Fraction after(const Fraction& gamma) const { return gamma * after_per_gamma; }
  /// Whether |T Q1 - T Q2| > |Q1 - Q2|.
  bool expands(const Fraction& gamma) const { return after(gamma) > Fraction(before); }
};

ExactDistances exact_distances(TieBreak tie = TieBreak::lowest_index);

}  // namespace maximin::non_contraction
