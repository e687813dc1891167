#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

struct ThroughDefenceOptions {
  int steps = 10;
  double step_share = 0.1;    ///< of eps, per step
  double probe_share = 0.05;  ///< of eps: how far to either side the slope is measured
  int grid = 3;               ///< first looks, on a grid x grid over the ball; 0 for none
  int random = 16;            ///< and as many drawn from the ball
  int starts = 4;             ///< the best so many of the first looks are descended from
  double unit = 1;            ///< what one reward is in the agent's values
};

/// Adaptive descent: projected descent, along the sign of the slope, of sum_a softmax(V(t))_a Q_judge(s, a), where V(t)
/// is what the agent, belief and aggregator and all, goes by when it is shown t. Set beliefs have no gradient, so that
/// slopes are central differences: any belief model will do. It looks at what the sampled best response looks at,
/// descends from the best of that, and of all places looked at, probes too, shows that whose provoked action is worth
/// least to the judge, and among those of the same action that with the least objective.
class ThroughDefenceAttack final : public GridAttack {
 public:
  /// Throws InputError where an option is out of range.
  ThroughDefenceAttack(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                       const ThroughDefenceOptions& options = {});
  /// The agent must be a BeliefAgent, else InputError. Takes two numbers of a lane's stream per random look.
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  std::shared_ptr<ActionValueModule> judge_;
  ObservationBall ball_;
  ThroughDefenceOptions options_;
};

}  // namespace maximin::deep
