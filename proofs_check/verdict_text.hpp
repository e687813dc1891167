#pragma once

#include <string>
#include <string_view>

#include <maximin/models/model.hpp>
#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin {

/// What an examination or a campaign comes to.
enum class Outcome { holds, violated, undetermined, assumption_fails };

/// What a campaign comes to: violated before everything; undetermined when it was interrupted or every
/// bound was vacuous, for then nothing was verified, or when what holds is doubted.
Outcome outcome(const CampaignSummary& summary, bool complete, const ExaminationOptions& options = {});

/// The same for one model. A vacuous bound that holds, holds.
Outcome outcome(const Examination& examination, const ExaminationOptions& options = {});

/// A campaign for a person to read: a table of claims, fates, regimes, and the verdict last. `draw` are the options of
/// verify_bound that draw its models, e.g. "--seed 1 --family broad".
std::string verdict_text(const CampaignSummary& summary, const ExaminationOptions& options, std::string_view draw,
                         bool complete);

/// One model for a person to read, called `title`: constants with the pairs of states that attain them, every claim
/// with both sides and where it is tightest, states and actions by the model's names, and the verdict last.
template <class Scalar>
std::string verdict_text(std::string_view title, const Model<Scalar>& model, const Examination& found,
                         const ExaminationOptions& options);

/// What the claims state, in their order, with their references and the symbols that they use.
std::string claims_text();

}  // namespace maximin
