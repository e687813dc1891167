#pragma once

#include <maximin/models/model.hpp>

namespace maximin {

/// Where a diagonal move leads, whose end is no lattice point.
enum class DiagonalMove {
  /// The lattice point nearest to the end, in an open space; that point is tested for walls. Deterministic.
  nearest,
  /// The end is tested as in the continuous world. If it is not in a wall, the move leads to one of the four lattice
  /// points around it, with bilinear probabilities: its expectation is exact. Points in a cell of another kind than
  /// that of the end (free, gold, bomb) are left out and the others' probabilities scaled up, so that a move pays
  /// exactly what it pays in the continuous world, but may be off by up to a spacing beside walls.
  interpolated,
};

/// What to change about the discretised Gridworld.
struct GridworldLatticeOptions {
  double discount = 0.99;
  double eps = 0.5;  ///< radius of the l-infinity balls; at spacing 0.5, 0.5 reaches the neighbouring points
  double gold = 200;
  double bomb = -50;
  double step = -1;
  double spacing = 0.5;  ///< of the points: 0.5 divided by a whole number from 1 to 50
  DiagonalMove diagonal = DiagonalMove::nearest;
};

/// The paper's continuous Gridworld (gridworld/gridworld.hpp) on a lattice: the centres of the squares of side
/// `spacing` that tile [0,10]^2, those in free cells being the states, in order of y, then x; 68 / spacing^2 of them,
/// 272 at spacing 0.5.
///
/// Eight moves of length 0.5, at 0, 45, ..., 315 degrees clockwise from up. The straight ones lead from lattice point
/// to lattice point exactly; a diagonal one ends 0.354 away on each axis, and is off by
///
///     spacing             1/2    1/4    1/6    1/8    1/10   1/14   1/20
///     off, on each axis   0.146  0.104  0.020  0.021  0.046  0.004  0.004
///
/// as long as it is `nearest`; bench/gridworld_discretisation says what that does to returns. Only the end point of a
/// move is tested: a move that would end in a wall or outside is cancelled whole.
///
/// Gold is the cell with lower left corner (9,4), the bomb the one above it. Entering pays and ends the episode: the
/// points absorb with reward 0. Any other move, a cancelled one too, costs a step. Starts uniformly on free points
/// outside gold and bomb. l-infinity norm.
///
/// Throws InputError when an option is out of range.
Model<double> gridworld_lattice(const GridworldLatticeOptions& options = {});

}  // namespace maximin
