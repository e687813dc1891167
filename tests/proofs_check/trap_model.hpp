#pragma once

#include <utility>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>

#include "../theory/small_models.hpp"

namespace maximin {

/// A model on which the factor 2 eps is used to fifteen sixteenths: states at 0, 1, 2 and 10 on a line, eps = 1,
/// gamma = 1/4, and whatever is done leads to state 0, so that l_p = 0 and every table has the constant l_r = 1.
///
///     x            0     1     2    10
///     action 0     1     0    -1    -9
///     action 1   -7/8  -7/8  -7/8  -7/8
///     action 2    -9    -8    -7     1
///
/// In state 0 action 0 is best by 15/8. Shown state 1, a maximin agent must reckon with state 2, where action 0 pays
/// -1, and takes action 1. Action 2 is what it does in state 10 only.
inline FiniteMdp<double> trap() {
  const double rewards[4][3] = {{1, -0.875, -9}, {0, -0.875, -8}, {-1, -0.875, -7}, {-9, -0.875, 1}};
  FiniteMdpBuilder<double> b(4, 3, 0.25);
  for (State s = 0; s < 4; ++s) {
    for (Action a = 0; a < 3; ++a) b.reward(s, a, rewards[s][a]).transition(s, a, 0, 1);
  }
  return std::move(b).build();
}

inline Perturbation<double> trap_balls(double eps = 1) {
  return on_line<double>({0, 1, 2, 10}, eps);
}

/// What action 0 is better by in state 0.
inline constexpr double trap_loss = 1.875;

}  // namespace maximin
