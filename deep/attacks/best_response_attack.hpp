#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

struct BestResponseOptions {
  int grid = 3;     ///< candidates on a grid x grid over the ball, its corners among them; 0 for none
  int random = 16;  ///< and as many drawn from the ball
  /// The error shown last is a candidate too, and among equals the nearest to it is shown, not one drawn at random: a
  /// set belief learns most from observations that jump about, and from an error that stays nothing.
  bool steady = false;
};

/// Adaptive: asks the agent, belief and aggregator and all, what it would do on seeing each of many candidates, and
/// shows the one whose answer is worst by the judge's action values, Q_judge(s, a) (paper, Algorithm 1 line 6, by
/// sampling). Among equals, one drawn at random unless steady. It does not plan ahead to mislead the belief.
class BestResponseAttack final : public GridAttack {
 public:
  BestResponseAttack(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                     const BestResponseOptions& options);
  void resize(Lane lanes) override { errors_.assign(static_cast<std::size_t>(lanes), std::nullopt); }
  void forget(Lane lane) override { errors_[static_cast<std::size_t>(lane)].reset(); }
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  /// What was shown last, carried over to where the truth is now; the truth itself at the first step.
  Point carried_over(Lane lane, Point truth) const;
  void candidates(Lane lane, Point truth, Stream& rng, std::vector<Point>& out) const;

  std::shared_ptr<ActionValueModule> judge_;
  ObservationBall ball_;
  BestResponseOptions options_;
  std::vector<std::optional<Point>> errors_;  ///< of what each lane was shown last
};

}  // namespace maximin::deep
