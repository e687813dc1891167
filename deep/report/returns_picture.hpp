#pragma once

#include <string>
#include <string_view>

#include <maximin/deep/report/results.hpp>

namespace maximin::deep {

/// Style that the pictures need besides the page's own.
std::string_view returns_style();

/// One picture per column of the block: each agent's mean with its interval, the mean of each training seed, the
/// paper's figure and the target. HTML; empty where no cell of the block has run.
std::string returns_pictures(const ResultBlock& block);

}  // namespace maximin::deep
