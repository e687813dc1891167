#pragma once

#include <span>
#include <vector>

#include <torch/torch.h>

#include <maximin/gridworld/observation_ball.hpp>

/// Places in the ball of observations that several attacks look at.
namespace maximin::deep {

/// Place (i, j) of a grid of n x n over what may be shown when `truth` is true: (0, 0) is its lower left corner,
/// (n-1, n-1) its upper right. n >= 2, 0 <= i, j < n.
Point grid_place(const ObservationBall& ball, Point truth, int n, int i, int j);
/// Appends all of them, i outermost; none where n is 0.
void add_grid(const ObservationBall& ball, Point truth, int n, std::vector<Point>& places);

/// Between what the coordinates of an observation lie, [n, 2] each.
struct BallBounds {
  torch::Tensor low, high;

  /// The bounds for these true states.
  BallBounds(std::span<const Point> truths, const ObservationBall& ball, torch::Device device = torch::kCPU);
  /// The nearest places within them.
  torch::Tensor clamp(const torch::Tensor& places) const;
};

}  // namespace maximin::deep
