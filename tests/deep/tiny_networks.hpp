#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <torch/torch.h>

#include <maximin/deep/q_network.hpp>
#include <maximin/theory/random.hpp>

namespace maximin::deep {

/// A network whose layers are given as rows of numbers, in double, with nothing before the first layer.
using Matrix = std::vector<std::vector<double>>;
struct LayerNumbers {
  Matrix weight;
  std::vector<double> bias;
};

inline QNetworkPtr network_of(const std::vector<LayerNumbers>& layers) {
  QNetworkShape shape{.inputs = static_cast<long>(layers.front().weight.front().size()),
                      .hidden = {},
                      .actions = static_cast<long>(layers.back().bias.size()),
                      .input_centre = 0,
                      .input_scale = 1};
  for (std::size_t i = 0; i + 1 < layers.size(); ++i) shape.hidden.push_back(static_cast<long>(layers[i].bias.size()));
  Stream rng(0);
  auto q = std::make_shared<QNetwork>(shape, rng);
  q->to(torch::kDouble);
  torch::NoGradGuard no_grad;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    for (std::size_t row = 0; row < layers[i].bias.size(); ++row) {
      const auto r = static_cast<long>(row);
      q->layers()[i]->weight[r].copy_(torch::tensor(layers[i].weight[row], torch::kDouble));
      q->layers()[i]->bias[r].fill_(layers[i].bias[row]);
    }
  }
  return q;
}

/// A random network, its weights scaled up so that boxes cross many kinks.
inline QNetworkPtr random_network(const QNetworkShape& shape, Stream& rng, torch::Dtype type, double gain = 1.5) {
  auto q = std::make_shared<QNetwork>(shape, rng);
  q->to(type);
  torch::NoGradGuard no_grad;
  for (const torch::nn::Linear& layer : q->layers()) layer->weight.mul_(gain);
  return q;
}

/// n points uniform on [low, high)^width.
inline torch::Tensor random_points(long n, long width, double low, double high, Stream& rng,
                                   torch::Dtype type = torch::kDouble) {
  torch::Tensor points = torch::empty({n, width}, torch::kDouble);
  double* out = points.data_ptr<double>();
  for (long i = 0; i < points.numel(); ++i) out[i] = rng.uniform(low, high);
  return points.to(type);
}

/// d f / d parameter by central differences, entry by entry; the parameter is of type double.
template <class F>
torch::Tensor numeric_gradient(const F& f, torch::Tensor parameter, double step = 1e-6) {
  torch::NoGradGuard no_grad;
  torch::Tensor gradient = torch::zeros_like(parameter);
  double* value = parameter.data_ptr<double>();
  double* slope = gradient.data_ptr<double>();
  for (long i = 0; i < parameter.numel(); ++i) {
    const double at = value[i];
    value[i] = at + step;
    const double above = f();
    value[i] = at - step;
    const double below = f();
    value[i] = at;
    slope[i] = (above - below) / (2 * step);
  }
  return gradient;
}

}  // namespace maximin::deep
