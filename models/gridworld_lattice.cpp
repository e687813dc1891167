#include <maximin/models/gridworld_lattice.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// The cells, top row first; '#' wall, G gold, B bomb.
constexpr std::array<std::string_view, 10> cells{".#......#.",  //
                                                 ".#.#..#.#.",  //
                                                 ".#.#..#.#.",  //
                                                 ".###..###.",  //
                                                 ".........B",  //
                                                 ".........G",  //
                                                 ".###..###.",  //
                                                 ".#.#..#.#.",  //
                                                 ".#.#..#.#.",  //
                                                 ".#......#."};

struct Move {
  std::string_view name;
  int dx, dy;  // in lattice steps of 0.5
};

constexpr std::array<Move, 8> king_moves{{{"up", 0, 1},
                                          {"up-right", 1, 1},
                                          {"right", 1, 0},
                                          {"down-right", 1, -1},
                                          {"down", 0, -1},
                                          {"down-left", -1, -1},
                                          {"left", -1, 0},
                                          {"up-left", -1, 1}}};

constexpr int points_per_axis = 20;

/// What lies at lattice point (i, j), points outside being walls.
char kind_at(int i, int j) {
  if (i < 0 || i >= points_per_axis || j < 0 || j >= points_per_axis) return '#';
  return cells[static_cast<std::size_t>(9 - j / 2)][static_cast<std::size_t>(i / 2)];
}

struct LatticePoint {
  int i, j;
};

bool ends_episode(LatticePoint p) {
  return kind_at(p.i, p.j) == 'G' || kind_at(p.i, p.j) == 'B';
}

std::vector<LatticePoint> free_points() {
  std::vector<LatticePoint> points;
  for (int j = 0; j < points_per_axis; ++j) {
    for (int i = 0; i < points_per_axis; ++i) {
      if (kind_at(i, j) != '#') points.push_back({i, j});
    }
  }
  return points;
}

FiniteMdp<double> mdp_on(const std::vector<LatticePoint>& points, const GridworldLatticeOptions& o) {
  std::vector<State> state_at(points_per_axis * points_per_axis, -1);
  const auto slot = [](int i, int j) { return static_cast<std::size_t>(j * points_per_axis + i); };
  for (std::size_t s = 0; s < points.size(); ++s) state_at[slot(points[s].i, points[s].j)] = static_cast<State>(s);

  FiniteMdpBuilder<double> builder(static_cast<State>(points.size()), static_cast<Action>(king_moves.size()),
                                   o.discount);
  for (std::size_t from = 0; from < points.size(); ++from) {
    const auto s = static_cast<State>(from);
    for (std::size_t m = 0; m < king_moves.size(); ++m) {
      const auto a = static_cast<Action>(m);
      const int i = points[from].i + king_moves[m].dx, j = points[from].j + king_moves[m].dy;
      const char kind = kind_at(i, j);
      const bool over = ends_episode(points[from]);
      builder.transition(s, a, over || kind == '#' ? s : state_at[slot(i, j)], 1);
      if (!over) builder.reward(s, a, kind == 'G' ? o.gold : kind == 'B' ? o.bomb : o.step);
    }
  }
  return std::move(builder).build();
}

}  // namespace

Model<double> gridworld_lattice(const GridworldLatticeOptions& options) {
  if (!(options.eps >= 0 && std::isfinite(options.eps))) {
    throw InputError(fmt::format("eps: {}, expected a finite number >= 0", options.eps));
  }
  const std::vector<LatticePoint> points = free_points();
  Model<double> model{.mdp = mdp_on(points, options)};
  model.name = "discretised Gridworld";
  for (const Move& move : king_moves) model.action_names.emplace_back(move.name);
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.norm = Norm::linf;
  model.geometry.eps = options.eps;
  model.geometry.points.resize(static_cast<Eigen::Index>(points.size()), 2);
  double starts = 0;
  for (const LatticePoint p : points) starts += !ends_episode(p);
  for (std::size_t s = 0; s < points.size(); ++s) {
    const auto [i, j] = points[s];
    const double x = 0.25 + 0.5 * i, y = 0.25 + 0.5 * j;
    model.geometry.points.row(static_cast<Eigen::Index>(s)) << x, y;
    const char kind = kind_at(i, j);
    model.state_names.push_back(fmt::format("{}({},{})", kind == 'G' ? "gold" : kind == 'B' ? "bomb" : "", x, y));
    model.start.push_back(ends_episode(points[s]) ? 0 : 1 / starts);
  }
  return model;
}

}  // namespace maximin
