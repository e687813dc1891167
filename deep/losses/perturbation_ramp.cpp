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

void PerturbationRamp::check(const RangeCheck& require) const {
  require(eps >= 0 && std::isfinite(eps), "eps", eps, "finite and at least 0");
  require(start >= 0 && start <= end, "the ramp's start", start, "0 to its end");
  require(end <= 1, "the ramp's end", end, "1 at most");
  require(range.low <= range.high, "the lower end of the states", range.low, "the upper one at most");
}

}  // namespace maximin::deep
