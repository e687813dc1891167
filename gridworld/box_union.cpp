#include <maximin/gridworld/box_union.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace maximin {
namespace {

struct Interval {
  double low, high;
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// The intervals of x that boxes cover at height y, disjoint and ascending.
void covered_at(double y, const std::vector<Box>& boxes, std::vector<Interval>& out) {
  out.clear();
  for (const Box& b : boxes) {
    if (b.y_low <= y && y < b.y_high) out.push_back({b.x_low, b.x_high});
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

}  // namespace

Box meet(const Box& a, const Box& b) {
  return {std::max(a.x_low, b.x_low), std::min(a.x_high, b.x_high), std::max(a.y_low, b.y_low),
          std::min(a.y_high, b.y_high)};
}

// Slabs between neighbouring horizontal edges, each cut into maximal intervals; slabs with equal intervals are one.
BoxUnion::BoxUnion(std::vector<Box> boxes) {
  std::erase_if(boxes, [](const Box& b) { return b.empty(); });
  if (boxes.size() < 2) {
    boxes_ = std::move(boxes);
    return;
  }
  std::vector<double> edges;
  for (const Box& b : boxes) edges.insert(edges.end(), {b.y_low, b.y_high});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Interval> row, previous;
  std::size_t first_of_slab = 0;
  for (std::size_t e = 0; e + 1 < edges.size(); ++e) {
    covered_at(edges[e], boxes, row);
    if (row == previous) {
      for (std::size_t k = first_of_slab; k < boxes_.size(); ++k) boxes_[k].y_high = edges[e + 1];
    } else {
      first_of_slab = boxes_.size();
      for (const Interval& i : row) boxes_.push_back({i.low, i.high, edges[e], edges[e + 1]});
      previous.swap(row);
    }
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
  std::vector<Box> parts;
  for (const Box& b : boxes_) parts.push_back(maximin::meet(b, box));
  return BoxUnion(std::move(parts));
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
