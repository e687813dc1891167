#pragma once

#include <array>
#include <atomic>
#include <exception>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <string>

#include <maximin/proofs_check/check.hpp>
#include <maximin/proofs_check/claims.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/lipschitz.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// An examination was asked to stop before it was done.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

struct ExaminationOptions {
  Reading reading = Reading::corrected;
  long max_iterations = 20'000;                ///< of pessimistic Q-iteration
  long max_belief_positions = 20'000;          ///< for claim F; more make it undetermined
  std::optional<std::set<ClaimId>> only = {};  ///< absent: all
  long max_period = 64;                        ///< the longest cycle of policy pairs that is looked for
  TieBreak tie = TieBreak::lowest_index;
  bool exact = false;      ///< in exact arithmetic (certificate/exact_examination.hpp)
  bool by_bounds = false;  ///< and then with bounds in the place of exact values
  bool pedantic = false;   ///< of what is told of it: what holds in floating point alone is undetermined
  const std::atomic<bool>* stop = nullptr;  ///< raised from elsewhere: the examination ends with Interrupted

  std::function<void(const char* stage, long n)> progress = {};  ///< of exact work: as CertifyOptions has it

  /// Whether the claim is asked for; by bounds lemma 3 never is.
  bool wants(ClaimId id) const { return (!only || only->contains(id)) && !(by_bounds && id == ClaimId::lemma_3); }
  /// Whether what holds is told as undetermined, since it only held within rounding.
  bool doubts_what_holds() const { return pedantic && !exact; }
};

/// Everything that was found out about one model.
struct Examination {
  State states = 0;
  Action actions = 0;
  double discount = 0;
  double eps = 0;
  double radius = 0;  ///< what the bounds use as eps: the largest distance inside a ball
  ModelConstants<double> constants;
  double lipschitz_of_q_star = 0;  ///< L*
  double trivial = 0;              ///< gamma span(R)/(1-gamma): what a bound must beat to say anything
  Fate fate = Fate::undetermined;
  long period = 0;
  long periodic_from = -1;  ///< the round from which the pairs repeat, when the fate is known
  long enclosed_from = -1;  ///< the round from which it is known within bounds what Q_n does, where the fate is not
  long iterations = 0;
  long pairs = 0;                         ///< distinct policy pairs met
  State largest_ball = 0;                 ///< states in it
  bool attack_changes_action = false;     ///< in some round, in some state
  bool pessimism_changes_action = false;  ///< maximin and greedy differ in some round, at some observation
  double gap = 0;                         ///< limsup of max (Q* - Q^{pi_n, best attack}), when the fate is known
  long belief_positions = 0;              ///< reachable (state, belief) pairs, for claim F
  std::string failed_assumption;          ///< empty: all hold
  std::array<Check, claim_count> checks;

  const Check& check(ClaimId id) const { return checks[static_cast<std::size_t>(id)]; }
  Check& check(ClaimId id) { return checks[static_cast<std::size_t>(id)]; }
  bool any(Verdict verdict) const;
  /// Whether the claim's bound says anything on this model: least right side below `trivial`.
  bool informative(ClaimId id) const;
};

/// Checks every claim on one model, the finite-n ones at every n, against certified values.
/// Throws InputError when model and perturbation do not match, or rewards, constants or eps are so large that a bound
/// overflows; Interrupted when `options.stop` is raised.
Examination examine(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                    const ExaminationOptions& options = {});

}  // namespace maximin
