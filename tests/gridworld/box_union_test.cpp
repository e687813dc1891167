#include <maximin/gridworld/box_union.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <maximin/theory/random.hpp>

namespace maximin {
namespace {

constexpr int squares = 24;  // of side 1/4, in each direction

/// Up to `most` boxes with edges on quarters, some of them empty.
std::vector<Box> random_boxes(int most, Stream& rng) {
  std::vector<Box> boxes(static_cast<std::size_t>(rng.integer(0, most)));
  for (Box& b : boxes) {
    const double x = rng.below(squares), y = rng.below(squares);
    b = {x / 4, (x + rng.below(9)) / 4, y / 4, (y + rng.below(9)) / 4};
  }
  return boxes;
}

bool any_contains(const std::vector<Box>& boxes, Point p) {
  return std::any_of(boxes.begin(), boxes.end(), [p](const Box& b) { return b.contains(p); });
}

/// What is wrong with `set` as the canonical form of a union of boxes with edges on quarters; nothing if all is well.
std::string fault(const std::vector<Box>& set, const std::vector<Box>& boxes) {
  double area = 0;
  for (int i = 0; i < squares + 8; ++i) {
    for (int j = 0; j < squares + 8; ++j) {
      const Point low{i / 4.0, j / 4.0}, centre{(i + 0.5) / 4, (j + 0.5) / 4};
      const bool in = any_contains(boxes, centre);
      area += in / 16.0;
      if (std::count_if(set.begin(), set.end(), [&](const Box& b) { return b.contains(centre); }) != in) {
        return "a square is covered wrongly";
      }
      if (any_contains(set, low) != any_contains(boxes, low)) return "a lower left corner is covered wrongly";
    }
  }
  double sum = 0;
  for (const Box& b : set) sum += b.area();
  if (sum != area) return "area";
  for (std::size_t k = 0; k + 1 < set.size(); ++k) {
    const Box &a = set[k], &b = set[k + 1];
    if (std::pair(a.y_low, a.x_low) >= std::pair(b.y_low, b.x_low)) return "order";
    if (a.y_low == b.y_low && (a.y_high != b.y_high || a.x_high >= b.x_low)) return "slabs";
  }
  return "";
}

RC_GTEST_PROP(BoxUnion, IsCountedOnAFineGrid, (std::uint64_t seed)) {
  Stream rng(seed);
  const auto boxes = random_boxes(6, rng);
  const BoxUnion set(boxes);
  RC_ASSERT(fault(set.boxes(), boxes) == "");
  const std::vector<Box> nothing;
  if (set.empty()) RC_ASSERT(set == BoxUnion(nothing));
}

TEST(BoxUnion, TheCountFindsFaults) {
  const std::vector<Box> overlap{{0, 1, 0, 1}, {0.5, 2, 0, 1}};
  EXPECT_EQ(fault(BoxUnion(overlap).boxes(), overlap), "");
  EXPECT_NE(fault(overlap, overlap), "");
  EXPECT_NE(fault({{0, 1.75, 0, 1}}, overlap), "");
  EXPECT_EQ(fault({{0, 1, 0, 1}, {1, 2, 0, 1}}, overlap), "slabs");
  EXPECT_EQ(fault({{0, 2, 0.5, 1}, {0, 2, 0, 0.5}}, overlap), "order");
}

/// Order, repetition, cuts through boxes and empty boxes make no difference.
RC_GTEST_PROP(BoxUnion, IsTheSameHoweverItIsPutTogether, (std::uint64_t seed)) {
  Stream rng(seed);
  const auto boxes = random_boxes(6, rng);
  const BoxUnion set(boxes);
  auto other = boxes;
  for (const Box& b : boxes) {
    const double x = b.x_low + rng.below(9) / 4.0, y = b.y_low + rng.below(9) / 4.0;
    if (rng.chance(0.5)) other.push_back(meet(b, {x, 100, 0, 100}));
    if (rng.chance(0.5)) other.push_back(meet(b, {0, 100, 0, y}));
    if (rng.chance(0.5)) other.push_back({b.x_high, b.x_low, b.y_low, b.y_high});
  }
  for (std::size_t k = other.size(); k > 1; --k) {
    std::swap(other[k - 1], other[static_cast<std::size_t>(rng.below(static_cast<int>(k)))]);
  }
  RC_ASSERT(BoxUnion(other) == set);
  RC_ASSERT(BoxUnion(set.boxes()) == set);
  BoxUnion used(random_boxes(6, rng));
  used.assign(boxes);
  RC_ASSERT(used == set);
}

RC_GTEST_PROP(BoxUnion, MeetsABox, (std::uint64_t seed)) {
  Stream rng(seed);
  const auto boxes = random_boxes(6, rng);
  const double x = rng.below(squares) / 4.0, y = rng.below(squares) / 4.0;
  const Box window{x, x + rng.below(17) / 4.0, y, y + rng.below(17) / 4.0};
  std::vector<Box> parts;
  for (const Box& b : boxes) parts.push_back(meet(b, window));
  const BoxUnion met = BoxUnion(boxes).meet(window);
  RC_ASSERT(fault(met.boxes(), parts) == "");
  RC_ASSERT(met == BoxUnion(parts));
  BoxUnion kept(boxes);
  kept.keep(window);
  RC_ASSERT(kept == met);
}

TEST(BoxUnion, SlabsBecomeOneWhenWhatToldThemApartIsCutOff) {
  const std::vector<Box> steps{{0, 2, 0, 1}, {0, 1, 1, 2}};
  BoxUnion set(steps);
  ASSERT_EQ(set.boxes().size(), 2u);
  set.keep({0, 1, 0, 2});
  EXPECT_EQ(set.boxes(), (std::vector<Box>{{0, 1, 0, 2}}));
  const std::vector<Box> gap{{0, 1, 0, 1}, {0, 1, 2, 3}};
  EXPECT_EQ(BoxUnion(gap).boxes(), gap) << "equal slabs that do not touch stay two";
}

TEST(BoxUnion, HasAHull) {
  const std::vector<Box> boxes{{1, 2, 5, 6}, {0, 1.5, 3, 4}, {7, 7, 0, 9}};
  EXPECT_EQ(BoxUnion(boxes).hull(), (Box{0, 2, 3, 6}));
  EXPECT_TRUE(BoxUnion().hull().empty());
}

/// The largest |share of the points - share of the area| over squares of side 1/2 and over left and lower parts.
double unevenness(const BoxUnion& set, const std::vector<Point>& points) {
  double worst = 0;
  const auto look = [&](const Box& part) {
    const auto in = std::count_if(points.begin(), points.end(), [&](Point p) { return part.contains(p); });
    const double share = static_cast<double>(in) / static_cast<double>(points.size());
    worst = std::max(worst, std::abs(share - set.meet(part).area() / set.area()));
  };
  for (double edge = 0.25; edge < 10; edge += 0.25) {
    look({0, edge, 0, 100});
    look({0, 100, 0, edge});
  }
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) look({i / 2.0, (i + 1) / 2.0, j / 2.0, (j + 1) / 2.0});
  }
  return worst;
}

