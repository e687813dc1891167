#pragma once

#include <array>
#include <cmath>
#include <string_view>

#include <maximin/theory/concepts.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// A place in the plane: a true state of the continuous Gridworld, or an observation.
struct Point {
  double x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

namespace gridworld {

/// Every coordinate, true or shown, is a multiple of this. Sums of a coordinate below 16 and a move, or eps, are then
/// exact in double precision, and so is everything built on them: what a move leads to, what a ball contains, and the
/// set of places that a history leaves possible.
inline constexpr double quantum = 0x1p-40;

/// The largest multiple of the quantum that is not above v.
inline double round_down(double v) {
  return std::floor(v / quantum) * quantum;
}

/// The side of the world: true states lie in [0, side)^2, observations in [0, side]^2.
inline constexpr int side = 10;

/// What a cell of side 1 is.
enum class Cell : char { free = '.', wall = '#', gold = 'G', bomb = 'B' };

/// The cells of the paper's world, top row (y = 9) first.
inline constexpr std::array<std::string_view, side> map{".#......#.",  //
                                                        ".#.#..#.#.",  //
                                                        ".#.#..#.#.",  //
                                                        ".###..###.",  //
                                                        ".........B",  //
                                                        ".........G",  //
                                                        ".###..###.",  //
                                                        ".#.#..#.#.",  //
                                                        ".#.#..#.#.",  //
                                                        ".#......#."};

/// The cell of column i and row j, counted from the lower left; walls outside.
constexpr Cell cell(int i, int j) {
  if (i < 0 || i >= side || j < 0 || j >= side) return Cell::wall;
  return static_cast<Cell>(map[static_cast<std::size_t>(side - 1 - j)][static_cast<std::size_t>(i)]);
}

/// The cell that a point lies in: that of (floor x, floor y).
inline Cell cell(Point p) {
  return cell(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
}

inline constexpr bool ends_episode(Cell c) {
  return c == Cell::gold || c == Cell::bomb;
}

/// One of the eight moves.
struct Move {
  std::string_view name;
  double dx, dy;
};

/// 0.5/sqrt 2 as a multiple of the quantum: off by less than 1e-12.
inline constexpr double diagonal = 388736063997.0 * quantum;

/// Moves of length 0.5, at 0, 45, ..., 315 degrees clockwise from up.
inline constexpr std::array<Move, 8> moves{{{"up", 0, 0.5},
                                            {"up-right", diagonal, diagonal},
                                            {"right", 0.5, 0},
                                            {"down-right", diagonal, -diagonal},
                                            {"down", 0, -0.5},
                                            {"down-left", -diagonal, -diagonal},
                                            {"left", -0.5, 0},
                                            {"up-left", -diagonal, diagonal}}};

}  // namespace gridworld

/// What to change about the continuous Gridworld.
struct GridworldOptions {
  double gold = 200;            ///< reward of entering the gold
  double bomb = -50;            ///< reward of entering the bomb
  double step = -1;             ///< reward of any other step, a cancelled one too
  bool start_anywhere = false;  ///< as in the authors' released code, start in the gold and the bomb too
};

/// The continuous Gridworld of the paper's section 4: a point among walls, which moves by 0.5 in one of eight
/// directions. Only the end point of a move is looked at: a move that would end in a wall or outside is cancelled
/// whole. Entering gold or bomb pays and ends the episode; that step pays nothing else. Models Environment.
///
/// `reset` takes two or more numbers of the stream, `step` none.
class ContinuousGridworld {
 public:
  using StateType = Point;
  using ActionType = Action;
  static constexpr Action actions = 8;
  static constexpr long horizon = 100;  ///< steps after which the paper ends an episode

  explicit ContinuousGridworld(const GridworldOptions& options = {}) : options_(options) {}

  /// Uniform over the free area, without gold and bomb unless the options say otherwise.
  Point reset(Stream& rng) const;

  /// What the move does. Throws std::out_of_range when there is no such action.
  Outcome<Point> step(Point at, Action action) const;
  Outcome<Point> step(Point at, Action action, Stream&) const { return step(at, action); }

  const GridworldOptions& options() const { return options_; }

 private:
  GridworldOptions options_;
};

}  // namespace maximin
