#pragma once

#include <string>

#include <maximin/deep/report/results.hpp>

namespace maximin::deep {

/// The table as Markdown: a table per block, mean +- half-width and the paper's figure in each cell, misses called so;
/// below, each cell's seeds, notes, and what the intervals are. Hostile names cannot break the table.
std::string markdown(const ResultTable& table);

/// One cell for a person: "163 ± 12", "not run", "163 ± 12 (one seed)".
std::string cell_text(const ResultCell& cell);

/// What the verdict is called: "met", "MISS", ...; empty for none.
std::string verdict_word(TargetVerdict verdict);

}  // namespace maximin::deep
