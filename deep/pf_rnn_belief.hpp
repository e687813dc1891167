#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <maximin/deep/belief_model.hpp>
#include <maximin/deep/pf_rnn.hpp>
#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// How a PF-RNN's particles become a belief. `released()` is as the authors' code has it.
struct PfBeliefOptions {
  /// Each particle is moved to the nearest place that is in the ball around what is shown and is no wall, gold or bomb:
  /// the truth is certainly there. False: particles are anywhere, as released.
  bool correct = true;
  /// A particle that was farther than this many eps from every such place has not met the observation. When none has,
  /// the belief falls back to the open part of the ball, spread evenly, and the case is counted.
  double slack = 0.5;
  /// `holds` and `size` are of the smallest box around the particles, widened by this many eps on each side.
  double hull_margin = 0.25;
  bool forgets = true;  ///< false: hidden states go on from one episode to the next, as released
  std::uint64_t seed = 1;

  static PfBeliefOptions released();
  /// Throws InputError where an option is out of range.
  void check() const;
};

/// The belief of a PF-RNN in many lanes: hidden states are carried, so that a step costs the same at any time. On the
/// CPU.
///
/// An episode's noise is a function of (seed, what was shown first, number of the step) alone: its beliefs are the same
/// in any lane and whatever other lanes do (as far as the last digits of a matrix product are), and `peek` gives what
/// `update` will.
class PfRnnBelief final : public LaneBelief {
 public:
  /// The module must be on the CPU and is put into evaluation mode. Throws InputError where an option is out of range.
  explicit PfRnnBelief(PfRnnPtr module, const PfBeliefOptions& options = {});

  void resize(Lane lanes) override;
  void forget(Lane lane) override;
  long states_per_belief() const override { return module_->options().particles; }
  BeliefStates update(std::span<const Lane> lanes, std::span<const Action> actions,
                      std::span<const Point> shown) override;
  BeliefStates peek(std::span<const Lane> lanes, std::span<const Action> actions,
                    std::span<const Point> shown) const override;
  /// Whether the truth is in the widened hull of the particles.
  bool holds(Lane lane, Point truth) const override;
  /// The open area in the widened hull.
  double size(Lane lane) const override;
  long empty_intersections() const override { return empty_; }

 private:
  struct Memory {
    bool started = false;
    Point last;                          ///< what was shown
    std::array<std::uint32_t, 2> key{};  ///< of the episode's noise
    std::uint32_t step = 0;
    Box hull;
  };
  struct Look {
    PfState state;
    BeliefStates belief;
    long empty = 0;
  };

  Look look(std::span<const Lane> lanes, std::span<const Action> actions, std::span<const Point> shown) const;
  PfNoise noise(std::span<const Memory> memories) const;
  bool correct(Point shown, std::span<Point> places) const;
  Memory after(const Memory& before, Point shown) const;

  PfRnnPtr module_;
  PfBeliefOptions options_;
  ObservationBall ball_;
  std::vector<Memory> memory_;
  PfState state_;  ///< of all lanes
  long empty_ = 0;
};

}  // namespace maximin::deep
