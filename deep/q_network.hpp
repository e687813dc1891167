#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include <torch/torch.h>

#include <maximin/gridworld/gridworld.hpp>
#include <maximin/theory/random.hpp>

namespace maximin::deep {

/// The shape of a Q-network.
struct QNetworkShape {
  long inputs = 2;
  std::vector<long> hidden{128, 128};
  long actions = 8;
  /// What is put before the first layer: (x - input_centre) * input_scale. The paper's networks take raw coordinates of
  /// [0,10], centre 0 and scale 1; centred ones learn the same in a fraction of the frames.
  double input_centre = 5, input_scale = 0.2;
  /// Sines and cosines of each input that are put beside it, of periods 2, 1, 1/2, ...: walls lie at whole numbers, and
  /// a network of straight pieces is slow to learn what repeats (Tancik et al. 2020). 0: none, the paper's networks.
  long waves = 0;

  friend bool operator==(const QNetworkShape&, const QNetworkShape&) = default;
};

/// Action values as a module: what an agent acts by and what an attack on them differentiates.
class ActionValueModule : public torch::nn::Module {
 public:
  /// Q(s, .) of each row, [n, state...] -> [n, actions].
  virtual torch::Tensor forward(const torch::Tensor& states) = 0;
};

/// The values of another module in another unit: divided by `unit`.
class RescaledValues final : public ActionValueModule {
 public:
  RescaledValues(std::shared_ptr<ActionValueModule> values, double unit)
      : values_(register_module("values", std::move(values))), unit_(unit) {}
  torch::Tensor forward(const torch::Tensor& states) override { return values_->forward(states) / unit_; }

 private:
  std::shared_ptr<ActionValueModule> values_;
  double unit_;
};

/// Action values by a fully connected ReLU network: [n, inputs] -> [n, actions].
class QNetwork : public ActionValueModule {
 public:
  /// Weights uniform in +-1/sqrt(fan-in), as LibTorch's own layers start, but drawn from the project's own stream: the
  /// same seed is the same network with every version of LibTorch.
  QNetwork(QNetworkShape shape, Stream& rng);

  torch::Tensor forward(const torch::Tensor& states) override;

  /// What stands before the first layer: [n, inputs] -> [n, inputs * (1 + 2 waves)], in the order scaled inputs, then
  /// for each wave the sines of all inputs and the cosines of all.
  torch::Tensor features(const torch::Tensor& states) const;

  const QNetworkShape& shape() const { return shape_; }
  /// The affine layers in order; ReLU between them, none after the last.
  const std::vector<torch::nn::Linear>& layers() const { return layers_; }

  /// Takes over all weights of another network of the same shape.
  void copy_from(const QNetwork& other);

  long parameter_count() const;

 private:
  QNetworkShape shape_;
  std::vector<torch::nn::Linear> layers_;
};

using QNetworkPtr = std::shared_ptr<QNetwork>;

/// Another network of the same shape and weights, on the same device, which needs no gradients.
QNetworkPtr frozen_copy(const QNetwork& q);

/// Where the module's numbers are.
torch::Device device_of(const torch::nn::Module& module);

/// Q(s, .) at these places, [n, actions], on the CPU, without gradient.
torch::Tensor values_at(ActionValueModule& q, std::span<const Point> places);

/// A linear layer whose weights and biases are drawn uniformly from +-1/sqrt(inputs): the same stream, the same layer
/// with every version of LibTorch.
torch::nn::Linear linear_layer(long inputs, long outputs, Stream& rng);

}  // namespace maximin::deep
