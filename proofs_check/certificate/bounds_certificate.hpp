#pragma once

#include <optional>
#include <string>
#include <vector>

#include <maximin/proofs_check/certificate/boxes.hpp>
#include <maximin/proofs_check/certificate/certificate.hpp>

/// The section "Certificates by bounds" of docs/certificate-format.md, as it is made: for models too large for exact
/// solves.
namespace maximin {

/// The policies of some round, as far as they are known, and what bounds their values.
struct BoundedPair {
  Choices choices;   ///< C_n(t), by observation
  Choices provoked;  ///< A_n(s), by true state
  PairBox values;
};

struct BoundsCertificate {
  explicit BoundsCertificate(Model<Rational> of) : model(std::move(of)) {}

  Model<Rational> model;  ///< with points, distances or a metric, and eps
  Reading reading = Reading::corrected;
  TieBreak tie = TieBreak::lowest_index;
  ModelConstants<Rational> constants;  ///< at most the model's own
  LipschitzConstant<Rational> l_star;  ///< at most that of Q*
  ValueBox optimal;                    ///< around V*
  long bits = 0;                       ///< of the grid that rounds are rounded to
  std::vector<BoundedPair> pairs;
  std::vector<int> rounds;  ///< index into pairs by n
  std::optional<BoxLimit> limit;
  ScaledValues test_time;  ///< below the value of the maximin policy of Q* against its optimal attacker
  std::optional<CertifiedBeliefGame> belief_game;
  std::vector<CertifiedClaim> claims;  ///< without lemma 3

  // Not written: what a campaign counts.
  State largest_ball = 0;
  bool pessimism_changes_action = false;  ///< for sure: at some observation maximin and greedy have no choice in common
  bool attack_changes_action = false;     ///< for sure: in some state no choice of its own can be provoked

  bool any(Verdict verdict) const;
};

/// Proves the claims on one model by bounds: what holds is proved; what the bounds do not show is undetermined. Throws
/// as `certify`, but for the size of the model.
BoundsCertificate certify_by_bounds(const Model<Rational>& model, const GeometryOverrides<Rational>& overrides = {},
                                    const CertifyOptions& options = {});

/// The certificate as JSON, ending in a line break.
std::string certificate_json(const BoundsCertificate& certificate);

}  // namespace maximin
