#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

/// The parts that every report has.
namespace maximin::report {

/// The whole document around `body`, with the style sheet inside. `title` is plain text; `further_style` is CSS that a
/// page needs besides.
std::string page(std::string_view title, std::string_view body, std::string_view further_style = "");

/// The box with the verdict. `kind` is "", "bad" or "warn"; sentences are HTML, the first one large.
std::string verdict_box(std::string_view kind, const std::vector<std::string>& sentences);

/// A figure to take in at a glance: a large number and what it counts, both plain.
struct Tile {
  std::string number;
  std::string text;
  bool bad = false;
};
std::string tiles(const std::vector<Tile>& tiles);

/// Names and values in two columns, both plain.
std::string facts(const std::vector<std::pair<std::string, std::string>>& rows);

/// The last section: the configuration, as indented JSON.
std::string configuration_section(const nlohmann::ordered_json& configuration);

/// What the letters in statements and pictures stand for.
std::string notation();

/// Which reading of Assumption 2 the configuration asked for, as half a sentence.
std::string reading_of(const nlohmann::ordered_json& configuration);

/// Whether the configuration asked for exact arithmetic.
bool is_exact(const nlohmann::ordered_json& configuration);

/// What is to be said of claims that hold if the configuration is pedantic and the run was not exact; else nothing.
std::string doubt_of(const nlohmann::ordered_json& configuration);

}  // namespace maximin::report
