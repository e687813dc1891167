#pragma once

#include <string>
#include <vector>

#include <maximin/models/model.hpp>

namespace maximin {

/// What a grid world is like, apart from its map.
struct GridWorldOptions {
  double discount = 0.95;
  double slip = 0;    ///< probability of moving sideways instead, half to each side
  double step = -1;   ///< reward of a move that ends on a plain cell (or is blocked)
  double goal = 10;   ///< reward of entering G
  double trap = -10;  ///< reward of entering T
  double eps = 1;     ///< radius of the balls, in cells
  Norm norm = Norm::l1;
};

/// A grid world from a map, one string for each row, the top row first:
///
///     '.' plain   '#' wall   'S' plain, and the episode may start here   'G' goal   'T' trap
///
/// Actions north, east, south, west; a move into a wall or off the map stays. G and T end the episode: entering pays,
/// then they absorb with reward 0. R(s,a) is the expected reward of the cell entered. States are the cells that are no
/// wall, row by row from the top, with points (x, y), x to the right, y upwards from 0. Starts in S, or in any plain
/// cell if there is none.
/// Throws InputError on an empty or ragged map, another character, no plain cell, or an option out of range.
Model<double> grid_world(const std::vector<std::string>& map, const GridWorldOptions& options = {});

/// An open grid of width x height cells: start in the lower left corner, the goal in the upper right one, and a trap
/// below the goal if there is room (both sides at least 2 and one at least 3).
/// Throws InputError unless width and height are 1 to 1000 and there are two cells.
Model<double> grid_world(int width, int height, const GridWorldOptions& options = {});

}  // namespace maximin
