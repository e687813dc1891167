#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

/// JSON that anybody may have written, as a document in memory.
namespace maximin {

/// The document. Throws InputError, "WHERE: what is wrong, expected EXPECTED", where the text is no JSON or nested
/// deeper than `most_levels`: whoever copies, prints or destroys a document may do so by recursion.
nlohmann::ordered_json parse_json(std::string_view text, int most_levels, const std::string& where,
                                  std::string_view expected);

/// A value as it stands in a document, short enough for a line.
std::string excerpt(const nlohmann::ordered_json& value);

/// The first member in which two configurations differ, in words. They do differ.
std::string first_difference(const nlohmann::ordered_json& there, const nlohmann::ordered_json& now);

}  // namespace maximin
