#include <algorithm>
#include <cmath>
#include <string>

#include <maximin/deep/losses/perturbation_ramp.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {

double PerturbationRamp::share(const Progress& progress) const {
  if (progress.fraction >= end) return 1;
  if (progress.fraction <= start) return 0;
  const double t = (progress.fraction - start) / (end - start);
  if (shape == Shape::linear) return t;
  // a t^4 up to m, then its tangent there, which ends in 1.
  constexpr double m = 0.25;
  constexpr double cube = m * m * m;
  constexpr double a = 1 / (cube * m + 4 * cube * (1 - m));
  return t <= m ? a * std::pow(t, 4) : std::min(1.0, a * cube * (m + 4 * (t - m)));
}

void PerturbationRamp::check(const char* where) const {
  const std::string loss = where;
  if (!(eps >= 0 && std::isfinite(eps)))
    throw InputError(loss + ": eps " + std::to_string(eps) + ", expected finite and at least 0");
  if (!(start >= 0 && start <= end && end <= 1))
    throw InputError(loss + ": a ramp from " + std::to_string(start) + " to " + std::to_string(end) +
                     ", expected 0 <= start <= end <= 1");
  if (!(range.low <= range.high)) throw InputError(loss + ": an empty range of states, expected low <= high");
}

}  // namespace maximin::deep
