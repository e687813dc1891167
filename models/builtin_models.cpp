#include <maximin/models/builtin_models.hpp>

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/models/chain.hpp>
#include <maximin/models/garnet.hpp>
#include <maximin/models/grid_world.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// A model whose states lie at the given places on a line, with balls of radius 1.
Model<double> on_a_line(FiniteMdpBuilder<double>&& builder, std::initializer_list<double> places) {
  Model<double> model{.mdp = std::move(builder).build()};
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.norm = Norm::l1;
  model.geometry.eps = 1;
  model.geometry.points.resize(model.mdp.states(), 1);
  std::copy(places.begin(), places.end(), model.geometry.points.data());
  return model;
}

/// S = {0, 1, 20}, R = -x: max R = 0, so that Theorem 1 read one-sidedly bounds the loss by 6; the loss is 10.
Model<double> one_sided() {
  FiniteMdpBuilder<double> b(3, 2, 0.5);
  b.reward(1, 0, -1).reward(1, 1, -1).reward(2, 0, -20).reward(2, 1, -20);
  b.transition(0, 0, 0, 1).transition(0, 1, 2, 1);
  b.transition(1, 0, 2, 1).transition(1, 1, 1, 1);
  b.transition(2, 0, 2, 1).transition(2, 1, 2, 1);
  Model<double> model = on_a_line(std::move(b), {0, 1, 20});
  model.state_names = {"x0", "x1", "x20"};
  return model;
}

/// Two states that look alike; the best answer to the attack of one round is the wrong one for the next.
Model<double> cycling() {
  FiniteMdpBuilder<double> b(2, 2, 0.9);
  b.reward(0, 0, 0).reward(0, 1, 2).reward(1, 0, 3).reward(1, 1, 0);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 0, 1).transition(1, 1, 1, 1);
  return on_a_line(std::move(b), {0, 1});
}

/// The tiger behind one of two doors (Kaelbling, Littman and Cassandra, 1998) with the state in sight: opening a door
/// pays 10 or costs 100, then the doors are set anew; listening costs 1. What sees the tiger can be fooled.
Model<double> tiger() {
  enum : Action { listen, open_left, open_right, actions };
  FiniteMdpBuilder<double> b(2, actions, 0.95);
  for (const State tiger_at : {0, 1}) {
    b.reward(tiger_at, listen, -1).transition(tiger_at, listen, tiger_at, 1);
    for (const Action open : {open_left, open_right}) {
      b.reward(tiger_at, open, open - open_left == tiger_at ? -100 : 10);
      b.transition(tiger_at, open, 0, 0.5).transition(tiger_at, open, 1, 0.5);
    }
  }
  Model<double> model = on_a_line(std::move(b), {0, 1});
  model.state_names = {"tiger-left", "tiger-right"};
  model.action_names = {"listen", "open-left", "open-right"};
  return model;
}

/// The 4 x 3 world (Russell and Norvig, "Artificial intelligence: a modern approach"), discounted, with the reward of a
/// cell paid on entering it.
Model<double> russell_4x3() {
  GridWorldOptions o;
  o.slip = 0.2;
  o.step = -0.04;
  o.goal = 1;
  o.trap = -1;
  return grid_world({"...G", ".#.T", "S..."}, o);
}

/// A grid small enough to follow by hand.
Model<double> grid() {
  return grid_world({"...G", ".#.T", "....", "S..."});
}

Model<double> random_garnet() {
  Stream rng(1);
  return garnet(20, 3, 3, 0.9, rng);
}

Model<double> random_lipschitz() {
  Stream rng(1);
  LipschitzMdpOptions options;
  options.eps = 0.2;
  return random_lipschitz_mdp(options, rng);
}

struct Builtin {
  std::string_view name;
  std::string_view summary;
  Model<double> (*make)();
};

constexpr std::array<Builtin, 9> builtins{{
    {"grid", "4 x 4 cells with a wall, a goal and a trap: small enough to follow by hand", grid},
    {"russell-4x3", "the 4 x 3 world of Russell and Norvig, discounted", russell_4x3},
    {"gridworld", "the paper's continuous Gridworld on a lattice of 272 points", [] { return gridworld_lattice(); }},
    {"tiger", "a tiger behind one of two doors, in sight, but what sees it can be fooled", tiger},
    {"chain", "the 5-state chain of Strens: patience against a small reward now", [] { return chain(5, 0.9); }},
    {"one-sided", "Theorem 1 with R <= R_max only, as printed, fails: loss 10, bound 6", one_sided},
    {"cycling", "pessimistic Q-iteration never settles: the policy pair has period 3", cycling},
    {"garnet", "random: 20 states, 3 actions, 3 successors each, distance in hops", random_garnet},
    {"lipschitz", "random: 10 states in the unit square, l_r = 1, l_p = 0.1", random_lipschitz},
}};

const Builtin& find(std::string_view name) {
  const auto* entry = std::find_if(builtins.begin(), builtins.end(), [&](const auto& b) { return b.name == name; });
  if (entry != builtins.end()) return *entry;
  throw InputError(
      fmt::format("example: '{}' is unknown, expected one of {}", name, fmt::join(builtin_model_names(), ", ")));
}

}  // namespace

std::vector<std::string> builtin_model_names() {
  std::vector<std::string> names;
  for (const Builtin& builtin : builtins) names.emplace_back(builtin.name);
  return names;
}

std::string_view builtin_model_summary(std::string_view name) {
  return find(name).summary;
}

Model<double> builtin_model(std::string_view name) {
  Model<double> model = find(name).make();
  if (model.name.empty()) model.name = name;
  return model;
}

}  // namespace maximin
