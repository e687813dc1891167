#pragma once

#include <memory>
#include <span>
#include <utility>

#include <maximin/deep/agent.hpp>
#include <maximin/gridworld/observation_ball.hpp>

/// Attacks that look at nothing but the truth.
namespace maximin::deep {

/// Shows the truth.
class NoAttack final : public GridAttack {
 public:
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;
};

/// Shows any point of the ball, all equally likely. Takes two numbers of a lane's stream.
class RandomAttack final : public GridAttack {
 public:
  explicit RandomAttack(const ObservationBall& ball) : ball_(ball) {}
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  ObservationBall ball_;
};

/// Any attack, held to the rules: throws std::logic_error when it shows a point outside the ball or the world, so that
/// a broken attack can never be reported as a strong one.
class WithinBallInStep final : public WrappedAttack {
 public:
  WithinBallInStep(GridAttack& attack, const ObservationBall& ball) : WrappedAttack(attack), ball_(ball) {}
  WithinBallInStep(std::shared_ptr<GridAttack> attack, const ObservationBall& ball)
      : WrappedAttack(std::move(attack)), ball_(ball) {}
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  ObservationBall ball_;
};

}  // namespace maximin::deep
