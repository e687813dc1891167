#include <maximin/models/bench_instances.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::bench {

FiniteMdp<double> dense_instance(State states, Action actions, double discount, std::uint64_t seed) {
  SplitMix64 rng(seed);
  FiniteMdpBuilder<double> builder(states, actions, discount);
  std::vector<double> weights(static_cast<std::size_t>(states));
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      double sum = 0;
      for (double& w : weights) {
        w = rng.u01();
        sum += w;
      }
      for (State t = 0; t < states; ++t) builder.transition(s, a, t, weights[static_cast<std::size_t>(t)] / sum);
      builder.reward(s, a, rng.u01());
    }
  }
  return std::move(builder).build();
}

FiniteMdp<double> sparse_instance(State states, Action actions, State successors, double discount, std::uint64_t seed) {
  if (successors < 1 || successors > states) {
    throw InputError(fmt::format("successors: {}, expected 1 to the number of states", successors));
  }
  SplitMix64 rng(seed);
  FiniteMdpBuilder<double> builder(states, actions, discount);
  std::vector<Successor<double>> row;
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      row.clear();
      while (row.size() < static_cast<std::size_t>(successors)) {
        const State target = rng.below(states);
        const bool drawn = std::any_of(row.begin(), row.end(), [&](const auto& n) { return n.target == target; });
        if (!drawn) row.push_back({target, 0});
      }
      for (auto& next : row) next.probability = rng.u01();
      std::sort(row.begin(), row.end(), [](const auto& x, const auto& y) { return x.target < y.target; });
      double sum = 0;
      for (const auto& next : row) sum += next.probability;
      for (const auto& next : row) builder.transition(s, a, next.target, next.probability / sum);
      builder.reward(s, a, rng.u01());
    }
  }
  return std::move(builder).build();
}

FiniteMdp<double> grid_instance(State width, State height, double discount, std::uint64_t seed) {
  if (width < 1 || height < 1 || height > 2'000'000'000 / width) {
    throw InputError(fmt::format("grid: {} x {}, expected positive sides and at most 2e9 cells", width, height));
  }
  SplitMix64 rng(seed);
  const State goal = width * height - 1;
  FiniteMdpBuilder<double> builder(goal + 1, 4, discount);
  const auto after = [&](State s, Action a) {
    const State x = s % width, y = s / width;
    if (a == 0) return y > 0 ? s - width : s;
    if (a == 1) return x + 1 < width ? s + 1 : s;
    if (a == 2) return y + 1 < height ? s + width : s;
    return x > 0 ? s - 1 : s;
  };
  std::vector<Successor<double>> row;
  for (State s = 0; s <= goal; ++s) {
    for (Action a = 0; a < 4; ++a) {
      const double reward = -rng.u01();
      if (s == goal) {
        builder.transition(s, a, s, 1);
        continue;
      }
      builder.reward(s, a, reward);
      row.clear();
      for (const auto& [move, p] : {std::pair{a, 0.8}, std::pair{(a + 1) % 4, 0.1}, std::pair{(a + 3) % 4, 0.1}}) {
        const State target = after(s, move);
        const auto same = std::find_if(row.begin(), row.end(), [&](const auto& n) { return n.target == target; });
        if (same == row.end()) {
          row.push_back({target, p});
        } else {
          same->probability += p;
        }
      }
      std::sort(row.begin(), row.end(), [](const auto& x, const auto& y) { return x.target < y.target; });
      for (const auto& next : row) builder.transition(s, a, next.target, next.probability);
    }
  }
  return std::move(builder).build();
}

}  // namespace maximin::bench
