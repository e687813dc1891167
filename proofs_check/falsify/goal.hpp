#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <maximin/models/model.hpp>
#include <maximin/proofs_check/claims.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin {

/// What a search for counterexamples hunts: a model whose score is above a threshold.
struct Goal {
  std::string name;              ///< on command lines: a claim's, or one of the two below
  std::string title;             ///< a few words
  std::optional<ClaimId> claim;  ///< score: left/right of the claim's tightest instance, above 1 where it is violated
  double threshold = 1;          ///< a score above it is what is hunted
};

/// The claims, and
///   settling         score: the period of the policy pairs; above 1 pessimistic Q-iteration never settles
///   sharper-belief   score: how much more, of span(R)/(1-gamma), the maximin policy of Q* is worth on the ball than on
///                    the exact belief in some state, each against its optimal attacker; above 0 a sharper belief hurts
const std::vector<Goal>& goals();

/// The goal of that name, if there is one.
const Goal* find_goal(std::string_view name);

/// The score of a model with points and eps; negative infinity where it has none: an assumption fails, a budget runs
/// out. Rounding never lifts a score above its threshold: certified errors are taken off.
double score(const Goal& goal, const Model<double>& model, const ExaminationOptions& options);

/// What exact arithmetic says of the goal on the model in the decimals that its numbers stand for: `violated` where
/// what is hunted is there, e.g. pessimistic Q-iteration never settles, `holds` where it is not.
Verdict proved(const Goal& goal, const Model<double>& model, const ExaminationOptions& options);

}  // namespace maximin
