#include <maximin/proofs_check/check.hpp>

#include <algorithm>
#include <cmath>

namespace maximin {
namespace {

double certain_ratio(double left, double right, double slack) {
  constexpr double violated = std::numeric_limits<double>::infinity();
  if (!std::isfinite(left) || !std::isfinite(right) || !std::isfinite(slack)) return violated;
  const double certain = left - slack;
  if (certain <= 0) return right + slack >= left ? 0 : violated;
  return right > 0 ? certain / right : violated;
}

}  // namespace

void Check::observe(double l, double r, double s, long round, const Place& where) {
  const double ratio = certain_ratio(l, r, s);
  if (instances++ == 0 || ratio > tightness()) {
    left = l;
    right = r;
    slack = s;
    n = round;
    place = where;
  }
  least_right = std::min(least_right, r);
  if (ratio > 1) {
    verdict = Verdict::violated;
  } else if (verdict == Verdict::not_asked) {
    verdict = Verdict::holds;
  }
}

void Check::undecided() {
  if (verdict != Verdict::violated) verdict = Verdict::undetermined;
}

double Check::tightness() const {
  return certain_ratio(left, right, slack);
}

}  // namespace maximin
