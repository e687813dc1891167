#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/attacks/attack_objective.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

struct GradientAttackOptions {
  AttackObjective objective = AttackObjective::value;
  int steps = 10;
  double step_share = 0.1;  ///< of eps, per step
  int starts = 1;           ///< random starts; the best point of all is shown, unless the last is
  /// Of all points visited show that with the least objective, rather than the last: never weaker by its own measure.
  bool keep_best = true;
  /// As in the authors' released Gridworld code: the random start is clamped to [0,1] instead of the world (a bug: it
  /// starts at a wrong corner of the ball).
  bool released_start = false;
};

/// By name: "pgd" and "min-best" are the paper's; "pgd-restarts" is PGD from 10 starts; "pgd-released" goes by
/// cross-entropy, starts as released and shows where it ends. Throws InputError on another.
GradientAttackOptions gradient_attack_named(std::string_view name);

/// Projected gradient descent on the sign of the gradient, from a random start in the ball, on a network, not on the
/// agent: it does not know of beliefs and aggregators (every attack of the paper is of this kind).
class GradientAttack final : public GridAttack {
 public:
  GradientAttack(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball,
                 const GradientAttackOptions& options);
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  torch::Tensor starts(std::span<const Lane> lanes, std::span<const Point> truths, std::span<Stream> streams) const;

  std::shared_ptr<ActionValueModule> q_;
  ObservationBall ball_;
  GradientAttackOptions options_;
};

}  // namespace maximin::deep
