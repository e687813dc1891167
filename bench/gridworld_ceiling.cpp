#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_control.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/aggregators.hpp>
#include <maximin/theory/policies.hpp>

/// How well a belief agent can do on the lattice of the Gridworld when the attacker is optimal, and how well acting on
/// a clean Q* does:
///
///     gridworld_ceiling [STEPS_PER_MOVE [EPS [MAX_POSITIONS]]]     lattice spacing 0.5/STEPS_PER_MOVE, default 1, 0.5
///
/// With MAX_POSITIONS policies are played against the optimal attacker too.
namespace maximin {
namespace {

struct Line {
  double mean, least;
};

/// Over starts.
Line over_starts(const Model<double>& model, const Values<double>& v) {
  Line line{0, v.maxCoeff()};
  for (State s = 0; s < model.mdp.states(); ++s) {
    const double start = model.start[static_cast<std::size_t>(s)];
    line.mean += start * v[s];
    if (start > 0) line.least = std::min(line.least, v[s]);
  }
  return line;
}

void print(const std::string& what, const Line& line, long beliefs, double seconds) {
  fmt::print("{:<58} mean {:>8.2f}  worst start {:>8.2f}  beliefs {:>8}  {:.1f} s\n", what, line.mean, line.least,
             beliefs, seconds);
  std::fflush(stdout);
}

template <class Call>
auto timed(Call&& call) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = call();
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  return std::pair(std::move(result), seconds.count());
}

template <class Agg>
BeliefPolicy aggregating(QTable<double> q, Agg aggregate) {
  return [q = std::move(q), aggregate, scratch = std::vector<double>()](std::span<const State> belief) mutable {
    return belief_action(q, belief, scratch, aggregate);
  };
}

void report(const GridworldLatticeOptions& options, long max_positions) {
  constexpr long max_beliefs = 10'000'000;
  const auto model = gridworld_lattice(options);
  const auto balls = make_perturbation(model);
  fmt::print("lattice of spacing {:.4f}, {} states, eps {}\n", options.spacing, model.mdp.states(), options.eps);
  const auto [total, total_seconds] =
      timed([&] { return guaranteed_value(model.mdp, balls, {.steps = 100, .max_beliefs = max_beliefs}); });
  print("sure, total of 100 steps", over_starts(model, total.v), total.beliefs, total_seconds);
  const auto [sure, sure_seconds] =
      timed([&] { return guaranteed_value(model.mdp, balls, {.max_beliefs = max_beliefs}); });
  print("sure, discounted", over_starts(model, sure.v), sure.beliefs, sure_seconds);
  const auto clean = policy_iteration(model.mdp);
  print("optimal without attack, discounted", over_starts(model, clean.v), 0, 0);
  if (max_positions == 0) return;
  const auto play = [&](const std::string& name, const BeliefPolicy& policy) {
    const auto [game, seconds] =
        timed([&] { return solve_belief_game(model.mdp, balls, policy, {.max_positions = max_positions}); });
    print(name + " against the optimal attacker, discounted", over_starts(model, game.v), game.beliefs, seconds);
  };
  play("sure policy", guaranteed_policy(model.mdp, sure));
  play("min of Q*", aggregating(clean.q, MinAggregator{}));
  play("mean of Q*", aggregating(clean.q, MeanAggregator{}));
}

}  // namespace
}  // namespace maximin

int main(int argc, char** argv) {
  maximin::GridworldLatticeOptions options;
  if (argc > 1) options.spacing = 0.5 / std::atoi(argv[1]);
  if (argc > 2) options.eps = std::atof(argv[2]);
  maximin::report(options, argc > 3 ? std::atol(argv[3]) : 0);
}
