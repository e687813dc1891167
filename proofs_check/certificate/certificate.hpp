#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model.hpp>
#include <maximin/proofs_check/certificate/boxes.hpp>
#include <maximin/proofs_check/check.hpp>
#include <maximin/proofs_check/claims.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/theory/lipschitz.hpp>
#include <maximin/theory/rational.hpp>

/// What docs/certificate-format.md describes, as it is made: member names here are those of the page.
namespace maximin {

/// A policy pair that some round uses, with its exact values.
struct CertifiedPair {
  PolicyPair policies;
  Values<Rational> fixed;   ///< when the attack of the pair attacks
  Values<Rational> robust;  ///< against the optimal attacker of the policy
};

/// What every round from N on does, in phases of the period.
struct CertifiedLimit {
  long period = 0;
  QTable<int> classes;                  ///< |S| x |A|: entries whose Q_n stay equal for ever have equal numbers
  Rational radius;                      ///< Q_N lies this near to the orbit; policies cannot change within
  std::vector<Values<Rational>> orbit;  ///< U_j, by phase
  std::vector<Values<Rational>> low;    ///< below the values of every policy the phase may use
  std::vector<std::optional<Values<Rational>>> fixed;  ///< of the policy pair of the phase, where it is one
  /// By phase, whether `low` are the values of its policy against the optimal attacker: no choices tie, or k = 1.
  std::vector<bool> attained;
  Rational gap;  ///< max over the phases of Q* less `low`: not written

  bool all_attained() const;
};

/// The game of the belief-maximin agent against any attacker.
struct CertifiedBeliefGame {
  std::vector<std::pair<State, Belief>> positions;
  Values<Rational> values;
  Rational reach;
  bool exact = true;  ///< otherwise `values` are lower bounds
};

/// A claim and its tightest instance.
struct CertifiedClaim {
  ClaimId id{};
  Verdict verdict = Verdict::undetermined;  ///< holds, violated or undetermined
  Rational left, right;
  long n = -1;                ///< the round, or N + the phase; -1 where the claim has none
  std::vector<State> states;  ///< none, one, or a pair
  Action action = -1;
};

struct Certificate {
  explicit Certificate(Model<Rational> of) : model(std::move(of)) {}

  Model<Rational> model;  ///< with points or distances, and eps
  Reading reading = Reading::corrected;
  TieBreak tie = TieBreak::lowest_index;
  ModelConstants<Rational> constants;
  LipschitzConstant<Rational> l_star;
  Values<Rational> optimal;
  std::vector<CertifiedPair> pairs;
  std::vector<int> rounds;  ///< index into pairs by n
  std::optional<CertifiedLimit> limit;
  std::optional<BoxLimit> boxes;  ///< in the place of the limit, where it is not decided
  Policy test_time_policy;
  Values<Rational> test_time_robust;
  std::optional<CertifiedBeliefGame> belief_game;
  std::vector<CertifiedClaim> claims;

  // Not written: what a campaign counts, and why there is no limit.
  bool ties_open = false;  ///< Q_n came near an orbit on which differences that vanish decide between choices
  State largest_ball = 0;
  bool pessimism_changes_action = false;  ///< maximin and greedy differ in some round, at some observation

  bool any(Verdict verdict) const;
};

struct CertifyOptions {
  Reading reading = Reading::corrected;
  TieBreak tie = TieBreak::lowest_index;
  std::optional<std::set<ClaimId>> only = {};  ///< absent: all
  long max_rounds = 2'000;                     ///< of pessimistic Q-iteration
  long max_period = 64;
  long rounds_before_boxes = 500;  ///< without an orbit, boxes are tried after these, twice these, ...
  long max_bits = 100'000;         ///< of the denominator of Q_n: more cost too much, and the limit is undetermined
  long max_positions = 20'000;   ///< (state, belief) pairs of claim F that are listed; others have a value that is sure
  long max_pair_states = 2'000;  ///< Lemma 1 looks at pairs of states; of more states it is undetermined
  long max_exact_positions = 150;           ///< more have lower bounds in the place of exact values
  const std::atomic<bool>* stop = nullptr;  ///< raised from elsewhere: ends with Interrupted
  /// Told what is begun, e.g. "round", and of which n, or -1.
  std::function<void(const char* stage, long n)> progress = {};

  bool wants(ClaimId id) const { return !only || only->contains(id); }
  /// Throws Interrupted when it is to stop.
  void poll() const;
  /// Tells what is begun. Throws Interrupted when it is to stop.
  void begin(const char* stage, long n = -1) const;
};

/// Proves the claims on one model, exactly. Throws AssumptionFails where no Lipschitz constant exists, BudgetExhausted
/// where the model is too large for exact solves, InputError as `make_perturbation`, Interrupted when asked to stop.
Certificate certify(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides = {},
                    const CertifyOptions& options = {});

/// The certificate as JSON, ending in a line break.
std::string certificate_json(const Certificate& certificate);

}  // namespace maximin
