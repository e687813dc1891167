#pragma once

#include <span>
#include <vector>

#include <maximin/gridworld/gridworld.hpp>

namespace maximin {

/// A rectangle [x_low, x_high) x [y_low, y_high), edges multiples of the quantum.
struct Box {
  double x_low = 0, x_high = 0, y_low = 0, y_high = 0;

  bool empty() const { return !(x_low < x_high && y_low < y_high); }
  double area() const { return empty() ? 0 : (x_high - x_low) * (y_high - y_low); }
  bool contains(Point p) const { return p.x >= x_low && p.x < x_high && p.y >= y_low && p.y < y_high; }
  friend bool operator==(const Box&, const Box&) = default;
};

/// What two boxes have in common; maybe empty.
Box meet(const Box& a, const Box& b);

/// A set of places: disjoint boxes that are not empty, in order of y_low, then x_low. The same set is always the same
/// boxes.
class BoxUnion {
 public:
  BoxUnion() = default;
  /// The union of boxes that may overlap or be empty.
  explicit BoxUnion(std::span<const Box> boxes) { assign(boxes); }

  /// Becomes the union of boxes that may overlap or be empty, but are not its own. Keeps its memory for the next time.
  void assign(std::span<const Box> boxes);
  /// Loses what lies outside the box.
  void keep(const Box& box);

  const std::vector<Box>& boxes() const { return boxes_; }
  bool empty() const { return boxes_.empty(); }
  double area() const;
  bool contains(Point p) const;
  /// What lies in the box too.
  BoxUnion meet(const Box& box) const;
  /// The smallest box around it. Of an empty set, an empty box.
  Box hull() const;

  /// `count` points of the set, spread evenly by area: number k is the same for the same set, whatever the count.
  /// Points lie on the quantum grid. Throws std::invalid_argument when the set is empty or the count negative.
  std::vector<Point> spread(int count) const;

  friend bool operator==(const BoxUnion&, const BoxUnion&) = default;

 private:
  std::vector<Box> boxes_;
};

}  // namespace maximin
