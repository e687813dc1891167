#include <maximin/models/small_random_model.hpp>

#include <algorithm>
#include <utility>
#include <vector>

#include <maximin/models/model_family.hpp>
#include <maximin/models/random_points.hpp>

namespace maximin {
namespace {

/// Four quarters, each thrown on one of a few states.
void add_row_of_quarters(FiniteMdpBuilder<double>& builder, State s, Action a, State n, Stream& rng) {
  const int spread = rng.integer(1, 3);
  std::vector<int> quarters(static_cast<std::size_t>(n), 0);
  const State first = rng.below(n);
  for (int q = 0; q < 4; ++q) ++quarters[static_cast<std::size_t>((first + rng.below(spread)) % n)];
  for (State t = 0; t < n; ++t) builder.transition(s, a, t, quarters[static_cast<std::size_t>(t)] / 4.0);
}

Model<double> draw_integer_model(State most_states, Stream& rng) {
  const State n = rng.integer(1, most_states);
  const Action actions = rng.integer(1, 3);
  const double discounts[] = {0, 0.25, 0.5, 0.75, 0.9};
  FiniteMdpBuilder<double> builder(n, actions, discounts[rng.below(5)]);
  const int largest = rng.integer(0, 3);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      builder.reward(s, a, rng.integer(-largest, largest));
      add_row_of_quarters(builder, s, a, n, rng);
    }
  }
  Model<double> model{std::move(builder).build()};
  const int dimension = rng.integer(1, 2);
  const bool square = dimension == 2 && rng.chance(0.5);  // else on a line
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points = square ? random_points(PointLayout::lattice, n, 2, n <= 4 ? 1 : 2, rng)
                                 : random_points(PointLayout::line, n, dimension, std::max(1, n - 1), rng);
  model.geometry.norm = rng.chance(0.5) ? Norm::l1 : Norm::linf;
  model.geometry.eps = rng.integer(0, 3);
  return model;
}

}  // namespace

Model<double> small_random_model(int size, Stream& rng) {
  const State most = std::clamp(1 + size / 10, 1, 8);
  if (most < 2 || rng.chance(0.5)) return draw_integer_model(most, rng);
  FamilyOptions options;
  options.states = Range<State>{2, most};
  options.actions = Range<Action>{1, 3};
  return draw_family_member(Family::mixed, options, rng).model;
}

}  // namespace maximin
