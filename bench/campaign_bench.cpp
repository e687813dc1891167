/// What one trial of a campaign costs: drawing a model, and checking every claim on it.

#include <benchmark/benchmark.h>

#include <string>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model_family.hpp>
#include <maximin/proofs_check/examination.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {
namespace {

void draw(benchmark::State& state) {
  const Family family = all_families()[static_cast<std::size_t>(state.range(0))];
  std::uint64_t trial = 0;
  for (auto _ : state) {
    Stream rng(1, trial++);
    benchmark::DoNotOptimize(draw_family_member(family, {}, rng));
  }
  state.SetLabel(std::string(family_name(family)));
}

void draw_and_examine(benchmark::State& state) {
  const Family family = all_families()[static_cast<std::size_t>(state.range(0))];
  std::uint64_t trial = 0;
  for (auto _ : state) {
    Stream rng(1, trial++);
    const FamilyMember member = draw_family_member(family, {}, rng);
    benchmark::DoNotOptimize(examine(member.model.mdp, make_perturbation(member.model)));
  }
  state.SetLabel(std::string(family_name(family)));
}

BENCHMARK(draw)->DenseRange(0, 5)->Unit(benchmark::kMicrosecond);
BENCHMARK(draw_and_examine)->DenseRange(0, 5)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace maximin
