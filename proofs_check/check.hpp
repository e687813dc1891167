#pragma once

#include <limits>

#include <maximin/theory/types.hpp>

namespace maximin {

/// What a check came to.
enum class Verdict {
  holds,
  violated,
  undetermined,      ///< a budget ran out before both sides were known
  assumption_fails,  ///< the model breaks an assumption of the claim
  not_asked,
};

/// Where an instance of a claim stands; -1 for what it does not have.
struct Place {
  State state = -1;    ///< s
  State other = -1;    ///< the second state of a pair
  Action action = -1;  ///< a
};

/// One claim on one model: `left <= right` was wanted, and counts as seen while left <= right + slack.
/// Of all its instances (rounds n, pairs of states, actions) the tightest is kept.
struct Check {
  Verdict verdict = Verdict::not_asked;
  double left = 0;
  double right = 0;
  double slack = 0;  ///< certified numerical error of both sides together
  long n = -1;       ///< the round of the tightest instance, or -1 where there is none
  double least_right = std::numeric_limits<double>::infinity();  ///< over all instances: the bound at its best n
  long instances = 0;

  Place place;  ///< where the tightest instance stands

  /// Takes one instance into account. NaN or infinity on any side is a violation.
  void observe(double l, double r, double s, long round = -1, const Place& where = {});

  /// Takes into account that an instance could not be decided. A violation elsewhere still counts.
  void undecided();

  /// (left - slack)/right: what is certain of left/right. Above 1 exactly when the instance is violated; infinite for a
  /// violation with right = 0 or a side that is not finite; 0 when left is within the slack of 0.
  double tightness() const;
};

}  // namespace maximin
