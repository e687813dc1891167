/// Exact optimal values of random rational models: 4 actions, 4 successors a row, weights 1 to 9, rewards in tenths,
/// gamma 19/20. One thread. `digits` is the length of the longest value's denominator.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <vector>

#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {
namespace {

FiniteMdp<Rational> rational_model(State n, std::uint64_t seed) {
  constexpr Action actions = 4;
  constexpr int successors = 4;
  Stream rng(seed);
  FiniteMdpBuilder<Rational> builder(n, actions, Rational(19, 20));
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      builder.reward(s, a, Rational(rng.integer(-30, 30), 10));
      std::vector<State> targets;
      while (targets.size() < successors) {
        const State t = rng.below(n);
        if (std::find(targets.begin(), targets.end(), t) == targets.end()) targets.push_back(t);
      }
      std::vector<int> weights;
      int total = 0;
      for (int k = 0; k < successors; ++k) total += weights.emplace_back(rng.integer(1, 9));
      for (std::size_t k = 0; k < targets.size(); ++k) {
        builder.transition(s, a, targets[k], Rational(weights[k], total));
      }
    }
  }
  return std::move(builder).build();
}

void exact_optimal_values(benchmark::State& state) {
  const auto mdp = rational_model(static_cast<State>(state.range(0)), 1);
  std::size_t digits = 0;
  for (auto _ : state) {
    const auto solution = policy_iteration(mdp);
    digits = denominator(solution.v[0]).str().size();
  }
  state.counters["digits"] = static_cast<double>(digits);
}
BENCHMARK(exact_optimal_values)->Arg(100)->Arg(200)->Arg(400)->Arg(800)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace maximin
