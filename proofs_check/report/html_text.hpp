#pragma once

#include <string>
#include <string_view>

namespace maximin::report {

/// Text for a page: `& < > " '` escaped, control characters and broken UTF-8 replaced by U+FFFD, so that a page stays
/// well-formed whatever a model is called.
std::string escape(std::string_view text);

/// 12345 -> "12,345".
std::string count(long n);

/// Three significant digits for a person: "0.123", "12.3", "1.23e-7"; "not finite" for NaN and infinity.
std::string number(double x);

/// A share: "61%", "4.2%", "<0.1%"; never "0%" or "100%" unless it is exactly that; "-" of nothing.
std::string percent(long part, long whole);

/// "1 trial", "2 trials".
std::string counted(long n, std::string_view singular, std::string_view plural);

}  // namespace maximin::report