RC_GTEST_PROP(BoxUnion, SpreadIsInsideEvenAndTheSameWhateverTheCount, (std::uint64_t seed)) {
  Stream rng(seed);
  const BoxUnion set(random_boxes(5, rng));
  RC_PRE(!set.empty());
  const auto points = set.spread(500);
  for (const Point p : points) {
    RC_ASSERT(set.contains(p));
    RC_ASSERT(gridworld::round_down(p.x) == p.x && gridworld::round_down(p.y) == p.y);
  }
  RC_ASSERT(unevenness(set, points) < 0.06);
  const auto few = set.spread(30);
  RC_ASSERT(std::equal(few.begin(), few.end(), points.begin()));
  RC_ASSERT(unevenness(set, few) < 0.35);
}

TEST(BoxUnion, UnevenSpreadsAreSeen) {
  const std::vector<Box> boxes{{0, 1, 0, 1}, {0, 4, 1, 2}};
  const BoxUnion set(boxes);
  std::vector<Point> points;
  for (const Box& b : set.boxes()) {  // as many in the small box as in the large one
    for (const Point p : BoxUnion(std::vector{b}).spread(250)) points.push_back(p);
  }
  EXPECT_LT(unevenness(set, set.spread(500)), 0.02);
  EXPECT_GT(unevenness(set, points), 0.2);
}

TEST(BoxUnion, SpreadsEvenOverOneQuantum) {
  const double q = gridworld::quantum;
  const BoxUnion speck(std::vector<Box>{{3, 3 + q, 5, 5 + q}});
  for (const Point p : speck.spread(10)) EXPECT_EQ(p, (Point{3, 5}));
  EXPECT_TRUE(speck.spread(0).empty());
  EXPECT_THROW(BoxUnion().spread(1), std::invalid_argument);
  EXPECT_THROW(speck.spread(-1), std::invalid_argument);
}

}  // namespace
}  // namespace maximin
