#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/proofs_check/campaign_summary.hpp>
#include <maximin/proofs_check/report/round_series.hpp>
#include <maximin/proofs_check/trial_record.hpp>

namespace maximin {

/// A campaign as one HTML page that needs nothing else: no network, no script; light, dark and paper. The verdict in
/// words comes first, then violations if there are any, a table of the claims, the pictures, and the configuration
/// last.
///
/// `configuration` is shown as it is; its "trials" and "reading" are used where present. `summary` must be
/// summarise(records). `replay_options` is what a command line needs to draw the same models, e.g.
/// "--seed 7 --family costs"; if empty, "--seed" with the configuration's "seed".
/// The same arguments give the same bytes. Thousands of trials stay below about a megabyte: see most_marks.
std::string html_report(const nlohmann::ordered_json& configuration, const std::vector<TrialRecord>& records,
                        const CampaignSummary& summary, std::string_view replay_options = "");

/// One model as such a page: verdict, both sides of every claim, the rounds if they are given, the model's constants.
std::string html_report(const nlohmann::ordered_json& configuration, const TrialRecord& record,
                        const RoundSeries& rounds = {});

}  // namespace maximin
