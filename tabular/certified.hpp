#pragma once

#include <cmath>
#include <limits>

#include <maximin/theory/error.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// Values together with a proof of how far off they may be: |q - exact| <= error and |v - exact| <= error in every
/// entry. The error counts the iterations that were not made and the rounding of those that were.
template <class Scalar>
struct CertifiedSolution {
  QTable<Scalar> q;  ///< |S| x |A|
  Values<Scalar> v;  ///< |S|
  Policy policy;     ///< the action taken in each true state; greedy for values within `error`
  Scalar error{0};   ///< in the maximum norm, same unit as the rewards
  long sweeps = 0;   ///< passes over the transitions
};

/// When to stop, and when to give up.
struct SolverOptions {
  /// Certified error to reach, as a fraction of max|R|/(1-gamma). Zero: 1e-12, or what rounding allows if that is more.
  double tolerance = 0;
  /// Passes over the transitions before BudgetExhausted is thrown.
  long max_sweeps = 10'000'000;
  /// Which action counts as greedy among equals.
  TieBreak tie = TieBreak::lowest_index;
};

/// Turns v and one application of a Bellman operator to it into bounds on the operator's fixed point, following
/// MacQueen
/// ("A modified dynamic programming method for Markovian decision problems", 1966). If m <= (Tv - v)(s) <= M for all s
/// then
///
///     Tv + gamma m/(1-gamma)  <=  fixed point  <=  Tv + gamma M/(1-gamma),
///
/// for every operator that is monotone and turns v + c into Tv + gamma c: T*, T^{pi o omega} and T^{pi}_rob alike. The
/// bounds are widened for rounding in the computed Tv and for rows that sum to 1 only to rounding.
template <class Scalar>
class MacQueenBound {
 public:
  explicit MacQueenBound(const FiniteMdp<Scalar>& mdp) : gamma_(mdp.discount()) {
    std::size_t longest = 0;
    Scalar defect(0);
    for (State s = 0; s < mdp.states(); ++s) {
      for (Action a = 0; a < mdp.actions(); ++a) {
        const auto row = mdp.successors(s, a);
        Scalar sum(0);
        for (const auto& next : row) sum += next.probability;
        defect = std::max(defect, Scalar(std::abs(sum - Scalar(1))));
        longest = std::max(longest, row.size());
      }
    }
    const Scalar u = unit_roundoff<Scalar>();
    row_defect_ = defect + static_cast<Scalar>(longest) * u;
    relative_rounding_ = static_cast<Scalar>(longest + 4) * u;
    largest_reward_ = mdp.rewards().cwiseAbs().maxCoeff();
    if (!std::isfinite(Scalar(4) * scale() / (Scalar(1) - gamma_))) {
      throw InputError("rewards: so large that values overflow, expected smaller rewards or another unit");
    }
    if (!(gamma_ * (Scalar(1) + row_defect_) < Scalar(1))) {
      throw InputError("discount: too close to 1 for rows that sum to 1 only to rounding, expected a smaller discount");
    }
  }

  /// Where the fixed point lies: within `error` of tv + shift.
  struct Interval {
    Scalar shift;
    Scalar error;
  };

  /// From v and the computed tv = Tv.
  Interval operator()(const Values<Scalar>& v, const Values<Scalar>& tv) const {
    const Scalar rounding = rounding_of_backup(v.cwiseAbs().maxCoeff());
    const Scalar low = tail((tv - v).minCoeff() - rounding, /*upper=*/false);
    const Scalar high = tail((tv - v).maxCoeff() + rounding, /*upper=*/true);
    const Scalar shift = (low + high) / Scalar(2);
    const Scalar addition = unit_roundoff<Scalar>() * (tv.cwiseAbs().maxCoeff() + std::abs(shift)) * Scalar(2);
    return {shift, (high - low) / Scalar(2) + rounding + addition};
  }

  /// How far a computed backup R + gamma P v may be from the exact one when |v| <= size.
  Scalar rounding_of_backup(const Scalar& size) const {
    return relative_rounding_ * (largest_reward_ + gamma_ * size * (Scalar(1) + row_defect_));
  }

  /// max|R|/(1-gamma): no value is larger.
  Scalar scale() const { return largest_reward_ / (Scalar(1) - gamma_); }

  /// The certified error that `options` asks for, never below what rounding allows.
  Scalar target(const SolverOptions& options) const {
    if (options.tolerance > 0) return static_cast<Scalar>(options.tolerance) * scale();
    const Scalar floor = Scalar(4) * rounding_of_backup(scale()) / (Scalar(1) - gamma_);
    return std::max({Scalar(1e-12) * scale(), floor, std::numeric_limits<Scalar>::min()});
  }

 private:
  /// sum_{i>=1} gamma^i c, rounded outwards over the possible row sums.
  Scalar tail(const Scalar& c, bool upper) const {
    const Scalar outward = (c > Scalar(0)) == upper ? Scalar(1) + row_defect_ : Scalar(1) - row_defect_;
    const Scalar g = gamma_ * outward;
    const Scalar sum = g / (Scalar(1) - g) * c;
    const Scalar slack = Scalar(4) * unit_roundoff<Scalar>() * std::abs(sum);
    return upper ? sum + slack : sum - slack;
  }

  Scalar gamma_;
  Scalar row_defect_{0};
  Scalar relative_rounding_{0};
  Scalar largest_reward_{0};
};

}  // namespace maximin
