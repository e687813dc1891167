/// Solvers on the standard instances, all in one run, so that ratios can be read off. `plain` stops, as most programs
/// do, when no value moves by more than 1e-9; the others stop on a certificate of the error that this rule leaves,
/// gamma/(1-gamma) 1e-9. The counter `V*(0)` shows that they agree, `bytes` the transitions
/// read in a second (for policy sweeps, which read one row in |A|, an overcount).

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

#include <maximin/models/bench_instances.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/bellman.hpp>

namespace maximin {
namespace {

std::vector<FiniteMdp<double>> dense_batch() {
  std::vector<FiniteMdp<double>> batch;
  for (std::uint64_t k = 0; k < 100; ++k) batch.push_back(bench::dense_instance(200, 5, 0.9, 1000 + k));
  return batch;
}

/// Built on first use: the grid takes a second and 500 MB.
const std::vector<FiniteMdp<double>>& instance(int which) {
  static std::vector<FiniteMdp<double>> models[3];
  auto& model = models[which];
  if (model.empty()) {
    if (which == 0) model = dense_batch();
    if (which == 1) model.push_back(bench::sparse_instance(20000, 5, 10, 0.95, 42));
    if (which == 2) model.push_back(bench::grid_instance(1000, 1000, 0.95, 7));
  }
  return model;
}

constexpr const char* names[] = {"dense batch", "sparse", "grid"};

/// The error that the plain stopping rule leaves, as the solvers ask for it.
SolverOptions same_error(const FiniteMdp<double>& mdp) {
  SolverOptions options;
  options.tolerance = mdp.discount() * 1e-9 / mdp.rewards().cwiseAbs().maxCoeff();
  return options;
}

struct Answer {
  double value = 0;
  long sweeps = 0;
};

Answer plain_value_iteration(const FiniteMdp<double>& mdp) {
  Values<double> v = Values<double>::Zero(mdp.states()), tv(mdp.states());
  for (long sweep = 1;; ++sweep) {
    double change = 0;
    for (State s = 0; s < mdp.states(); ++s) {
      double best = -INFINITY;
      for (Action a = 0; a < mdp.actions(); ++a) {
        best = std::max(best, mdp.reward(s, a) + mdp.discount() * mdp.expectation(s, a, v));
      }
      tv[s] = best;
      change = std::max(change, std::abs(best - v[s]));
    }
    v.swap(tv);
    if (change <= 1e-9) return {v[0], sweep};
  }
}

template <class Solve>
void solve(benchmark::State& state, Solve solver) {
  const int which = static_cast<int>(state.range(0));
  const auto& models = instance(which);
  Answer total;
  for (auto _ : state) {
    total = {};
    for (const auto& mdp : models) {
      const Answer one = solver(mdp);
      total.value += one.value;
      total.sweeps += one.sweeps;
    }
  }
  const double bytes = static_cast<double>(total.sweeps) * static_cast<double>(models.front().transition_count()) *
                       sizeof(Successor<double>);
  state.counters["sweeps"] = static_cast<double>(total.sweeps) / static_cast<double>(models.size());
  state.counters["V*(0)"] = total.value;
  state.counters["bytes"] =
      benchmark::Counter(bytes, benchmark::Counter::kIsIterationInvariantRate, benchmark::Counter::kIs1024);
  state.SetLabel(names[which]);
}

void plain(benchmark::State& state) {
  solve(state, plain_value_iteration);
}

void certified_value_iteration(benchmark::State& state) {
  solve(state, [](const auto& mdp) {
    const auto s = value_iteration(mdp, same_error(mdp));
    return Answer{s.v[0], s.sweeps};
  });
}

void certified_modified_policy_iteration(benchmark::State& state) {
  solve(state, [](const auto& mdp) {
    const auto s = modified_policy_iteration(mdp, same_error(mdp));
    return Answer{s.v[0], s.sweeps};
  });
}

void certified_policy_iteration(benchmark::State& state) {
  solve(state, [](const auto& mdp) {
    const auto s = policy_iteration(mdp, same_error(mdp));
    return Answer{s.v[0], s.sweeps};
  });
}

BENCHMARK(plain)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(certified_value_iteration)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(certified_modified_policy_iteration)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);
BENCHMARK(certified_policy_iteration)->Arg(0)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace maximin
