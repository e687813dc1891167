#include <maximin/gridworld/box_belief.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace maximin {

const BoxUnion& open_area() {
  static const BoxUnion area = [] {
    std::vector<Box> cells;
    for (int i = 0; i < gridworld::side; ++i) {
      for (int j = 0; j < gridworld::side; ++j) {
        if (gridworld::cell(i, j) != gridworld::Cell::free) continue;
        cells.push_back({double(i), i + 1.0, double(j), j + 1.0});
      }
    }
    return BoxUnion(std::move(cells));
  }();
  return area;
}

BoxUnion move_successors(const BoxUnion& from, Action action) {
  const gridworld::Move& move = gridworld::moves.at(static_cast<std::size_t>(action));
  std::vector<Box> parts;
  for (const Box& box : from.boxes()) {
    const int i_first = static_cast<int>(std::floor(box.x_low + move.dx));
    const int i_last = static_cast<int>(std::floor(box.x_high - gridworld::quantum + move.dx));
    const int j_first = static_cast<int>(std::floor(box.y_low + move.dy));
    const int j_last = static_cast<int>(std::floor(box.y_high - gridworld::quantum + move.dy));
    for (int i = i_first; i <= i_last; ++i) {
      for (int j = j_first; j <= j_last; ++j) {
        const gridworld::Cell target = gridworld::cell(i, j);
        if (gridworld::ends_episode(target)) continue;
        const Box part = meet(box, {i - move.dx, i + 1 - move.dx, j - move.dy, j + 1 - move.dy});
        if (target == gridworld::Cell::wall) {
          parts.push_back(part);
        } else {
          parts.push_back({part.x_low + move.dx, part.x_high + move.dx, part.y_low + move.dy, part.y_high + move.dy});
        }
      }
    }
  }
  return BoxUnion(std::move(parts));
}

const BoxUnion& BoxBelief::reset(Point observation) {
  belief_ = open_area().meet(ball_.around(observation));
  if (belief_.empty()) belief_ = open_area();
  return belief_;
}

const BoxUnion& BoxBelief::update(Action action, Point observation) {
  BoxUnion met = move_successors(belief_, action).meet(ball_.around(observation));
  if (met.empty()) {
    ++empty_;
    return reset(observation);
  }
  belief_ = std::move(met);
  return belief_;
}

}  // namespace maximin
