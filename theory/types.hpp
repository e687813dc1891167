#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

namespace maximin {

/// Index of a state, 0 <= s < |S|.
using State = std::int32_t;
/// Index of an action, 0 <= a < |A|.
using Action = std::int32_t;

/// A function of (state, action), |S| x |A|, one row per state: the paper's Q, or R.
template <class Scalar>
using QTable = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A function of the state, |S| entries: the paper's V.
template <class Scalar>
using Values = Eigen::Matrix<Scalar, Eigen::Dynamic, 1>;

/// The agent's stationary deterministic policy pi: policy[t] is the action taken when t is *observed*.
using Policy = std::vector<Action>;

/// The attacker's stationary deterministic policy omega: attack[s] is what the agent is shown when s is *true*.
using AttackPolicy = std::vector<State>;

/// Which index wins when several attain an argmax or argmin. The paper leaves it open; every result must hold for both.
enum class TieBreak { lowest_index, highest_index };

/// Whether arithmetic on the scalar is exact, so that comparisons need no slack at all.
/// An exact scalar (a rational) specialises it.
template <class Scalar>
inline constexpr bool is_exact_v = std::numeric_limits<Scalar>::is_exact;

/// Relative distance between 1 and the next scalar; zero where arithmetic is exact.
template <class Scalar>
Scalar unit_roundoff() {
  if constexpr (is_exact_v<Scalar>) {
    return Scalar(0);
  } else {
    return std::numeric_limits<Scalar>::epsilon();
  }
}

}  // namespace maximin
