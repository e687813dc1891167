#include <maximin/gridworld/gridworld.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

namespace maximin {
namespace {

using gridworld::Cell;

static_assert(Environment<ContinuousGridworld>);

enum : Action { up, up_right, right, down_right, down, down_left, left, up_left };

bool on_grid(Point p) {
  return gridworld::round_down(p.x) == p.x && gridworld::round_down(p.y) == p.y;
}

TEST(Gridworld, HasTheMapOfThePaper) {
  int free = 0, wall = 0;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      free += gridworld::cell(i, j) != Cell::wall;
      wall += gridworld::cell(i, j) == Cell::wall;
    }
  }
  EXPECT_EQ(free, 68);
  EXPECT_EQ(wall, 32);
  EXPECT_EQ(gridworld::cell(9, 4), Cell::gold);
  EXPECT_EQ(gridworld::cell(9, 5), Cell::bomb);
  EXPECT_EQ(gridworld::cell(1, 0), Cell::wall);
  EXPECT_EQ(gridworld::cell(3, 2), Cell::wall);
  EXPECT_EQ(gridworld::cell(Point{-gridworld::quantum, 5}), Cell::wall);
  EXPECT_EQ(gridworld::cell(Point{5, 10}), Cell::wall);
  EXPECT_EQ(gridworld::cell(Point{5, 10 - gridworld::quantum}), Cell::free);
}

/// Clockwise from up, each of length 0.5, and exact multiples of the quantum.
TEST(Gridworld, MovesByAHalfInEightDirections) {
  const double pi = std::acos(-1.0);
  for (std::size_t a = 0; a < 8; ++a) {
    const auto& m = gridworld::moves[a];
    const double angle = pi / 4 * static_cast<double>(a);
    EXPECT_NEAR(m.dx, 0.5 * std::sin(angle), 1e-12) << m.name;
    EXPECT_NEAR(m.dy, 0.5 * std::cos(angle), 1e-12) << m.name;
    EXPECT_TRUE(on_grid({m.dx, m.dy}));
  }
}

TEST(Gridworld, PaysAndEndsAsThePaperSays) {
  const ContinuousGridworld world;
  const auto step = [&](Point p, Action a) { return world.step(p, a); };
  EXPECT_EQ(step({8.75, 4.5}, right).reward, 200);
  EXPECT_TRUE(step({8.75, 4.5}, right).terminal);
  EXPECT_EQ(step({8.75, 4.5}, right).next, (Point{9.25, 4.5}));
  EXPECT_EQ(step({8.75, 5.5}, right).reward, -50);
  EXPECT_TRUE(step({8.75, 5.5}, right).terminal);
  EXPECT_EQ(step({8.75, 4.75}, up_right).reward, -50) << "past the corner of the gold";
  EXPECT_EQ(step({8.75, 5.25}, down_right).reward, 200);
  EXPECT_EQ(step({8.25, 4.5}, right).reward, -1);
  EXPECT_EQ(step({8.25, 4.5}, right).next, (Point{8.75, 4.5}));
  EXPECT_FALSE(step({8.25, 4.5}, right).terminal);
  EXPECT_EQ(step({9.5, 3.9}, up).reward, 200);
  EXPECT_EQ(step({9.5, 6}, down).reward, -50) << "up to the edge that belongs to the bomb's neighbour";
  const ContinuousGridworld other({.gold = 1, .bomb = -2, .step = 0.5});
  EXPECT_EQ(other.step({8.75, 4.5}, right).reward, 1);
  EXPECT_EQ(other.step({8.75, 5.5}, right).reward, -2);
  EXPECT_EQ(other.step({5, 5}, right).reward, 0.5);
  EXPECT_THROW(world.step({5, 5}, 8), std::out_of_range);
  EXPECT_THROW(world.step({5, 5}, -1), std::out_of_range);
}

