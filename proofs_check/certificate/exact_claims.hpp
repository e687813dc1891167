#pragma once

#include <array>
#include <optional>
#include <vector>

#include <maximin/proofs_check/certificate/boxes.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/proofs_check/certificate/orbit_search.hpp>
#include <maximin/proofs_check/certificate/tightest.hpp>
#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/scaled.hpp>

namespace maximin {

/// Gathers the instances of every claim on one model: the counterpart of the examination in floating point, with
/// nothing rounded but bounds, outwards.
class ExactClaims {
 public:
  /// What right sides rest on.
  struct Terms {
    const ModelConstants<Rational>& constants;
    ScaledValues low, high;  ///< around V*; the same where it is known
    bool bounds = false;     ///< constants may be too small, and nothing is said to be violated
  };

  /// `scaled`, the model in integers, and the options must outlive it.
  ExactClaims(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const ExactGeometry& geometry, Terms terms,
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

  /// What is claimed of a pair that is not known but enclosed, n the first round that uses it. Numbered as `pair`s.
  void boxed_pair(long n, const PairBox& values);
  /// Round n of such a pair; `before` is what is known of x_{n-1}, if there is one.
  void boxed_round(long n, const ValueBox* before, const RoundBox& round, int pair);
  /// The rounds n >= from, in boxes; what earlier ones were said to do is forgotten.
  void boxed_limit(long from, const BoxLimit& limit);

  /// Whether every claim about rounds that is wanted, and not out of reach, holds.
  bool rounds_hold() const;

  /// E: the values of the maximin policy of Q* against the optimal attacker.
  void test_time(const ScaledValues& robust, const Rational& l_star);

  /// F: the start values of the belief game.
  void beliefs(const CertifiedBeliefGame& game, const Values<Rational>& start, const Rational& l_star);

  /// In the order of `claims`, those that are wanted; by bounds there is no lemma 3, and no
  /// Lemma 1 of more than `max_pair_states` that is not asked for by name.
  std::vector<CertifiedClaim> verdicts() const;

 private:
  /// What is said of a policy pair in every round that uses it.
  struct PairFacts {
    ScaledTable backup_of_optimal;  ///< T^{pi o omega} Q*
    Instance loss;                  ///< max (Q* - Q) against the optimal attacker
  };

  using Instances = std::array<Tightest, claim_count>;

  Tightest& at(ClaimId id) { return rounds_[static_cast<std::size_t>(id)]; }
  Tightest& at_limit(ClaimId id) { return limit_[static_cast<std::size_t>(id)]; }
  CertifiedClaim verdict(ClaimId id) const;
  /// Lemma 1, of too many states.
  bool out_of_reach(ClaimId id) const;
  ScaledTable backup(const Values<Rational>& v) const { return scaled_.backup(ScaledValues(v)); }
  /// Lemma 2: |T*Q_n - Q_{n+1}| <= Delta. T*Q_n is never the smaller. `off`: how far Q_n may be from q.
  void lemma_2(Tightest& claim, long n, const ScaledTable& q, const ScaledTable& next, const Rational& off = 0);
  void boxed_lemma_2(Tightest& claim, long n, const RoundBox& round) const;
  /// The tightest instance of a table back(V), V between the two.
  Instance spread(const LipschitzCheck& check, const ValueBox& v, long n) const;
  /// A, B, C and D in a phase whose policies lose at most that.
  void losses_in_phase(const Instance& loss, bool attained);
  /// C and D in round n, whose policy loses that at most.
  void finite_n(long n, Instance loss);
  ScaledTable expected(const ScaledValues& v) const;
  /// The bound of C and D.
  Rational finite_n(long n, const Rational& delta) const;
  /// It changes from round to round in one direction: its least value from n on is that of n or its limit.
  Rational least_from(long n, const Rational& delta) const;
  /// The phase of round n. Returns its largest Q* less `low`.
  Rational phase(long n, std::size_t j, const EnteredOrbit& entered, const CertifiedLimit& limit);

  const CertifyOptions& options_;
  const ScaledMdp& scaled_;
  Rational gamma_, eps_;
  bool bounds_;
  bool exact_;           // right sides are not rounded, nor left ones
  ScaledValues v_;       // V*, or above
  ScaledTable optimal_;  // Q*, or above
  Rational start_;       // d_0 + u_0, or below
  ScaledValues misled_;  // 1 where a ball has several members, else 0
  Rational delta_printed_, delta_sound_, delta_repaired_, delta_tv_;
  std::optional<LipschitzCheck> lemma_1_, lemma_1_iterates_;
  Instances rounds_, limit_;
  std::vector<PairFacts> facts_;  // by pair
};

}  // namespace maximin
