#pragma once

#include <optional>
#include <string>

#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/stackelberg.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::apps {

/// How far `solve --robust` goes.
struct RobustOptions {
  long max_iterations = 20'000;  ///< of pessimistic Q-iteration
  long max_positions = 100'000;  ///< of the belief game
  long max_policies = 100'000;   ///< of the Stackelberg enumeration
};

/// What pessimism, beliefs and attacks come to on one model.
struct RobustSolution {
  /// A stationary agent with the value that the optimal attacker leaves it.
  struct Agent {
    Policy policy;
    RobustEvaluation<double> attacked;
    double gap = 0;  ///< max_s V*(s) - V(s)
  };
  PessimisticQIteration<double> iteration;
  Agent greedy;                                          ///< of Q*
  Agent maximin;                                         ///< of Q*, over the ball
  Agent pessimistic;                                     ///< of the last Q_n
  std::optional<BeliefGameValue<double>> belief;         ///< maximin of Q* over the exact belief; absent: too large
  std::optional<StackelbergValues<double>> stackelberg;  ///< absent: too large
  std::string belief_unknown, stackelberg_unknown;       ///< why they are absent
};

RobustSolution solve_robust(const Problem& problem, const CertifiedSolution<double>& optimal,
                            const RobustOptions& options);

/// For people: what became of the iteration, then who loses what, then a table by state of at most `rows` rows.
std::string robust_text(const Problem& problem, const CertifiedSolution<double>& optimal, const RobustSolution& robust,
                        std::size_t rows);

/// For programs.
Json robust_json(const Problem& problem, const RobustSolution& robust);

}  // namespace maximin::apps
