#include "exact_text.hpp"

#include <cmath>

#include <fmt/format.h>

#include <maximin/apps/common/table.hpp>

namespace maximin::verify_bound {

std::string six_digits(const Rational& x) {
  const auto near = static_cast<double>(x);
  if (std::isfinite(near)) return apps::number(near);
  const std::string digits = Integer(abs(numerator(x)) / denominator(x)).str();
  return fmt::format("{}{}.{}e+{}", x < 0 ? "-" : "", digits[0], digits.substr(1, 5), digits.size() - 1);
}

}  // namespace maximin::verify_bound
