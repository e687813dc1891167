#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace maximin {

/// The candidate that was probably meant by an unknown `word`: the one that it abbreviates or spells out, e.g. "eps"
/// for "epsilon", else the one that takes the fewest insertions, deletions and replacements, if those are few enough to
/// be a slip; else empty. Words longer than 64 bytes, which no name is, are never near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& candidates);

/// What to expect in the place of an unknown `word`: the candidate that was probably meant, else all, with commas.
std::string nearest_or_all(std::string_view word, const std::vector<std::string>& candidates);

}  // namespace maximin
