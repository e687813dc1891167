#include <maximin/models/gridworld_lattice.hpp>

#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

using gridworld::Cell;

constexpr double move_length = 0.5;
constexpr int finest = 50;  // lattice steps to a straight move; 680,000 states

/// A lattice point, or a number of lattice steps.
struct LatticePoint {
  int i, j;
};

/// The points (spacing/2 + i spacing, spacing/2 + j spacing) and what lies there.
class Lattice {
 public:
  explicit Lattice(int steps_per_move)
      : steps_(steps_per_move), per_axis_(2 * gridworld::side * steps_per_move), spacing_(move_length / steps_) {
    state_at_.assign(static_cast<std::size_t>(per_axis_) * static_cast<std::size_t>(per_axis_), -1);
    for (int j = 0; j < per_axis_; ++j) {
      for (int i = 0; i < per_axis_; ++i) {
        if (cell({i, j}) == Cell::wall) continue;
        state_at_[slot({i, j})] = static_cast<State>(points_.size());
        points_.push_back({i, j});
      }
    }
  }

  /// What a point lies in; walls outside. 2 steps_ points lie side by side in a cell.
  Cell cell(LatticePoint p) const {
    if (p.i < 0 || p.j < 0) return Cell::wall;
    return gridworld::cell(p.i / (2 * steps_), p.j / (2 * steps_));
  }
  Point place(LatticePoint p) const { return {spacing_ / 2 + spacing_ * p.i, spacing_ / 2 + spacing_ * p.j}; }

  /// The points in no wall, in order of j, then i.
  const std::vector<LatticePoint>& points() const { return points_; }
  /// The number of such a point.
  State state(LatticePoint p) const { return state_at_[slot(p)]; }

  double spacing() const { return spacing_; }
  /// The whole number of steps nearest to a distance.
  int steps(double distance) const { return static_cast<int>(std::lround(distance / spacing_)); }

 private:
  std::size_t slot(LatticePoint p) const {
    return static_cast<std::size_t>(p.j) * static_cast<std::size_t>(per_axis_) + static_cast<std::size_t>(p.i);
  }

  int steps_, per_axis_;
  double spacing_;
  std::vector<LatticePoint> points_;
  std::vector<State> state_at_;
};

/// What a move from a point comes to.
struct End {
  Cell cell;                                ///< free where the move is cancelled
  std::vector<Successor<double>> branches;  ///< at most four, not in order
};

End nearest_end(const Lattice& lattice, LatticePoint from, const gridworld::Move& move) {
  const LatticePoint to{from.i + lattice.steps(move.dx), from.j + lattice.steps(move.dy)};
  const Cell cell = lattice.cell(to);
  if (cell == Cell::wall) return {Cell::free, {{lattice.state(from), 1}}};
  return {cell, {{lattice.state(to), 1}}};
}

/// The point nearest to the end lies in the same cell as the end and has a quarter of the weight or more, so that
/// something is always left to scale up.
End interpolated_end(const Lattice& lattice, LatticePoint from, const gridworld::Move& move) {
  const Point start = lattice.place(from);
  const Cell cell = gridworld::cell({start.x + move.dx, start.y + move.dy});
  if (cell == Cell::wall) return {Cell::free, {{lattice.state(from), 1}}};
  const double x = move.dx / lattice.spacing(), y = move.dy / lattice.spacing();
  const LatticePoint low{from.i + static_cast<int>(std::floor(x)), from.j + static_cast<int>(std::floor(y))};
  const double across = x - std::floor(x), up = y - std::floor(y);
  End end{cell, {}};
  double sum = 0;
  for (const auto& [di, dj, weight] : {std::tuple(0, 0, (1 - across) * (1 - up)), std::tuple(1, 0, across * (1 - up)),
                                       std::tuple(0, 1, (1 - across) * up), std::tuple(1, 1, across * up)}) {
    const LatticePoint to{low.i + di, low.j + dj};
    if (weight == 0 || lattice.cell(to) != cell) continue;
    end.branches.push_back({lattice.state(to), weight});
    sum += weight;
  }
  for (auto& branch : end.branches) branch.probability /= sum;
  return end;
}

FiniteMdp<double> mdp_on(const Lattice& lattice, const GridworldLatticeOptions& o) {
  FiniteMdpBuilder<double> builder(static_cast<State>(lattice.points().size()),
                                   static_cast<Action>(gridworld::moves.size()), o.discount);
  for (const LatticePoint from : lattice.points()) {
    const State s = lattice.state(from);
    const bool over = gridworld::ends_episode(lattice.cell(from));
    for (std::size_t m = 0; m < gridworld::moves.size(); ++m) {
      const auto a = static_cast<Action>(m);
      const auto& move = gridworld::moves[m];
      const bool diagonal = move.dx != 0 && move.dy != 0;
      if (over) {
        builder.transition(s, a, s, 1);
        continue;
      }
      const End end = diagonal && o.diagonal == DiagonalMove::interpolated ? interpolated_end(lattice, from, move)
                                                                           : nearest_end(lattice, from, move);
      for (const auto& branch : end.branches) builder.transition(s, a, branch.target, branch.probability);
      builder.reward(s, a, end.cell == Cell::gold ? o.gold : end.cell == Cell::bomb ? o.bomb : o.step);
    }
  }
  return std::move(builder).build();
}

/// How many lattice steps make a straight move.
int steps_per_move(double spacing) {
  const double steps = std::round(move_length / spacing);
  if (spacing > 0 && steps >= 1 && steps <= finest && std::abs(steps * spacing - move_length) < 1e-9) {
    return static_cast<int>(steps);
  }
  throw InputError(fmt::format("spacing: {}, expected 0.5 divided by a whole number from 1 to {}", spacing, finest));
}

}  // namespace

Model<double> gridworld_lattice(const GridworldLatticeOptions& options) {
  if (!(options.eps >= 0 && std::isfinite(options.eps))) {
    throw InputError(fmt::format("eps: {}, expected a finite number >= 0", options.eps));
  }
  const Lattice lattice(steps_per_move(options.spacing));
  Model<double> model{.mdp = mdp_on(lattice, options)};
  model.name = "discretised Gridworld";
  for (const auto& move : gridworld::moves) model.action_names.emplace_back(move.name);
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.norm = Norm::linf;
  model.geometry.eps = options.eps;
  model.geometry.points.resize(model.mdp.states(), 2);
  double starts = 0;
  for (const LatticePoint p : lattice.points()) starts += !gridworld::ends_episode(lattice.cell(p));
  for (const LatticePoint p : lattice.points()) {
    const auto [x, y] = lattice.place(p);
    const Cell cell = lattice.cell(p);
    model.geometry.points.row(lattice.state(p)) << x, y;
    model.state_names.push_back(fmt::format("{}({},{})",
                                            cell == Cell::gold   ? "gold"
                                            : cell == Cell::bomb ? "bomb"
                                                                 : "",
                                            x, y));
    model.start.push_back(gridworld::ends_episode(cell) ? 0 : 1 / starts);
  }
  return model;
}

}  // namespace maximin
