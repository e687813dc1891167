#pragma once

#include <string>

#include <maximin/counterexamples/non_contraction.hpp>

namespace maximin::apps {

/// The exact value of a decimal ("0.95") or a fraction ("10/11") of at most 15 digits each. Throws InputError unless it
/// is one and 0 <= gamma < 1.
non_contraction::Fraction parse_discount(const std::string& text);

/// "10/11", or "0" for zero.
std::string fraction_text(const non_contraction::Fraction& value);

}  // namespace maximin::apps
