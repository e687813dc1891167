#pragma once

#include <array>
#include <optional>
#include <vector>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/proofs_check/certificate/orbit_search.hpp>
#include <maximin/proofs_check/certificate/tightest.hpp>
#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/scaled.hpp>

namespace maximin {

/// Gathers the instances of every claim on one model: the counterpart of the examination in floating point, with
/// nothing rounded.
class ExactClaims {
 public:
  /// `optimal` is Q* and V*. `scaled`, the model in integers, and the options must outlive it.
  ExactClaims(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const ExactGeometry& geometry,
              const ModelConstants<Rational>& constants, const CertifiedSolution<Rational>& optimal,
              const CertifyOptions& options);

  /// What is claimed of a policy pair in every round that uses it, n the first of them; composed = pi o omega. Pairs
  /// are numbered as they come.
  void pair(long n, const CertifiedPair& pair, const Policy& composed);

  /// Round n, from Q_n = q to Q_{n+1} = next by the pair of that number.
  void round(long n, const ScaledTable& q, const ScaledTable& next, int pair);

  /// The rounds n >= from, Q_from = last, along the orbit. Returns the largest Q* less `low` of any phase.
  Rational limit(long from, const ScaledTable& last, const EnteredOrbit& entered, const CertifiedLimit& limit);

  /// It is not known what later rounds do.
  void no_limit();

  /// E: the values of the maximin policy of Q* against the optimal attacker.
  void test_time(const Values<Rational>& robust, const Rational& l_star);

  /// F: the start values of the belief game.
  void beliefs(const CertifiedBeliefGame& game, const Values<Rational>& start, const Rational& l_star);

  /// In the order of `claims`, those that are wanted.
  std::vector<CertifiedClaim> verdicts() const;

 private:
  /// What is said of a policy pair in every round that uses it.
  struct PairFacts {
    ScaledTable backup_of_optimal;  ///< T^{pi o omega} Q*
    Instance loss;                  ///< max (Q* - Q) against the optimal attacker
  };

  Tightest& at(ClaimId id) { return tightest_[static_cast<std::size_t>(id)]; }
  ScaledTable backup(const Values<Rational>& v) const { return scaled_.backup(ScaledValues(v)); }
  /// Lemma 2: |T*Q_n - Q_{n+1}| <= Delta. T*Q_n is never the smaller. `off`: how far Q_n may be from q.
  void lemma_2(long n, const ScaledTable& q, const ScaledTable& next, const Rational& off = 0);
  /// The bound of C and D.
  Rational finite_n(long n, const Rational& delta) const;
  /// It changes from round to round in one direction: its least value from n on is that of n or its limit.
  Rational least_from(long n, const Rational& delta) const;
  /// The phase of round n. Returns its largest Q* less `low`.
  Rational phase(long n, std::size_t j, const EnteredOrbit& entered, const CertifiedLimit& limit);

  const CertifyOptions& options_;
  const ScaledMdp& scaled_;
  Rational gamma_, eps_;
  bool exact_;           // distances are not rounded
  Values<Rational> v_;   // V*
  ScaledTable optimal_;  // Q*
  Rational start_;       // d_0 + u_0
  Rational delta_printed_, delta_sound_, delta_repaired_, delta_tv_;
  std::optional<LipschitzCheck> lemma_1_, lemma_1_iterates_;
  std::array<Tightest, claim_count> tightest_;
  std::vector<PairFacts> facts_;  // by pair
};

}  // namespace maximin
