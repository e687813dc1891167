#pragma once

#include <utility>
#include <vector>

#include <maximin/proofs_check/claims.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// What a model comes to round by round: gap[n] = max (Q* - Q^{pi_n, best attack}), and the bounds on it.
struct RoundSeries {
  std::vector<double> gap;
  std::vector<std::pair<ClaimId, std::vector<double>>> bounds;  ///< each as long as `gap`
};

/// Runs pessimistic Q-iteration as `examine` does and keeps every round: the gap, and the finite-n bounds C and D.
/// Empty when a Lipschitz constant is infinite, for then there is no bound to show.
/// Throws BudgetExhausted when a solver runs out.
RoundSeries round_series(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation,
                         const ExaminationOptions& options = {});

}  // namespace maximin
