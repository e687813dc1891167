#include <maximin/models/garnet.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// `count` distinct states by Floyd's method: one draw each, whatever the share of the states.
std::vector<State> distinct_states(State states, State count, Stream& rng) {
  std::vector<State> chosen;
  for (State top = states - count; top < states; ++top) {
    const State drawn = rng.below(top + 1);
    const bool taken = std::find(chosen.begin(), chosen.end(), drawn) != chosen.end();
    chosen.push_back(taken ? top : drawn);
  }
  return chosen;
}

/// The lengths of the pieces that count - 1 uniform cuts make of [0,1].
std::vector<double> random_pieces(State count, Stream& rng) {
  std::vector<double> cuts{0};
  for (State i = 1; i < count; ++i) cuts.push_back(rng.uniform());
  std::sort(cuts.begin(), cuts.end());
  cuts.push_back(1);
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) cuts[i] = cuts[i + 1] - cuts[i];
  cuts.pop_back();
  return cuts;
}

}  // namespace

Model<double> garnet(State states, Action actions, State branching, double discount, Stream& rng) {
  const auto require = [](bool holds, const char* what, int value, const char* expected) {
    if (!holds) throw InputError(fmt::format("{}: {}, expected {}", what, value, expected));
  };
  require(states >= 1 && states <= 1'000'000, "states", states, "1 to 1000000");
  require(actions >= 1 && actions <= 1000, "actions", actions, "1 to 1000");
  require(branching >= 1 && branching <= states, "branching", branching, "1 to the number of states");
  FiniteMdpBuilder<double> builder(states, actions, discount);
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      const std::vector<State> targets = distinct_states(states, branching, rng);
      const std::vector<double> pieces = random_pieces(branching, rng);
      for (std::size_t i = 0; i < targets.size(); ++i) builder.transition(s, a, targets[i], pieces[i]);
      builder.reward(s, a, rng.uniform());
    }
  }
  Model<double> model{.mdp = std::move(builder).build()};
  model.name = fmt::format("garnet({}, {}, {})", states, actions, branching);
  model.geometry.kind = Geometry<double>::Kind::hops;
  model.geometry.eps = 1;
  return model;
}

}  // namespace maximin
