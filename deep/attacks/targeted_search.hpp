#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/observation_ball.hpp>
#include <maximin/theory/rollout_in_step.hpp>

namespace maximin::deep {

/// How an observation is looked for that makes a network choose a given action.
enum class SearchMethod {
  grid,  ///< the best of a grid over the ball, then some steps of descent: observations have two coordinates only
  pgd,   ///< descent from one place drawn from the ball
};

struct TargetedSearchOptions {
  SearchMethod method = SearchMethod::grid;
  int grid = 7;             ///< places a side, corners included
  int refinement = 3;       ///< steps of descent from the best place of the grid
  int steps = 30;           ///< of descent, by pgd
  double step_share = 0.1;  ///< of eps, per step; refinement goes by half and half of a grid's cell
};

/// Looks in the ball for an observation at which a network's greedy action is a given one. It ascends log softmax Q of
/// that action along the sign of the gradient, and keeps the place where the action leads the others by most, or falls
/// behind by least.
class TargetedSearch {
 public:
  /// Throws InputError where an option is out of range.
  TargetedSearch(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball,
                 const TargetedSearchOptions& options);

  /// `pgd` takes two numbers of each lane's stream, `grid` none.
  void find(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> targets,
            std::span<Stream> streams, std::span<Point> found) const;

  const TargetedSearchOptions& options() const { return options_; }

 private:
  torch::Tensor best_of_grid(std::span<const Point> truths, const torch::Tensor& targets) const;

  std::shared_ptr<ActionValueModule> q_;
  ObservationBall ball_;
  TargetedSearchOptions options_;
};

}  // namespace maximin::deep
