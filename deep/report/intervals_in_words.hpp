#pragma once

#include <optional>
#include <string>

#include <maximin/deep/report/results.hpp>

/// Words and numbers that the Markdown and the HTML table share. All plain text.
namespace maximin::deep {

/// A return for a person: "163", "−53.2", "0.012".
std::string return_text(double value);
/// A number that is given and not measured, in full: "171.9".
std::string exact_text(double value);

/// The half-width, or "not estimable".
std::string interval_text(const std::optional<ConfidenceInterval>& interval);

/// "163 (sd 26)".
std::string paper_text(const PaperFigure& paper);

/// What the numbers and intervals of this table are.
std::string intervals_in_words(const ResultTable& table);

}  // namespace maximin::deep
