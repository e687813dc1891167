#include <maximin/gridworld/box_belief.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include <maximin/theory/concepts.hpp>

namespace maximin {
namespace {

using gridworld::Cell;
using gridworld::quantum;

static_assert(BeliefModel<BoxBelief>);

/// What an agent knows: observation 0, action 0, observation 1, ...
struct History {
  std::vector<Point> shown;
  std::vector<Action> actions;
};

/// Whether some start is at `p` at time t and was consistent with all that was shown until then, the episode going on:
/// by going back in time, independently of sets. A place is entered, or stayed in because the move was cancelled.
bool possible(Point p, std::size_t t, const History& h, const ObservationBall& ball) {
  if (gridworld::cell(p) != Cell::free || !ball.contains(p, h.shown[t])) return false;
  if (t == 0) return true;
  const auto& m = gridworld::moves[static_cast<std::size_t>(h.actions[t - 1])];
  if (possible({p.x - m.dx, p.y - m.dy}, t - 1, h, ball)) return true;
  return gridworld::cell({p.x + m.dx, p.y + m.dy}) == Cell::wall && possible(p, t - 1, h, ball);
}

/// Whether a start leads to an episode that goes on and agrees with all that was shown; if so, where it is now.
bool agrees(Point start, const History& h, const ObservationBall& ball, Point& now) {
  const ContinuousGridworld world;
  now = start;
  if (gridworld::cell(now) != Cell::free || !ball.contains(now, h.shown[0])) return false;
  for (std::size_t t = 0; t < h.actions.size(); ++t) {
    const auto o = world.step(now, h.actions[t]);
    now = o.next;
    if (o.terminal || !ball.contains(now, h.shown[t + 1])) return false;
  }
  return true;
}

/// A random history of a truth, with its truth.
History random_history(const ObservationBall& ball, int steps, Stream& rng, Point& truth) {
  const ContinuousGridworld world;
  truth = world.reset(rng);
  History h{{ball.draw(truth, rng)}, {}};
  for (int t = 0; t < steps; ++t) {
    // Moves that go on in one direction meet walls; random ones tread on the spot.
    const Action a = t > 0 && rng.chance(0.7) ? h.actions.back() : rng.below(8);
    const auto o = world.step(truth, a);
    if (o.terminal) break;
    truth = o.next;
    h.actions.push_back(a);
    const Point corner{truth.x + rng.uniform(-2, 2), truth.y + rng.uniform(-2, 2)};
    h.shown.push_back(rng.chance(0.5) ? ball.draw(truth, rng) : ball.project(truth, corner));
  }
  return h;
}

BoxUnion belief_after(const History& h, const ObservationBall& ball) {
  BoxBelief belief(ball);
  belief.reset(h.shown[0]);
  for (std::size_t t = 0; t < h.actions.size(); ++t) belief.update(h.actions[t], h.shown[t + 1]);
  return belief.belief();
}

/// Points where a wrong set would give itself away: the corners of its boxes, a quantum inside and outside.
std::vector<Point> rim(const BoxUnion& set) {
  std::vector<Point> points;
  for (const Box& b : set.boxes()) {
    for (const double x : {b.x_low - quantum, b.x_low, b.x_high - quantum, b.x_high}) {
      for (const double y : {b.y_low - quantum, b.y_low, b.y_high - quantum, b.y_high}) points.push_back({x, y});
    }
  }
  return points;
}

/// How many places a set gets wrong as the belief after a history: its rim, even points of it and of the surroundings.
int errors(const BoxUnion& set, const History& h, const ObservationBall& ball) {
  auto places = rim(set);
  if (!set.empty()) {
    for (const Point p : set.spread(30)) places.push_back(p);
  }
  for (const Point p : BoxUnion(std::vector{ball.around(h.shown.back())}).spread(60)) places.push_back(p);
  return static_cast<int>(std::count_if(places.begin(), places.end(), [&](Point p) {
    return set.contains(p) != possible(p, h.actions.size(), h, ball);
  }));
}

RC_GTEST_PROP(BoxBelief, HoldsWhatIsPossibleAndNothingElse, (std::uint64_t seed)) {
  Stream rng(seed);
  const ObservationBall ball(rng.chance(0.5) ? 0.5 : rng.uniform(0.05, 0.8));
  Point truth;
  const History h = random_history(ball, rng.integer(0, 20), rng, truth);
  const BoxUnion belief = belief_after(h, ball);
  RC_ASSERT(belief.contains(truth));
  RC_ASSERT(errors(belief, h, ball) == 0);
}

/// The same forward: of a grid of starts, those that agree with the history are now in the belief, and where the grid
/// is fine they fill it.
TEST(BoxBelief, HoldsWhereEveryStartThatAgreesIsNow) {
  const ObservationBall ball(0.5);
  Stream rng(11);
  int agreeing = 0, filled = 0, cells = 0;
  for (int trial = 0; trial < 60; ++trial) {
    Point truth;
    const History h = random_history(ball, rng.integer(1, 15), rng, truth);
    const BoxUnion belief = belief_after(h, ball);
    const Box start = ball.around(h.shown[0]);
    std::vector<Point> ends;
    for (int i = 0; i < 64; ++i) {
      for (int j = 0; j < 64; ++j) {
        Point now;
        if (!agrees({start.x_low + (i + 0.5) / 64, start.y_low + (j + 0.5) / 64}, h, ball, now)) continue;
        ++agreeing;
        ASSERT_TRUE(belief.contains(now));
        ends.push_back(now);
      }
    }
    for (const Box& b : belief.boxes()) {
      if (b.x_high - b.x_low < 1.0 / 32 || b.y_high - b.y_low < 1.0 / 32) continue;
      ++cells;
      filled += std::any_of(ends.begin(), ends.end(), [&](Point p) { return b.contains(p); });
    }
  }
  EXPECT_GT(agreeing, 10'000);
  EXPECT_GT(cells, 20);
  EXPECT_EQ(filled, cells) << "every box of the belief is where some start has led";
}

/// The world without cancelled moves: everything is taken to have moved.
BoxUnion without_cancelled(const BoxUnion& from, Action action, const Box& within) {
  const auto& m = gridworld::moves[static_cast<std::size_t>(action)];
  std::vector<Box> parts;
  for (Box b : from.boxes())
    parts.push_back(meet({b.x_low + m.dx, b.x_high + m.dx, b.y_low + m.dy, b.y_high + m.dy}, within));
  return BoxUnion(parts);
}

TEST(BoxBelief, TheTestsFindAFilterThatForgetsCancelledMoves) {
  const ObservationBall ball(0.5);
  Stream rng(12);
  int lost = 0, caught = 0;
  for (int trial = 0; trial < 200; ++trial) {
    Point truth;
    const History h = random_history(ball, 10, rng, truth);
    BoxUnion belief = open_area().meet(ball.around(h.shown[0]));
    for (std::size_t t = 0; t < h.actions.size(); ++t) {
      belief = without_cancelled(belief, h.actions[t], ball.around(h.shown[t + 1]));
    }
    lost += !belief.contains(truth);
    caught += errors(belief, h, ball) > 0;
  }
  EXPECT_GT(lost, 50);
  EXPECT_GT(caught, 10) << "of the sets that it leaves, too, not of the truth alone";
}

/// Shows the corner, or the truth, that leaves the agent with the largest belief.
Point most_confusing(Point truth, const BoxBelief& belief, Action last, const ObservationBall& ball) {
  Point best = truth;
  double largest = -1;
  BoxUnion next;
  for (const Point wanted : {truth, Point{-9, -9}, Point{-9, 19}, Point{19, -9}, Point{19, 19}}) {
    const Point shown = ball.project(truth, wanted);
    belief.would_update(last, shown, next);
    if (next.area() > largest) {
      largest = next.area();
      best = shown;
    }
  }
  return best;
}

enum class Adversary { random, confusing, constant_offset };

struct Watch {
  long lost = 0, empty = 0, most_boxes = 0;
};

/// 10,000 steps of a restless agent under an adversary who keeps to `allowed`, seen by a filter that believes in
/// `assumed`.
Watch watch(Adversary adversary, const ObservationBall& allowed, const ObservationBall& assumed,
            const GridworldOptions& options = {}) {
  const ContinuousGridworld world(options);
  BoxBelief belief(assumed, options);
  Stream rng(13);
  Watch seen;
  bool first = true;
  Action last = 0;
  Point truth;
  for (long t = 0; t < 10'000; ++t) {
    if (first) truth = world.reset(rng);
    Point shown = allowed.draw(truth, rng);
    if (adversary == Adversary::constant_offset) shown = allowed.project(truth, {truth.x + 9, truth.y - 9});
    if (adversary == Adversary::confusing && !first) shown = most_confusing(truth, belief, last, allowed);
    const BoxUnion& now = first ? belief.reset(shown) : belief.update(last, shown);
    seen.lost += !now.contains(truth);
    seen.most_boxes = std::max(seen.most_boxes, static_cast<long>(now.boxes().size()));
    last = t > 0 && rng.chance(0.6) ? last : rng.below(8);
    const auto o = world.step(truth, last);
    truth = o.next;
    first = o.terminal || t % 100 == 99;
  }
  seen.empty = belief.empty_intersections();
  return seen;
}

TEST(BoxBelief, NeverLosesTheTruthWhoeverShowsWhat) {
  for (const double eps : {0.1, 0.5}) {
    for (const auto adversary : {Adversary::random, Adversary::confusing, Adversary::constant_offset}) {
      for (const bool anywhere : {false, true}) {
        const ObservationBall ball(eps);
        const Watch seen = watch(adversary, ball, ball, {.start_anywhere = anywhere});
        EXPECT_EQ(seen.lost, 0) << eps << ' ' << static_cast<int>(adversary) << ' ' << anywhere;
        EXPECT_EQ(seen.empty, 0);
        EXPECT_LE(seen.most_boxes, 40) << "beliefs stay small";
        RecordProperty("most_boxes_" + std::to_string(eps).substr(0, 3) + "_" +
                           std::to_string(static_cast<int>(adversary)) + (anywhere ? "_anywhere" : ""),
                       std::to_string(seen.most_boxes));
      }
    }
  }
}

TEST(BoxBelief, CountsWhereABallTooSmallContradictsTheHistory) {
  const Watch small = watch(Adversary::random, ObservationBall(0.5), ObservationBall(0.25));
  EXPECT_GT(small.empty, 100);
  EXPECT_GT(small.lost, 1000);
}

TEST(BoxBelief, TrustsTheObservationOverTheHistory) {
  BoxBelief belief(ObservationBall(0.25));
  belief.reset({5, 5});
  const BoxUnion& trusted = belief.update(0, {0.5, 0.5});
  EXPECT_EQ(belief.empty_intersections(), 1);
  EXPECT_EQ(trusted, open_area().meet(ObservationBall(0.25).around({0.5, 0.5})));
  EXPECT_EQ(belief.reset({1.5, 1.5}), open_area()) << "deep in a wall nothing can be believed";
  EXPECT_EQ(belief.empty_intersections(), 1);
}

TEST(BoxBelief, WhatItWouldBelieveIsWhatItThenBelieves) {
  const ObservationBall ball(0.5);
  const ContinuousGridworld world;
  Stream rng(14);
  BoxBelief belief(ball);
  Point truth = world.reset(rng);
  belief.reset(ball.draw(truth, rng));
  BoxUnion expected;
  for (int t = 0; t < 2'000; ++t) {
    const Action a = rng.below(8);
    const auto o = world.step(truth, a);
    truth = o.terminal ? world.reset(rng) : o.next;  // sometimes out of the blue, so that nothing meets
    const Point shown = ball.draw(truth, rng);
    const BoxUnion before = belief.belief();
    belief.would_update(a, shown, expected);
    ASSERT_EQ(belief.belief(), before);
    ASSERT_EQ(belief.update(a, shown), expected);
  }
  EXPECT_GT(belief.empty_intersections(), 0);
}

/// By hand, beside the wall at (1,0) and below the edge of the world.
TEST(BoxBelief, SplitsAtWalls) {
  const std::vector<Box> corner{{0, 1, 0, 1}};
  const BoxUnion after = move_successors(BoxUnion(corner), 2);
  EXPECT_EQ(after.boxes(), (std::vector<Box>{{0.5, 1, 0, 1}})) << "what moved and what was cancelled lie together";
  const std::vector<Box> before_gold{{8.25, 8.75, 4.25, 5.5}};
  EXPECT_EQ(move_successors(BoxUnion(before_gold), 2).boxes(), (std::vector<Box>{{8.75, 9, 4.25, 5.5}}))
      << "what entered gold or bomb is known not to be there";
  BoxUnion part;
  move_successors(BoxUnion(before_gold), 2, {0, 8.9, 0, 5}, part);
  EXPECT_EQ(part.boxes(), (std::vector<Box>{{8.75, 8.9, 4.25, 5}}));
}

TEST(BoxBelief, OpenAreaIsAllButWallsAndEnds) {
  EXPECT_EQ(open_area().area(), 66);
  EXPECT_TRUE(open_area().contains({0, 0}));
  EXPECT_FALSE(open_area().contains({9.5, 4.5}));
  EXPECT_FALSE(open_area().contains({9.5, 5.5}));
  EXPECT_FALSE(open_area().contains({3.5, 2.5}));
}

}  // namespace
}  // namespace maximin
