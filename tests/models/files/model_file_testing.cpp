#include "model_file_testing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

namespace maximin::testing {

namespace {

/// Zero, small integers, ordinary numbers, and numbers from the smallest to the largest magnitude.
double random_number(Stream& rng) {
  switch (rng.below(5)) {
    case 0:
      return 0;
    case 1:
      return rng.integer(-100, 100);
    case 2:
      return rng.uniform(-1, 1);
    case 3:
      return std::numeric_limits<double>::denorm_min() * rng.integer(1, 1000);
    default:
      return std::ldexp(rng.uniform(-1, 1), rng.integer(-1000, 1000));
  }
}

/// `count` positive numbers that sum to 1 up to rounding.
std::vector<double> random_row(Stream& rng, int count) {
  std::vector<double> row;
  double sum = 0;
  for (int i = 0; i < count; ++i) {
    row.push_back(rng.chance(0.3) ? 1.0 : 0.01 + rng.uniform());
    sum += row.back();
  }
  for (double& p : row) p /= sum;
  return row;
}

FiniteMdp<double> random_mdp(Stream& rng) {
  const State states = rng.integer(1, 6);
  const Action actions = rng.integer(1, 4);
  FiniteMdpBuilder<double> builder(states, actions, rng.chance(0.1) ? 0.0 : rng.uniform());
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      builder.reward(s, a, random_number(rng));
      std::set<State> targets = {rng.below(states)};
      for (int extra = rng.below(3); extra > 0; --extra) targets.insert(rng.below(states));
      const std::vector<double> row = random_row(rng, static_cast<int>(targets.size()));
      auto p = row.begin();
      for (const State t : targets) builder.transition(s, a, t, *p++);
    }
  }
  return std::move(builder).build();
}

std::vector<std::string> random_names(Stream& rng, int count, bool plain) {
  static const std::vector<std::string> plain_pieces = {"a", "Z", "left", "x-y", "u_v", "Q7", "R"};
  static const std::vector<std::string> any_pieces = {"a", " ", "\"",    "\\", "/", "é",
                                                      "→", "0", "(1,2)", "#",  "[", "\u2028"};
  const auto& pieces = plain ? plain_pieces : any_pieces;
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) {
    std::string name = plain ? "n" : "";
    for (int k = rng.below(4); k >= 0; --k)
      name += pieces[static_cast<std::size_t>(rng.below(static_cast<int>(pieces.size())))];
    names.push_back(name + std::to_string(i));
  }
  return names;
}

Geometry<double> random_geometry(Stream& rng, State states) {
  using Kind = Geometry<double>::Kind;
  Geometry<double> g;
  g.kind = static_cast<Kind>(rng.below(6));
  if (g.kind == Kind::points) {
    g.norm = static_cast<Norm>(rng.below(3));
    g.points.resize(states, rng.integer(1, 3));
    for (Eigen::Index s = 0; s < states; ++s) {
      for (Eigen::Index i = 0; i < g.points.cols(); ++i) g.points(s, i) = random_number(rng);
    }
  }
  if (g.kind == Kind::distances || g.kind == Kind::neighbourhoods) {
    Metric<double>::Points line(states, 1);
    for (Eigen::Index s = 0; s < states; ++s) line(s, 0) = rng.integer(0, 10);
    const auto metric = Metric<double>::from_points(line, Norm::l1);
    const Perturbation<double> balls(metric, 2);
    if (g.kind == Kind::distances) g.distances.resize(states, states);
    for (State s = 0; s < states; ++s) {
      for (State t = 0; g.kind == Kind::distances && t < states; ++t) g.distances(s, t) = metric.distance(s, t) / 8;
      if (g.kind == Kind::neighbourhoods) g.neighbourhoods.emplace_back(balls.ball(s).begin(), balls.ball(s).end());
    }
  }
  if (rng.chance(0.5)) g.eps = g.kind == Kind::neighbourhoods ? 1 : std::abs(random_number(rng));
  return g;
}

}  // namespace

Model<double> random_model(Stream& rng, const ModelParts& parts) {
  Model<double> model{random_mdp(rng), {}, {}, {}, {}, {}, {}};
  const State states = model.mdp.states();
  if (parts.names && rng.chance(0.5)) model.state_names = random_names(rng, states, parts.plain);
  if (parts.names && rng.chance(0.5)) model.action_names = random_names(rng, model.mdp.actions(), parts.plain);
  if (parts.start && rng.chance(0.5)) model.start = random_row(rng, states);
  if (parts.geometry) model.geometry = random_geometry(rng, states);
  if (!parts.plain && rng.chance(0.5)) model.name = "a \"name\"\nof two lines";
  if (!parts.plain && rng.chance(0.5)) model.notes = {"one", "two\ttabbed"};
  return model;
}

}  // namespace maximin::testing