TEST(Gridworld, CancelsABlockedMoveWhole) {
  const ContinuousGridworld world;
  const auto stays = [&](Point p, Action a) { return world.step(p, a).next == p && world.step(p, a).reward == -1; };
  EXPECT_TRUE(stays({0.75, 0.5}, right)) << "the wall at (1,0)";
  EXPECT_TRUE(stays({0.5, 0.4}, down)) << "the edge of the world";
  EXPECT_TRUE(stays({0.75, 0.5}, up_right)) << "no sliding along the wall";
  EXPECT_TRUE(stays({9.5, 9.5}, up)) << "10 is outside";
  EXPECT_FALSE(stays({0.5, 0.5}, down)) << "0 is inside";
  EXPECT_TRUE(stays({0.5, 0.5}, right)) << "1 is in the wall";
  EXPECT_EQ(world.step({0.75, 3.75}, up_right).next.x, 0.75 + gridworld::diagonal)
      << "past the corner of the wall at (1,3): only the end is looked at";
}

/// What is wrong with a step; nothing if all is well.
std::string fault(Point at, Action a, const Outcome<Point>& o) {
  const auto& m = gridworld::moves[static_cast<std::size_t>(a)];
  const Point end{at.x + m.dx, at.y + m.dy};
  if (!on_grid(o.next)) return "off the grid";
  const Cell c = gridworld::cell(end);
  if (!(o.next == (c == Cell::wall ? at : end))) return "place";
  if (o.terminal != (c == Cell::gold || c == Cell::bomb)) return "end";
  if (o.reward != (c == Cell::gold ? 200 : c == Cell::bomb ? -50 : -1)) return "reward";
  if (std::abs(o.next.x - at.x) + std::abs(o.next.y - at.y) > 0.7072) return "too far";
  return "";
}

TEST(Gridworld, StaysOnTheGridForEver) {
  const ContinuousGridworld world;
  Stream rng(5);
  Point p = world.reset(rng);
  std::set<int> cells;
  for (long t = 0; t < 200'000; ++t) {
    const Action a = rng.below(8);
    const auto o = world.step(p, a, rng);
    ASSERT_EQ(fault(p, a, o), "") << p.x << ' ' << p.y << ' ' << a;
    cells.insert(static_cast<int>(p.x) * 10 + static_cast<int>(p.y));
    p = o.terminal ? world.reset(rng) : o.next;
  }
  EXPECT_EQ(cells.size(), 66u) << "everything is connected";
  auto sliding = world.step({0.75, 0.5}, up_right);
  sliding.next.y += 0.25;
  EXPECT_EQ(fault({0.75, 0.5}, up_right, sliding), "place");
  EXPECT_EQ(fault({5, 5}, up_right, {{5 + 0.5 / std::sqrt(2.0), 5 + 0.5 / std::sqrt(2.0)}, -1, false}), "off the grid");
}

TEST(Gridworld, StartsUniformlyInTheOpenUnlessAskedForMore) {
  const ContinuousGridworld world;
  const ContinuousGridworld anywhere({.start_anywhere = true});
  Stream rng(6);
  constexpr int draws = 66'000;
  int gold = 0, bomb = 0, first = 0, right_half = 0;
  for (int k = 0; k < draws; ++k) {
    const Point p = world.reset(rng);
    ASSERT_EQ(gridworld::cell(p), Cell::free);
    ASSERT_TRUE(on_grid(p));
    first += static_cast<int>(p.x) == 0 && static_cast<int>(p.y) == 0;
    right_half += p.x - std::floor(p.x) >= 0.5;
    const Cell c = gridworld::cell(anywhere.reset(rng));
    ASSERT_NE(c, Cell::wall);
    gold += c == Cell::gold;
    bomb += c == Cell::bomb;
  }
  EXPECT_NEAR(first, 1000, 150) << "one cell in 66";
  EXPECT_NEAR(right_half, draws / 2, 650);
  EXPECT_NEAR(gold, draws / 68.0, 150);
  EXPECT_NEAR(bomb, draws / 68.0, 150);
}

}  // namespace
}  // namespace maximin
