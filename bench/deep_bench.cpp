#include <benchmark/benchmark.h>

#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/runtime.hpp>
#include <maximin/deep/trained_agent.hpp>

/// Frames per second of training and steps per second of acting, for every agent of the deep layer, on one core. Read
/// the ratios: acting of one agent against another's, one episode against 64 in step.
namespace {

using namespace maximin;
using namespace maximin::deep;

TrainedAgent untrained_agent(const std::string& kind) {
  AgentSpec spec = recipe(kind, 0.5, 1);
  spec.training.warm_up = 0;
  spec.training.stretch_frames = 6400;
  spec.training.frames = 1'000'000'000;
  TrainedAgent agent = untrained(spec);
  if (spec.has_particle_filter()) agent.particle_filter = untrained_filter(spec);
  return agent;
}

/// One iteration is a stretch of 6400 frames, updates, attack and beliefs included.
void train(benchmark::State& state, const std::string& kind) {
  TrainedAgent agent = untrained_agent(kind);
  Trainer trainer(agent.spec.training, training_parts(agent));
  trainer.stretch();
  long frames = 0;
  for (auto _ : state) {
    const long before = trainer.frames();
    trainer.stretch();
    frames += trainer.frames() - before;
  }
  state.counters["frames/s"] = benchmark::Counter(static_cast<double>(frames), benchmark::Counter::kIsRate);
}

/// One iteration is a step in each of so many episodes: attack (random), belief, action, world.
void act(benchmark::State& state, const std::string& kind) {
  TrainedAgent trained = untrained_agent(kind);
  const auto agent = make_agent(trained, acting_of(trained.spec));
  const ObservationBall ball(trained.spec.eps);
  const ContinuousGridworld world;
  const auto n = static_cast<std::size_t>(state.range(0));
  std::vector<Lane> lanes;
  std::vector<Stream> streams;
  std::vector<Point> truths, shown(n);
  for (std::size_t l = 0; l < n; ++l) {
    lanes.push_back(static_cast<Lane>(l));
    streams.emplace_back(1, l);
    truths.push_back(world.reset(streams.back()));
  }
  std::vector<Action> actions(n);
  agent->resize(static_cast<Lane>(n));
  RandomAttack attack(ball);
  for (auto _ : state) {
    attack.perturb(lanes, truths, *agent, streams, shown);
    agent->act(lanes, shown, streams, actions);
    for (std::size_t l = 0; l < n; ++l) {
      const auto outcome = world.step(truths[l], actions[l]);
      truths[l] = outcome.next;
      if (!outcome.terminal) continue;
      truths[l] = world.reset(streams[l]);
      agent->forget(lanes[l]);
    }
  }
  state.counters["steps/s"] =
      benchmark::Counter(static_cast<double>(state.iterations()) * static_cast<double>(n), benchmark::Counter::kIsRate);
}

}  // namespace

int main(int argc, char** argv) {
  prepare_runtime();
  for (const std::string& kind : agent_kinds()) {
    benchmark::RegisterBenchmark(("train/" + kind).c_str(), train, kind)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("act/" + kind).c_str(), act, kind)->Arg(1)->Arg(64)->Unit(benchmark::kMicrosecond);
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
