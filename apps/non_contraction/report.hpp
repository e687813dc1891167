#pragma once

#include <string>

#include <maximin/counterexamples/non_contraction.hpp>

namespace maximin::apps {

/// The counterexample at one discount, for a person.
std::string non_contraction_text(const non_contraction::Fraction& gamma);

/// The same for a program: one JSON object.
std::string non_contraction_json(const non_contraction::Fraction& gamma);

}  // namespace maximin::apps
