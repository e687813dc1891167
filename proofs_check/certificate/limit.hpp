#pragma once

#include <optional>
#include <vector>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/perturbation.hpp>

/// Deciding a limit: the section of that name in docs/certificate-format.md, from the producer's side.
namespace maximin {

/// A k-periodic orbit of pessimistic Q-iteration, and how near Q_n must come for its policies to be those of the orbit.
struct Orbit {
  std::vector<ScaledTable> tables;       ///< Q^j, by phase
  std::vector<Values<Rational>> values;  ///< U_j
  Rational radius;  ///< below a third of every positive difference that a policy on the orbit depends on

  long period() const { return static_cast<long>(tables.size()); }
};

/// The orbit along which composed[j] = pi_j o omega_j is what is done in phase j, solved exactly. Whether it generates
/// these policies itself is not looked at. `scaled` is the model in integers. Throws BudgetExhausted when |S| times the
/// period is more than can be solved.
Orbit find_orbit(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const Perturbation<Rational>& balls,
                 const std::vector<Policy>& composed);

/// What is settled for all rounds from one on whose table q lies within the radius of phase 0 of the orbit.
struct SettledPhases {
  QTable<int> classes;                                     ///< entries that stay equal for ever have equal numbers
  std::vector<std::vector<std::vector<Action>>> choices;   ///< C_j(t), by phase and observation, ascending
  std::vector<std::vector<std::vector<Action>>> provoked;  ///< A_j(s), by phase and true state, ascending
  /// Every C_j(t) has one member, by phase.
  std::vector<bool> unique;
};

/// Nothing where choices tie on the orbit that lead to different backups, and nothing is known that decides between
/// them.
std::optional<SettledPhases> settle(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls,
                                    const Orbit& orbit, const ScaledTable& q, TieBreak tie);

/// What a certificate says of the rounds that follow the orbit from its phase 0.
CertifiedLimit certify_limit(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const Orbit& orbit,
                             SettledPhases phases, TieBreak tie);

}  // namespace maximin
