#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/deep/report/training_log.hpp>

namespace maximin::deep {

/// Style that the figures need besides the page's own.
std::string_view training_style();

/// What a training came to over its frames, one picture per column that is there (return, loss, exploration), with a
/// legend: per agent the mean over its seeds, and a band from the lowest to the highest. HTML; empty where there is
/// nothing to draw.
std::string training_figures(const std::vector<TrainingCurve>& curves);

/// The column at a number of frames, between two rows on the straight line between them; none before the first value
/// and after the last.
std::optional<double> value_at(const TrainingLog& log, std::size_t column, double frames);

}  // namespace maximin::deep
