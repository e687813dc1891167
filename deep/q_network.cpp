#include <maximin/deep/q_network.hpp>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <maximin/deep/tensors.hpp>

namespace maximin::deep {

torch::nn::Linear linear_layer(long inputs, long outputs, Stream& rng) {
  torch::NoGradGuard no_grad;
  torch::nn::Linear layer(inputs, outputs);
  const double bound = 1 / std::sqrt(static_cast<double>(inputs));
  for (torch::Tensor parameter : {layer->weight, layer->bias}) {
    float* values = parameter.data_ptr<float>();
    for (long i = 0; i < parameter.numel(); ++i) values[i] = static_cast<float>(rng.uniform(-bound, bound));
  }
  return layer;
}

QNetwork::QNetwork(QNetworkShape shape, Stream& rng) : shape_(std::move(shape)) {
  long width = shape_.inputs * (1 + 2 * shape_.waves);
  const auto add = [&](long outputs) {
    const torch::nn::Linear layer = linear_layer(width, outputs, rng);
    layers_.push_back(register_module("layer" + std::to_string(layers_.size()), layer));
    width = outputs;
  };
  for (const long h : shape_.hidden) add(h);
  add(shape_.actions);
}

torch::Tensor QNetwork::features(const torch::Tensor& states) const {
  const torch::Tensor scaled = (states - shape_.input_centre) * shape_.input_scale;
  if (shape_.waves == 0) return scaled;
  std::vector<torch::Tensor> parts{scaled};
  double frequency = std::numbers::pi;
  for (long w = 0; w < shape_.waves; ++w, frequency *= 2) {
    parts.push_back(torch::sin(states * frequency));
    parts.push_back(torch::cos(states * frequency));
  }
  return torch::cat(parts, 1);
}

torch::Tensor QNetwork::forward(const torch::Tensor& states) {
  torch::Tensor x = features(states);
  for (std::size_t i = 0; i + 1 < layers_.size(); ++i) x = torch::relu(layers_[i]->forward(x));
  return layers_.back()->forward(x);
}

void QNetwork::copy_from(const QNetwork& other) {
  TORCH_CHECK(shape_ == other.shape_, "networks of different shapes");
  torch::NoGradGuard no_grad;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    layers_[i]->weight.copy_(other.layers_[i]->weight);
    layers_[i]->bias.copy_(other.layers_[i]->bias);
  }
}

QNetworkPtr frozen_copy(const QNetwork& q) {
  Stream unused(0);
  auto copy = std::make_shared<QNetwork>(q.shape(), unused);
  copy->to(device_of(q));
  copy->copy_from(q);
  for (torch::Tensor& parameter : copy->parameters()) parameter.set_requires_grad(false);
  return copy;
}

long QNetwork::parameter_count() const {
  long n = 0;
  for (const auto& p : parameters()) n += p.numel();
  return n;
}

torch::Device device_of(const torch::nn::Module& module) {
  return module.parameters().front().device();
}

torch::Tensor values_at(ActionValueModule& q, std::span<const Point> places) {
  torch::InferenceMode inference;
  return q.forward(to_tensor(places).to(device_of(q))).to(torch::kCPU).contiguous();
}

}  // namespace maximin::deep
