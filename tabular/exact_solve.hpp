#pragma once

#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/rational.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// A system x(i) = reward(i) + gamma sum_j p(i,j) x(j), 0 <= gamma < 1, of rows that sum to 1: one reward and one row
/// of successors per unknown. It has exactly one solution.
struct ExactSystem {
  Rational discount;
  std::vector<Rational> rewards;
  std::vector<std::vector<Successor<Rational>>> rows;  ///< targets in any order, each once
};

/// The exact solution, by p-adic lifting (FLINT's Dixon solver) on the system with its denominators cleared. Cubic in
/// the number of unknowns for the one inverse modulo a prime, and dense: meant for up to a few thousand.
/// Throws BudgetExhausted for more than `max_exact_unknowns`.
Values<Rational> solve_exactly(const ExactSystem& system);

inline constexpr std::size_t max_exact_unknowns = 4000;

}  // namespace maximin
