#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/attacks/attack_objective.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/observation_ball.hpp>

namespace maximin::deep {

struct NetworkSearchOptions {
  AttackObjective objective = AttackObjective::value;
  int grid = 7;     ///< candidates on a grid x grid over the ball, its corners among them; 0 for none
  int random = 16;  ///< and as many drawn from the ball
};

/// By name: "pgd-search" and "min-best-search". Throws InputError on another.
NetworkSearchOptions network_search_named(std::string_view name);

/// What PGD and MinBest look for, found without gradients: looks at many places of the ball and shows the one with the
/// least objective, by the smooth one among equals. An observation has two coordinates only, so that some dozens of
/// places see most of the ball, where a network with waves as features leads gradients astray. Like PGD it does not
/// know of beliefs and aggregators.
class NetworkSearch final : public GridAttack {
 public:
  /// Throws InputError where there are no candidates.
  NetworkSearch(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball, const NetworkSearchOptions& options);
  /// Takes two numbers of a lane's stream for each random candidate.
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  std::shared_ptr<ActionValueModule> q_;
  ObservationBall ball_;
  NetworkSearchOptions options_;
};

}  // namespace maximin::deep
