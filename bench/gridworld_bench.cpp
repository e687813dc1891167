#include <benchmark/benchmark.h>

#include <vector>

#include <maximin/gridworld/box_belief.hpp>

namespace maximin {
namespace {

/// What an episode asks of a belief: the state before, the action, and what was shown.
struct Update {
  BoxBelief before;
  Action action;
  Point shown;
};

/// Steps of a random agent under a random attack.
std::vector<Update> updates(double eps) {
  const ContinuousGridworld world;
  const ObservationBall ball(eps);
  Stream rng(1);
  BoxBelief belief(ball);
  std::vector<Update> list;
  while (list.size() < 4096) {
    Point truth = world.reset(rng);
    belief.reset(ball.draw(truth, rng));
    for (int t = 0; t < 100; ++t) {
      const Action a = rng.below(8);
      const auto o = world.step(truth, a);
      if (o.terminal) break;
      truth = o.next;
      list.push_back({belief, a, ball.draw(truth, rng)});
      belief.update(a, list.back().shown);
    }
  }
  return list;
}

/// An update as an attack on the belief makes it: tried, not kept. The range is eps in percent.
void would_update(benchmark::State& state) {
  const auto list = updates(static_cast<double>(state.range(0)) / 100);
  BoxUnion next;
  std::size_t k = 0;
  double boxes = 0;
  for (auto _ : state) {
    const Update& u = list[k++ % list.size()];
    u.before.would_update(u.action, u.shown, next);
    benchmark::DoNotOptimize(next);
    boxes += static_cast<double>(next.boxes().size());
  }
  state.counters["boxes"] = boxes / static_cast<double>(state.iterations());
}
BENCHMARK(would_update)->Arg(10)->Arg(50)->Arg(100);

/// The same with a copy of the whole filter.
void copy_and_update(benchmark::State& state) {
  const auto list = updates(static_cast<double>(state.range(0)) / 100);
  BoxBelief probe(ObservationBall(0.0));
  std::size_t k = 0;
  for (auto _ : state) {
    const Update& u = list[k++ % list.size()];
    probe = u.before;
    benchmark::DoNotOptimize(probe.update(u.action, u.shown));
  }
}
BENCHMARK(copy_and_update)->Arg(10)->Arg(50);

/// 30 points of a belief, as a network is asked about.
void spread(benchmark::State& state) {
  const auto list = updates(static_cast<double>(state.range(0)) / 100);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(list[k++ % list.size()].before.belief().spread(30));
}
BENCHMARK(spread)->Arg(10)->Arg(50);

void step(benchmark::State& state) {
  const ContinuousGridworld world;
  Stream rng(1);
  Point p = world.reset(rng);
  Action a = 0;
  for (auto _ : state) {
    const auto o = world.step(p, a);
    p = o.terminal ? Point{5, 5} : o.next;
    a = (a * 5 + 3) % 8;
    benchmark::DoNotOptimize(p);
  }
}
BENCHMARK(step);

}  // namespace
}  // namespace maximin
