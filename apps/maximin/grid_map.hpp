#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <maximin/models/model.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::apps {

/// A model whose states lie on a grid, drawn in characters: two for each state, who is there and what is believed.
///
///     @  the true state       #  in the belief
///     o  what is shown        +  in the ball of what is shown, but not in the belief
///     &  both                 .  any other state
class GridMap {
 public:
  /// The map of a model whose points are one- or two-dimensional and lie on a regular grid of at most 40 x 40 cells, no
  /// two in one cell and at least a quarter of the cells taken; else nothing. x grows to the right, y upwards.
  static std::optional<GridMap> of(const Model<double>& model);

  /// What to draw. `ball` and `belief` are ascending.
  struct Scene {
    State truth;
    State shown;
    std::span<const State> ball;
    std::span<const State> belief;
  };

  /// The map, one line per row, each indented by two spaces.
  std::string draw(const Scene& scene) const;

  /// The legend, in lines.
  static std::string legend();

 private:
  GridMap(int columns, int rows) : columns_(columns), rows_(rows) {
    cells_.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), -1);
  }

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) + static_cast<std::size_t>(x);
  }
  State& cell(int x, int y) { return cells_[index(x, y)]; }
  State cell(int x, int y) const { return cells_[index(x, y)]; }

  int columns_;
  int rows_;
  std::vector<State> cells_;  // the state in each cell or -1, rows from below
};

}  // namespace maximin::apps
