#pragma once

#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/gridworld/hull_control.hpp>
#include <maximin/gridworld/observation_ball.hpp>

/// An agent without a network that is provably sure of its return, in the deep layer's tables: whatever attacks the
/// others attacks it too, and every single episode is worth `HullControl::sure_from` of its start or more. No LibTorch
/// here.
namespace maximin::deep {

/// HullAgent (gridworld/hull_control.hpp) in many lanes. What it controls by must outlive it.
class SureAgent final : public GridAgent {
 public:
  explicit SureAgent(const HullControl& control) : control_(&control) {}

  void resize(Lane lanes) override { lanes_.assign(static_cast<std::size_t>(lanes), HullAgent(*control_)); }
  void forget(Lane lane) override { lanes_[static_cast<std::size_t>(lane)].forget(); }
  /// Takes no random numbers as long as observations keep to the ball.
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) override;
  /// Action 0 where no observation of the kind may be shown.
  void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const override;

  Mind mind(Lane lane) const override;

  bool holds(Lane lane, Point place) const override { return belief(lane).contains(place); }
  double belief_size(Lane lane) const override { return belief(lane).area(); }
  long empty_intersections() const override;
  TraceBelief picture(Lane lane) const override { return {belief(lane).boxes(), {}, {}}; }

  /// What the agent would be sure of from here on if it were shown this now; minus infinity where that may not be
  /// shown.
  double would_be_sure_of(Lane lane, Point shown) const;
  /// What the lane's history leaves possible.
  const BoxUnion& belief(Lane lane) const { return lanes_[static_cast<std::size_t>(lane)].belief_model().belief(); }
  const HullControl& control() const { return *control_; }

 private:
  const HullControl* control_;
  std::vector<HullAgent> lanes_;
};

/// The attack on it that knows most: of the corners, the edges' middles and the centre of the ball and `random` points
/// drawn from it, shows that after which least is sure. Throws std::invalid_argument when the agent is no SureAgent.
class LeastSureAttack final : public GridAttack {
 public:
  explicit LeastSureAttack(const ObservationBall& ball, int random = 16) : ball_(ball), random_(random) {}
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  ObservationBall ball_;
  int random_;
};

}  // namespace maximin::deep
