#pragma once

#include <string>

#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/examination.hpp>

namespace maximin {

/// Exit codes of the programs.
enum class ExitCode { holds = 0, violated = 1, bad_input = 2, undetermined = 3, assumption_fails = 4 };

/// What a campaign's result means to a shell: violated before everything; undetermined when it was interrupted or every
/// bound was vacuous, for then nothing was verified.
ExitCode exit_code(const CampaignSummary& summary, bool complete);

/// The same for one model. A vacuous bound that holds, holds.
ExitCode exit_code(const Examination& examination);

/// A campaign for a person to read: a table of claims, fates, regimes, and the verdict last.
std::string verdict_text(const CampaignSummary& summary, Reading reading, std::uint64_t seed, bool complete);

/// One model for a person to read: constants with the pairs of states that attain them, every claim with both sides,
/// and the verdict last.
std::string verdict_text(const TrialRecord& record, Reading reading);

}  // namespace maximin
