#include <maximin/tabular/finite_horizon.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

#include <fmt/format.h>

#include <maximin/tabular/certified.hpp>
#include <maximin/tabular/position_graph.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

void require_steps(long steps) {
  if (steps < 0) throw InputError(fmt::format("steps: {}, expected 0 or more", steps));
}

/// A value of n steps is at most n max|R|. Each step rounds a product and a sum per successor and one sum more, and the
/// probabilities may sum to 1 only up to as much.
template <class Scalar>
Scalar rounding(const FiniteMdp<Scalar>& mdp, long steps) {
  std::size_t longest = 0;
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) longest = std::max(longest, mdp.successors(s, a).size());
  }
  const auto n = static_cast<Scalar>(steps);
  return static_cast<Scalar>(3 * longest + 2) * unit_roundoff<Scalar>() * n * n * mdp.rewards().cwiseAbs().maxCoeff();
}

/// V_{k+1}(s) = best_of(s, q) with q(a) the value of action a when k steps are left after it.
template <class Scalar, class BestOf>
ValuesInSteps<Scalar> backwards(const FiniteMdp<Scalar>& mdp, long steps, BestOf best_of) {
  require_steps(steps);
  ValuesInSteps<Scalar> result;
  result.error = rounding(mdp, steps);
  result.v.push_back(Values<Scalar>::Zero(mdp.states()));
  for (long k = 0; k < steps; ++k) {
    const Values<Scalar>& later = result.v.back();
    Values<Scalar> now(mdp.states());
    for (State s = 0; s < mdp.states(); ++s) {
      now[s] = best_of(s, [&](Action a) { return mdp.reward(s, a) + mdp.expectation(s, a, later); });
    }
    result.v.push_back(std::move(now));
  }
  return result;
}

template <class Scalar>
void sweep(const internal::PositionGraph<Scalar>& graph, const Values<Scalar>& later, Values<Scalar>& now) {
  now.resize(later.size());
  Eigen::Index i = 0;
  for (const auto& position : graph.positions()) {
    const auto& move = position.moves.front();
    Scalar sum = move.reward;
    for (const auto& branch : move.branches) sum += branch.probability * internal::worst(later, branch.answers);
    now[i++] = sum;
  }
}

}  // namespace

template <class Scalar>
ValuesInSteps<Scalar> optimal_in_steps(const FiniteMdp<Scalar>& mdp, long steps) {
  return backwards(mdp, steps, [&](State, const auto& q) {
    Scalar most = q(0);
    for (Action a = 1; a < mdp.actions(); ++a) most = std::max(most, q(a));
    return most;
  });
}

template <class Scalar>
ValuesInSteps<Scalar> attacked_in_steps(const FiniteMdp<Scalar>& mdp, const Perturbation<Scalar>& perturbation,
                                        const Policy& policy, long steps) {
  return backwards(mdp, steps, [&](State s, const auto& q) {
    const auto ball = perturbation.ball(s);
    Scalar least = q(policy[static_cast<std::size_t>(ball.front())]);
    for (const State t : ball) least = std::min(least, q(policy[static_cast<std::size_t>(t)]));
    return least;
  });
}

template <class Scalar>
BeliefGameInSteps<Scalar> solve_belief_game_in_steps(const FiniteMdp<Scalar>& mdp,
                                                     const Perturbation<Scalar>& perturbation,
                                                     const BeliefPolicy& policy, long steps,
                                                     const BeliefGameOptions& options) {
  require_steps(steps);
  const internal::PositionGraph<Scalar> graph(
      mdp, perturbation, [&](std::span<const State> belief) { return std::vector{policy(belief)}; },
      options.max_positions);
  if (!graph.complete()) {
    throw BudgetExhausted(
        fmt::format("belief game: more than {} reachable (state, belief) pairs; allow more or take "
                    "a smaller model or eps",
                    options.max_positions));
  }
  const auto size = static_cast<Eigen::Index>(graph.positions().size());
  BeliefGameInSteps<Scalar> game;
  game.error = rounding(mdp, steps);
  game.positions = static_cast<long>(size);
  game.beliefs = graph.beliefs();
  Values<Scalar> later = Values<Scalar>::Zero(size), now;
  if (options.keep_positions) game.w.push_back(later);
  for (long k = 0; k < steps; ++k) {
    sweep(graph, later, now);
    if (options.keep_positions) game.w.push_back(now);
    later.swap(now);
  }
  game.v.resize(mdp.states());
  for (State s = 0; s < mdp.states(); ++s) game.v[s] = internal::worst(later, graph.starts(s));
  if (options.keep_positions) {
    int number = 0;
    for (const auto& p : graph.positions()) game.numbers.emplace(std::pair(p.truth, graph.belief(p)), number++);
  }
  return game;
}

template ValuesInSteps<double> optimal_in_steps(const FiniteMdp<double>&, long);
template ValuesInSteps<double> attacked_in_steps(const FiniteMdp<double>&, const Perturbation<double>&, const Policy&,
                                                 long);
template BeliefGameInSteps<double> solve_belief_game_in_steps(const FiniteMdp<double>&, const Perturbation<double>&,
                                                              const BeliefPolicy&, long, const BeliefGameOptions&);

}  // namespace maximin
