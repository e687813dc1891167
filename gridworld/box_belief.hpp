#pragma once

#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/gridworld/observation_ball.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// The free area in which an episode goes on: no walls, no gold, no bomb.
const BoxUnion& open_area();

/// Where a move may have led from a set of places, given that the episode went on: what moved, what was cancelled; what
/// entered gold or bomb is left out. Exact.
BoxUnion move_successors(const BoxUnion& from, Action action);
/// The part of it that lies in the box, into `out`, which must not be `from`. Allocates nothing once `out` and the
/// thread have been used.
void move_successors(const BoxUnion& from, Action action, const Box& within, BoxUnion& out);

/// The states that a history leaves possible, exactly: M_0 is the free part of the ball around the first observation,
/// M_{t+1} = successors(M_t, a_t) intersected with the ball around what is shown next (paper, section 3.3 and Algorithm
/// 2, in continuous space). Walls are cells, moves are translations and l-infinity balls are boxes, so every belief is
/// a finite union of boxes. Models BeliefModel.
///
/// If prediction and ball do not meet, the observation is trusted, M_{t+1} is the free part of its ball, and the case
/// is counted; if the ball holds no free place either, the belief is the whole open area.
///
/// In a world that starts anywhere, M_0 holds the gold and the bomb of its ball too.
class BoxBelief {
 public:
  using BeliefType = BoxUnion;
  using ObservationType = Point;
  using ActionType = Action;

  explicit BoxBelief(const ObservationBall& ball, const GridworldOptions& world = {})
      : ball_(ball), start_anywhere_(world.start_anywhere) {}

  const BoxUnion& reset(Point observation);
  const BoxUnion& update(Action action, Point observation);
  const BoxUnion& belief() const { return belief_; }
  /// What `update` would make of the belief, which stays: for whoever tries many observations.
  void would_update(Action action, Point observation, BoxUnion& out) const;

  /// How often, over all episodes, prediction and observation did not meet.
  long empty_intersections() const { return empty_; }

 private:
  void trust(Point observation, const BoxUnion& area, BoxUnion& out) const;

  ObservationBall ball_;
  bool start_anywhere_;
  BoxUnion belief_, next_;
  long empty_ = 0;
};

}  // namespace maximin
