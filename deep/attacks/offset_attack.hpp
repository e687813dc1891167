#pragma once

#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

/// Shows a corner of the ball, drawn once for an episode: the agent is deceived by the same offset all the time, so
/// that what is shown tells a set belief nothing that it did not know.
class ConstantOffsetAttack final : public GridAttack {
 public:
  explicit ConstantOffsetAttack(const ObservationBall& ball) : ball_(ball) {}
  void resize(Lane lanes) override { corner_.assign(static_cast<std::size_t>(lanes), -1); }
  void forget(Lane lane) override { corner_[static_cast<std::size_t>(lane)] = -1; }
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  ObservationBall ball_;
  std::vector<int> corner_;  // 0 to 3; -1 before the first observation
};

}  // namespace maximin::deep
