#include <maximin/gridworld/box_union.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace maximin {
namespace {

struct Interval {
  double low, high;
};

/// What `assign` works with, kept from call to call: an update of a belief then allocates nothing.
struct Scratch {
  std::vector<double> edges;
  std::vector<Interval> row;
};

/// The intervals of x that boxes cover at height y, disjoint, with gaps between them, and ascending.
void covered_at(double y, std::span<const Box> boxes, std::vector<Interval>& out) {
  out.clear();
  for (const Box& b : boxes) {
    if (b.y_low <= y && y < b.y_high && b.x_low < b.x_high) out.push_back({b.x_low, b.x_high});
  }
  std::sort(out.begin(), out.end(), [](auto& a, auto& b) { return a.low < b.low; });
  std::size_t kept = 0;
  for (const Interval& next : out) {
    if (kept > 0 && next.low <= out[kept - 1].high) {
      out[kept - 1].high = std::max(out[kept - 1].high, next.high);
    } else {
      out[kept++] = next;
    }
  }
  out.resize(kept);
}

/// Makes one slab of the two whose boxes are [first, second) and [second, end) if they touch and cover the same x: the
/// second goes. Returns where the last slab begins now.
std::size_t join_slabs(std::vector<Box>& boxes, std::size_t first, std::size_t second) {
  const std::size_t count = boxes.size() - second;
  if (count == 0) return first;
  if (second - first != count || boxes[first].y_high != boxes[second].y_low) return second;
  for (std::size_t k = 0; k < count; ++k) {
    const Box &below = boxes[first + k], &above = boxes[second + k];
    if (below.x_low != above.x_low || below.x_high != above.x_high) return second;
  }
  for (std::size_t k = 0; k < count; ++k) boxes[first + k].y_high = boxes[second + k].y_high;
  boxes.resize(second);
  return first;
}

}  // namespace

Box meet(const Box& a, const Box& b) {
  return {std::max(a.x_low, b.x_low), std::min(a.x_high, b.x_high), std::max(a.y_low, b.y_low),
          std::min(a.y_high, b.y_high)};
}

// Slabs between neighbouring horizontal edges, each cut into maximal intervals; neighbours with equal intervals are
// one.
void BoxUnion::assign(std::span<const Box> boxes) {
  thread_local Scratch scratch;
  auto& [edges, row] = scratch;
  boxes_.clear();
  if (boxes.size() == 1 && !boxes.front().empty()) {
    boxes_.push_back(boxes.front());
    return;
  }
  edges.clear();
  for (const Box& b : boxes) {
    if (!b.empty()) edges.insert(edges.end(), {b.y_low, b.y_high});
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::size_t last_slab = 0;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    covered_at(edges[e], boxes, row);
    const std::size_t slab = boxes_.size();
    for (const Interval& i : row) boxes_.push_back({i.low, i.high, edges[e], edges[e + 1]});
    last_slab = join_slabs(boxes_, last_slab, slab);
  }
}

// What is left of a slab is a slab, but two that differed outside the box may have become one.
void BoxUnion::keep(const Box& box) {
  const std::size_t before = boxes_.size();
  std::size_t kept = 0;
  for (std::size_t k = 0; k < before; ++k) {
    const Box part = maximin::meet(boxes_[k], box);
    if (!part.empty()) boxes_[kept++] = part;
  }
  boxes_.resize(kept);
  if (kept < 2) return;
  thread_local std::vector<Box> cut;
  cut.swap(boxes_);
  boxes_.clear();
  std::size_t last_slab = 0;
  for (std::size_t k = 0; k < cut.size();) {
    const std::size_t slab = boxes_.size();
    const double y = cut[k].y_low;
    while (k < cut.size() && cut[k].y_low == y) boxes_.push_back(cut[k++]);
    last_slab = join_slabs(boxes_, last_slab, slab);
  }
}

double BoxUnion::area() const {
  double sum = 0;
  for (const Box& b : boxes_) sum += b.area();
  return sum;
}

bool BoxUnion::contains(Point p) const {
  return std::any_of(boxes_.begin(), boxes_.end(), [p](const Box& b) { return b.contains(p); });
}

BoxUnion BoxUnion::meet(const Box& box) const {
  BoxUnion result = *this;
  result.keep(box);
  return result;
}

Box BoxUnion::hull() const {
  if (boxes_.empty()) return {};
  Box hull = boxes_.front();
  for (const Box& b : boxes_) {
    hull = {std::min(hull.x_low, b.x_low), std::max(hull.x_high, b.x_high), std::min(hull.y_low, b.y_low),
            std::max(hull.y_high, b.y_high)};
  }
  return hull;
}

// The first coordinate of the R2 sequence (Roberts, 2018: inverse powers of the plastic number) chooses the box by area
// and the place across it, the second the height.
std::vector<Point> BoxUnion::spread(int count) const {
  if (count < 0) throw std::invalid_argument("spread: a negative count, expected 0 or more");
  if (boxes_.empty()) throw std::invalid_argument("spread: an empty set, expected one with points");
  constexpr double step_x = 0.7548776662466927, step_y = 0.5698402909980532;
  const double total = area();
  std::vector<Point> points;
  points.reserve(static_cast<std::size_t>(count));
  double u = 0.5, v = 0.5;
  for (int k = 0; k < count; ++k) {
    double left = u * total;
    std::size_t b = 0;
    while (b + 1 < boxes_.size() && left >= boxes_[b].area()) left -= boxes_[b++].area();
    const Box& box = boxes_[b];
    const double across = std::min(left / box.area(), 1.0);
    const auto place = [](double low, double high, double share) {
      return std::clamp(gridworld::round_down(low + share * (high - low)), low, high - gridworld::quantum);
    };
    points.push_back({place(box.x_low, box.x_high, across), place(box.y_low, box.y_high, v)});
    u += step_x - (u + step_x >= 1);
    v += step_y - (v + step_y >= 1);
  }
  return points;
}

}  // namespace maximin
