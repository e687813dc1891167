#pragma once

#include <string>
#include <vector>

#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/report/svg_plot.hpp>
#include <maximin/proofs_check/trial_record.hpp>

/// The pictures of a campaign, each with its caption as HTML. An empty string where there is nothing to draw.
namespace maximin::report {

using Records = std::vector<TrialRecord>;

/// The most points that one panel draws; beyond them every k-th is kept, and the caption says so.
inline constexpr std::size_t most_marks = 600;       ///< informative ones, with hover text
inline constexpr std::size_t most_violations = 300;  ///< crosses
inline constexpr std::size_t most_specks = 1500;     ///< vacuous ones, without

/// What one bound came to on every model, in units of the trivial bound gamma span(R)/(1-gamma).
struct GapAgainstBound {
  std::vector<Mark> informative, vacuous, violated;  ///< x the bound, y the gap; 0 where it is not above the slack
  long no_span = 0;                                  ///< left out: constant rewards, nothing can be lost
  long not_finite = 0;                               ///< left out: a side is NaN or infinite

  std::size_t size() const { return informative.size() + vacuous.size() + violated.size(); }
};

GapAgainstBound gap_against_bound(const Records& records, ClaimId id);

/// Check::tightness() of every model on which the claim was checked, sorted, without infinite ones.
std::vector<double> tightness_of(const Records& records, ClaimId id);

/// One panel per bound: gap against bound, both axes logarithmic, with the diagonal on which they are equal.
std::string scatter_figure(const Records& records);

/// Share of the models with left/right up to a value, one curve per claim: the bounds, then the steps of the argument.
/// Nothing of a single model, which has no distribution.
std::string tightness_figure(const Records& records);

/// One panel per bound: share of the models on which it is informative, over eps and gamma. Nothing of a single model.
std::string informativeness_figure(const Records& records);

/// What became of Q_n, and how often each regime occurred.
std::string fate_and_regime_figure(const CampaignSummary& summary);

}  // namespace maximin::report
