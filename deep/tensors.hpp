#pragma once

#include <span>
#include <vector>

#include <torch/torch.h>

#include <maximin/gridworld/gridworld.hpp>

namespace maximin::deep {

/// Points as a tensor [n, 2] of floats (x, y) on the CPU.
torch::Tensor to_tensor(std::span<const Point> points);

/// The rows of a tensor [n, 2] as points; not rounded to the quantum grid.
std::vector<Point> to_points(const torch::Tensor& rows);

}  // namespace maximin::deep
