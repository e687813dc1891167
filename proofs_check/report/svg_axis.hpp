#pragma once

#include <string>
#include <vector>

namespace maximin::report {

struct Tick {
  double value;
  std::string label;
};

/// Where a value falls between the two ends of a picture, and the round numbers to write there. The ends are round
/// numbers themselves, at or beyond those asked for.
class Axis {
 public:
  /// About `about` steps of 1, 2 or 5 times a power of ten. Ends that are not finite or not in order become 0 and 1.
  static Axis linear(double low, double high, int about = 5);

  /// Decades; steps of 1, 2 and 5 when there are at most two of them. Ends that are not positive, finite and in order
  /// become 0.1 and 1. With `zero`, the first eighth of the axis is kept for values that have no logarithm or lie below
  /// the lowest tick, under a tick "0".
  static Axis logarithmic(double low, double high, bool zero = false);

  /// 0 at the low end, 1 at the high end; values beyond an end are drawn at it.
  double at(double value) const;
  /// Whether `value` has a place of its own, above the zero band and within the ends.
  bool shows(double value) const;

  double low() const { return low_; }
  double high() const { return high_; }
  bool is_logarithmic() const { return logarithmic_; }
  /// The tick "0" of a logarithmic axis with a zero band is among them, first.
  const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  double low_ = 0, high_ = 1;
  bool logarithmic_ = false;
  double band_ = 0;  ///< share of the axis kept for zero
  std::vector<Tick> ticks_;
};

}  // namespace maximin::report
