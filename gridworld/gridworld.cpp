#include <maximin/gridworld/gridworld.hpp>

namespace maximin {

Point ContinuousGridworld::reset(Stream& rng) const {
  while (true) {
    const double x = gridworld::round_down(rng.uniform(0, gridworld::side));
    const Point p{x, gridworld::round_down(rng.uniform(0, gridworld::side))};
    const gridworld::Cell cell = gridworld::cell(p);
    if (cell == gridworld::Cell::free || (options_.start_anywhere && gridworld::ends_episode(cell))) return p;
  }
}

Outcome<Point> ContinuousGridworld::step(Point at, Action action) const {
  const gridworld::Move& move = gridworld::moves.at(static_cast<std::size_t>(action));
  const Point end{at.x + move.dx, at.y + move.dy};
  switch (gridworld::cell(end)) {
    case gridworld::Cell::gold:
      return {end, options_.gold, true};
    case gridworld::Cell::bomb:
      return {end, options_.bomb, true};
    case gridworld::Cell::wall:
      return {at, options_.step, false};
    case gridworld::Cell::free:
      break;
  }
  return {end, options_.step, false};
}

}  // namespace maximin
