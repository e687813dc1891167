#pragma once

#include <maximin/models/model.hpp>

namespace maximin {

/// What to change about the discretised Gridworld.
struct GridworldLatticeOptions {
  double discount = 0.99;
  double eps = 0.5;  ///< radius of the l-infinity balls; 0.5 reaches the neighbouring lattice points
  double gold = 200;
  double bomb = -50;
  double step = -1;
};

/// The paper's continuous Gridworld on a lattice: points (0.25 + i/2, 0.25 + j/2) of [0,10]^2, four to a cell, those in
/// free cells being the states (272), in order of y, then x.
///
/// Eight moves of length 0.5, at 0, 45, ..., 315 degrees clockwise from up. The straight ones lead from lattice point
/// to lattice point exactly; the end of a diagonal one, 0.354 away on each axis, is rounded to the nearest lattice
/// point, 0.5 away on each. Only the end point is tested: a move that would end in a wall or outside is cancelled
/// whole.
///
/// Gold is the cell with lower left corner (9,4), the bomb the one above it. Entering pays and ends the episode: the
/// points absorb with reward 0. Any other move, a cancelled one too, costs a step. Starts uniformly on free points
/// outside gold and bomb. l-infinity norm.
///
/// Throws InputError when an option is out of range.
Model<double> gridworld_lattice(const GridworldLatticeOptions& options = {});

}  // namespace maximin
