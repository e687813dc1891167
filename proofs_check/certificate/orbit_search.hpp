#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <vector>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/limit.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// The least period, of at most `most`, that a sequence has had at its end for twice as long; 0 if none.
template <class T>
long period_at_end(const std::vector<T>& sequence, long most) {
  const auto n = static_cast<long>(sequence.size());
  for (long k = 1; k <= most && 3 * k <= n; ++k) {
    if (std::equal(sequence.end() - 2 * k, sequence.end(), sequence.end() - 3 * k)) return k;
  }
  return 0;
}

/// An orbit to which Q_N lies so near that it is known what all later rounds do.
struct EnteredOrbit {
  Orbit orbit;
  SettledPhases phases;
  Rational off;  ///< how far Q_N is from phase 0
};

/// Watches the rounds of exact pessimistic Q-iteration for the orbit they enter. What it is given must outlive it.
class OrbitSearch {
 public:
  OrbitSearch(const FiniteMdp<Rational>& mdp, const ScaledMdp& scaled, const Perturbation<Rational>& balls,
              const CertifyOptions& options)
      : mdp_(mdp), scaled_(scaled), balls_(balls), options_(options) {}

  /// Takes the next round n: what is done in it, pi_n o omega_n, and Q_{n+1}. Returns the orbit, where it is entered by
  /// N = n + 1; then the search is over.
  std::optional<EnteredOrbit> after_round(Policy composed, const ScaledTable& q);

  /// Whether Q_n came near an orbit without that it was settled what later rounds do.
  bool ties_open() const { return next_attempt_ > 0; }

  /// Whether that happened so often that it will not be settled.
  bool hopeless() const { return hopeless_; }

  /// Of what is done, as by `period_at_end`.
  long period() const { return period_at_end(composed_, options_.max_period); }

 private:
  struct Candidate {
    Orbit orbit;
    int failures = 0;  ///< to settle it when Q_n had come near
  };

  const FiniteMdp<Rational>& mdp_;
  const ScaledMdp& scaled_;
  const Perturbation<Rational>& balls_;
  const CertifyOptions& options_;
  std::vector<Policy> composed_;  // by round
  /// By what is done in each phase. An orbit is solved once per rotation of its phases: the one that is found near is
  /// the one that is kept.
  std::map<std::vector<Policy>, Candidate> candidates_;
  bool hopeless_ = false;
  long next_attempt_ = 0;  // the first round in which settling is tried again
};

}  // namespace maximin
