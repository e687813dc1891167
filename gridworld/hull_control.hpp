#pragma once

#include <cstdint>
#include <memory>

#include <maximin/gridworld/box_belief.hpp>
#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>
#include <maximin/gridworld/observation_ball.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// What an agent can be sure of in the continuous Gridworld, whoever attacks, on every single run; and how to act on
/// it. The counterpart of tabular/belief_control.hpp for a world with infinitely many states, and sound there:
///
/// The plane is cut into squares of side 0.5/cells_per_move, and a belief is replaced by its hull, the smallest
/// rectangle of whole squares around it, less what is not open. On hulls,
///
///     U(H) = max_a min { gold or bomb if some place of H may enter it; step + U(H') for every H' that may follow },
///     H'   = hull of (where some place of a square of H may be after a) intersected with an observation's squares,
///
/// in 100 steps, undiscounted. A hull holds the belief, whatever follows a belief lies in what follows its hull, and a
/// larger hull is worth no more: so U is never above what the agent really attains, and an agent that acts by the hull
/// of its exact belief attains U of its first hull or more. It is no upper bound: an agent that kept the shape of its
/// belief may be sure of more. (The agent acts as in the first of the 100 steps; with a step that costs, the sure
/// reward grows on the way, so that it arrives in time.)
class HullControl {
 public:
  struct Choice {
    double value;   ///< the total reward of 100 steps that is sure
    Action action;  ///< how
  };

  /// Solves for all hulls: at eps 0.5, 4 squares to a move take a second, 8 a minute. Throws InputError when eps is so
  /// large, or the squares so many, that a hull of a ball is more than some 40 squares wide or there are more than 2^27
  /// hulls; and for worlds that start in gold and bomb, whose first beliefs are no open places.
  HullControl(const ObservationBall& ball, int cells_per_move, const GridworldOptions& world = {});
  ~HullControl();
  HullControl(HullControl&&) noexcept;
  HullControl& operator=(HullControl&&) noexcept;

  /// Whether a belief holds an open place and is no wider than a ball: so are all of a BoxBelief with the same ball, as
  /// long as observations keep to it.
  bool covers(const BoxUnion& belief) const;

  /// What is sure on such a belief. Throws std::invalid_argument on another.
  Choice choice(const BoxUnion& belief) const;

  /// What is sure once `shown` is shown first.
  Choice first(Point shown) const;

  /// The least that is sure in an episode that starts at an open place: the attacker shows what is worst.
  double sure_from(Point start) const;

  long hulls() const;
  const ObservationBall& ball() const;

 private:
  class Table;
  std::unique_ptr<const Table> table_;
};

/// The agent who acts so: exact belief, its hull, the sure action; any action where an attacker has broken the rules so
/// badly that nothing is left to believe. What it controls by must outlive it.
class HullAgent {
 public:
  using ObservationType = Point;
  using ActionType = Action;

  explicit HullAgent(const HullControl& control) : control_(&control), belief_(control.ball()) {}

  /// Before an episode: whatever comes next is a first observation.
  void forget() { started_ = false; }
  Action begin(Point shown, Stream& rng) {
    forget();
    return act(shown, rng);
  }
  Action act(Point shown, Stream& rng) {
    const BoxUnion& belief = started_ ? belief_.update(last_, shown) : belief_.reset(shown);
    started_ = true;
    return decide(belief, rng);
  }

  /// Whether it has seen something of this episode, and what it did last.
  bool started() const { return started_; }
  Action last_action() const { return last_; }

  /// The belief that an observation would lead to now.
  BoxUnion would_believe(Point shown) const;
  /// Throws std::invalid_argument where no observation of the kind may be shown.
  Action would_do(Point shown) const { return control_->choice(would_believe(shown)).action; }
  const BoxBelief& belief_model() const { return belief_; }
  const HullControl& control() const { return *control_; }

 private:
  Action decide(const BoxUnion& belief, Stream& rng) {
    last_ = control_->covers(belief) ? control_->choice(belief).action : rng.below(ContinuousGridworld::actions);
    return last_;
  }

  const HullControl* control_;
  BoxBelief belief_;
  Action last_ = 0;
  bool started_ = false;
};

}  // namespace maximin
