#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <torch/torch.h>

#include <maximin/deep/q_network.hpp>
#include <maximin/gridworld/gridworld.hpp>

namespace maximin::deep {

/// Nearly optimal action values of the Gridworld without any training: value iteration on a lattice of tenths, each
/// move taken exactly from where one stands and rounded to the lattice only then. Not differentiable.
class LatticeValues final : public ActionValueModule {
 public:
  explicit LatticeValues(double discount = 0.99) : discount_(discount), values_(cells * cells, 0.0) {
    // LibTorch asks a module where it is by way of its parameters.
    register_parameter("none", torch::zeros({1}), false);
    for (double change = 1; change > 1e-6;) {
      change = 0;
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          double best = -1e9;
          for (Action a = 0; a < ContinuousGridworld::actions; ++a) best = std::max(best, q(centre(i, j), a));
          double& v = values_[static_cast<std::size_t>(i * cells + j)];
          change = std::max(change, std::abs(best - v));
          v = best;
        }
      }
    }
  }

  double q(Point at, Action action) const {
    const Outcome<Point> outcome = world_.step(at, action);
    return outcome.reward + (outcome.terminal ? 0 : discount_ * values_[index(outcome.next)]);
  }

  torch::Tensor forward(const torch::Tensor& states) override {
    const torch::Tensor dense = states.contiguous();
    torch::Tensor out = torch::empty({dense.size(0), ContinuousGridworld::actions});
    const float* in = dense.data_ptr<float>();
    float* to = out.data_ptr<float>();
    for (long row = 0; row < dense.size(0); ++row, in += 2) {
      for (Action a = 0; a < ContinuousGridworld::actions; ++a) *to++ = static_cast<float>(0.02 * q({in[0], in[1]}, a));
    }
    return out;
  }

 private:
  static constexpr int cells = 10 * gridworld::side;
  static Point centre(int i, int j) { return {(i + 0.5) / 10, (j + 0.5) / 10}; }
  static std::size_t index(Point p) {
    const auto along = [](double v) { return std::clamp(static_cast<int>(v * 10), 0, cells - 1); };
    return static_cast<std::size_t>(along(p.x) * cells + along(p.y));
  }

  ContinuousGridworld world_;
  double discount_;
  std::vector<double> values_;
};

}  // namespace maximin::deep
