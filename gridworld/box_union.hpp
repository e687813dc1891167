#pragma once

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
  explicit BoxUnion(std::vector<Box> boxes);

  const std::vector<Box>& boxes() const { return boxes_; }
  bool empty() const { return boxes_.empty(); }
  double area() const;
  bool contains(Point p) const;
  /// What lies in the box too.
  BoxUnion meet(const Box& box) const;
  /// The smallest box around it. Of an empty set, an empty box.
  Box hull() const;

  /// `count` points of the set, spread evenly by area: number k is the same for the same set. The set must not be
  /// empty; points lie on the quantum grid.
  std::vector<Point> spread(int count) const;

  friend bool operator==(const BoxUnion&, const BoxUnion&) = default;

 private:
  std::vector<Box> boxes_;
};

}  // namespace maximin
