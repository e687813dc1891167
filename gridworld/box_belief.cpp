#include <maximin/gridworld/box_belief.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace maximin {
namespace {

BoxUnion cells_where(bool (*wanted)(gridworld::Cell)) {
  std::vector<Box> cells;
  for (int i = 0; i < gridworld::side; ++i) {
    for (int j = 0; j < gridworld::side; ++j) {
      if (wanted(gridworld::cell(i, j))) cells.push_back({double(i), i + 1.0, double(j), j + 1.0});
    }
  }
  return BoxUnion(cells);
}

/// Where a world that starts anywhere may start: gold and bomb too.
const BoxUnion& area_without_walls() {
  static const BoxUnion area = cells_where([](gridworld::Cell c) { return c != gridworld::Cell::wall; });
  return area;
}

/// The cells that an interval of ends touches.
struct Cells {
  int first, last;
  Cells(double low, double high)
      : first(static_cast<int>(std::floor(low))), last(static_cast<int>(std::floor(high - gridworld::quantum))) {}
};

/// Adds what the move makes of a box, as far as it lies in `within`. Neighbouring cells of one kind are one part: the
/// fewer parts, the sooner their union is found.
void move_box(const Box& box, const gridworld::Move& move, const Box& within, std::vector<Box>& parts) {
  const Box ends{box.x_low + move.dx, box.x_high + move.dx, box.y_low + move.dy, box.y_high + move.dy};
  const Cells columns(ends.x_low, ends.x_high), rows(ends.y_low, ends.y_high);
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first, next = i; i <= columns.last; i = next) {
      const gridworld::Cell target = gridworld::cell(i, j);
      while (next <= columns.last && gridworld::cell(next, j) == target) ++next;
      if (gridworld::ends_episode(target)) continue;
      Box part = meet(ends, {double(i), double(next), double(j), j + 1.0});
      if (target == gridworld::Cell::wall) {
        part = {part.x_low - move.dx, part.x_high - move.dx, part.y_low - move.dy, part.y_high - move.dy};
      }
      part = meet(part, within);
      if (!part.empty()) parts.push_back(part);
    }
  }
}

}  // namespace

const BoxUnion& open_area() {
  static const BoxUnion area = cells_where([](gridworld::Cell c) { return c == gridworld::Cell::free; });
  return area;
}

void move_successors(const BoxUnion& from, Action action, const Box& within, BoxUnion& out) {
  thread_local std::vector<Box> parts;
  const gridworld::Move& move = gridworld::moves.at(static_cast<std::size_t>(action));
  parts.clear();
  for (const Box& box : from.boxes()) move_box(box, move, within, parts);
  out.assign(parts);
}

BoxUnion move_successors(const BoxUnion& from, Action action) {
  constexpr double far = 2.0 * gridworld::side;
  BoxUnion out;
  move_successors(from, action, {-far, far, -far, far}, out);
  return out;
}

void BoxBelief::trust(Point observation, const BoxUnion& area, BoxUnion& out) const {
  out = area;
  out.keep(ball_.around(observation));
  if (out.empty()) out = area;
}

const BoxUnion& BoxBelief::reset(Point observation) {
  trust(observation, start_anywhere_ ? area_without_walls() : open_area(), belief_);
  return belief_;
}

void BoxBelief::would_update(Action action, Point observation, BoxUnion& out) const {
  move_successors(belief_, action, ball_.around(observation), out);
  if (out.empty()) trust(observation, open_area(), out);
}

const BoxUnion& BoxBelief::update(Action action, Point observation) {
  move_successors(belief_, action, ball_.around(observation), next_);
  if (next_.empty()) {
    ++empty_;
    trust(observation, open_area(), next_);
  }
  std::swap(belief_, next_);
  return belief_;
}

}  // namespace maximin
