#pragma once

#include <string>

#include <maximin/theory/rational.hpp>

namespace maximin::verify_bound {

/// x in six digits, however large it is.
std::string six_digits(const Rational& x);

}  // namespace maximin::verify_bound
