#pragma once

#include <array>
#include <cstdint>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/gridworld/observation_ball.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

/// Histories that a belief model learns from and is judged by: who walks, and who deceives. Neither knows an agent, so
/// that a belief is trained before there is one; the mixture is wide, so that it holds for the agents that come. No
/// LibTorch here.
namespace maximin::deep {

/// Who walks.
enum class Walk : std::uint8_t {
  random,      ///< each action drawn anew
  persistent,  ///< keeps its action for a while, into walls too
  purposeful,  ///< to a cell by the shortest way, as a trained agent goes; one time in three to the gold
  mixed,       ///< one of these, drawn for each episode
};

/// Who deceives, within the ball around the truth.
enum class Deception : std::uint8_t {
  none,       ///< shows the truth
  uniform,    ///< anything in the ball
  corner,     ///< a corner of the ball, the same for the whole episode
  flipping,   ///< a corner of the ball, each axis changing sides now and then
  drifting,   ///< a place in the ball that moves slowly
  lagging,    ///< as near as it may to what was shown before: hides that a move was made
  leading,    ///< as far ahead as it may in the direction of the last move
  beckoning,  ///< as near as it may to one place of the world
  field,      ///< a corner that depends on the place alone, as that of an attack on a fixed network does
  mixed,      ///< one of these, drawn anew now and then, sometimes in a smaller ball
};
inline constexpr int deceptions = 9;  ///< all but mixed

/// Names as in the enumerations.
constexpr auto words_of(Walk) {
  return std::to_array({"random", "persistent", "purposeful", "mixed"});
}
constexpr auto words_of(Deception) {
  return std::to_array(
      {"none", "uniform", "corner", "flipping", "drifting", "lagging", "leading", "beckoning", "field", "mixed"});
}

/// Walks one episode after another.
class Wanderer {
 public:
  /// `actions_drawn` below 8 leaves out the last actions of random walks, as the released code does by mistake.
  explicit Wanderer(Walk walk = Walk::mixed, int actions_drawn = 8) : walk_(walk), actions_drawn_(actions_drawn) {}

  void begin(Stream& rng);
  Action act(Point truth, Stream& rng);

 private:
  Action head_for_target(Point truth, Stream& rng);

  Walk walk_, now_ = Walk::random;
  int actions_drawn_;
  double keep_ = 0;  ///< chance of the same action again
  Action last_ = 0;
  int target_ = 0;  ///< cell number, 10 row + column
};

/// Deceives in one episode after another.
class Deceiver {
 public:
  Deceiver(Deception deception, const ObservationBall& ball) : deception_(deception), eps_(ball.eps()), ball_(ball) {}

  void begin(Stream& rng);
  /// What is shown when `truth` is true; `last` is the action that led there, -1 at the start of an episode.
  Point show(Point truth, Action last, Stream& rng);

 private:
  void draw_kind(Stream& rng);
  Point wanted(Point truth, Action last, Stream& rng);

  Deception deception_, now_ = Deception::none;
  double eps_;
  ObservationBall ball_;  ///< the whole one, or a smaller one for a while
  double side_x_ = 1, side_y_ = 1;
  double flip_ = 0;  ///< chance of changing sides
  Point offset_, target_, shown_;
  double wave_x_[3] = {}, wave_y_[3] = {};  ///< of the field: frequencies and phase
};

/// A lane of training or evaluation: a world, its wanderer and its deceiver, one episode after another. Episode k is a
/// function of (seed, k) alone.
class Wandering {
 public:
  Wandering(Walk walk, Deception deception, double eps, int actions_drawn = 8, long horizon = 100)
      : wanderer_(walk, actions_drawn), deceiver_(deception, ObservationBall(eps)), horizon_(horizon) {}

  void begin(std::uint64_t seed, std::uint64_t episode);
  /// One step on. False: the episode is over, and `begin` is due.
  bool step();

  Point truth() const { return truth_; }
  Point last_truth() const { return last_truth_; }
  Point shown() const { return shown_; }
  Point last_shown() const { return last_shown_; }
  /// The action that led here, -1 at the start. Then the last truth and what was shown last are those of now.
  Action last_action() const { return last_action_; }

 private:
  ContinuousGridworld world_;
  Wanderer wanderer_;
  Deceiver deceiver_;
  Stream rng_{0};
  long horizon_, steps_ = 0;
  Point truth_, last_truth_, shown_, last_shown_;
  Action last_action_ = -1;
};

}  // namespace maximin::deep
