#pragma once

#include <string>
#include <vector>

#include <maximin/deep/report/results.hpp>
#include <maximin/deep/report/trace.hpp>
#include <maximin/deep/report/training_log.hpp>

namespace maximin::deep {

/// The table as one HTML page that needs nothing else: no network, no script; light, dark and paper. What it comes to
/// in words, a coloured table and a picture of the intervals per block, training curves, episodes on the map,
/// configuration. Curves and traces may be empty. The same arguments give the same bytes.
std::string results_page(const ResultTable& table, const std::vector<TrainingCurve>& curves = {},
                         const std::vector<EpisodeTrace>& traces = {});

}  // namespace maximin::deep
