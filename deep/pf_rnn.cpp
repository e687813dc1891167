#include <maximin/deep/pf_rnn.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <maximin/deep/q_network.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

constexpr long cell_count = gridworld::side * gridworld::side;
constexpr long action_count = ContinuousGridworld::actions;
/// Width of the first layer of the embedding. It is computed once for a lane, not for each particle.
constexpr long first_layer = 128;
/// An innovation beyond this many eps says no more than this one: the move was not made, or was.
constexpr double innovation_limit = 4;

float innovation(double shown, double expected, double eps) {
  return static_cast<float>(std::clamp((shown - expected) / eps, -innovation_limit, innovation_limit));
}

/// One row of features, in the order of feature_count().
void write_features(const PfRnnOptions& options, const PfSight& sight, float* out) {
  const bool first = sight.action < 0;
  const Point o = sight.shown;
  *out++ = static_cast<float>((o.x - 5) / 5);
  *out++ = static_cast<float>((o.y - 5) / 5);
  *out++ = first ? 1.0F : 0.0F;
  if (options.one_hot_actions) {
    if (!first) out[sight.action] = 1;
    out += action_count;
  } else {
    *out++ = first ? 0.0F : static_cast<float>(sight.action) / 8;
  }
  if (options.innovation) {
    if (!first) {
      const gridworld::Move& move = gridworld::moves.at(static_cast<std::size_t>(sight.action));
      out[0] = innovation(o.x, sight.last.x + move.dx, options.eps);
      out[1] = innovation(o.y, sight.last.y + move.dy, options.eps);
      out[2] = innovation(o.x, sight.last.x, options.eps);
      out[3] = innovation(o.y, sight.last.y, options.eps);
    }
    out += 4;
  }
  if (options.cells) {
    const long i = std::clamp(static_cast<long>(std::floor(o.x)), 0L, gridworld::side - 1L);
    const long j = std::clamp(static_cast<long>(std::floor(o.y)), 0L, gridworld::side - 1L);
    *out++ = static_cast<float>(2 * (o.x - static_cast<double>(i)) - 1);
    *out++ = static_cast<float>(2 * (o.y - static_cast<double>(j)) - 1);
    out[j * gridworld::side + i] = 1;
  }
}

}  // namespace

PfRnnOptions PfRnnOptions::published(double eps) {
  PfRnnOptions options;
  options.eps = eps;
  options.normalisation = PfNormalisation::batch;
  options.read_out = PfReadOut::absolute;
  options.resampling = PfResampling::multinomial;
  options.weighing = PfWeighing::linear;
  options.read_before_resampling = false;
  options.cells = false;
  options.innovation = false;
  options.one_hot_actions = false;
  return options;
}

void PfRnnOptions::check() const {
  const RangeCheck require("PF-RNN");
  require(particles >= 1 && particles <= 10'000, "particles", double(particles), "1 to 10000, e.g. 30");
  require(hidden >= 1 && hidden <= 4096, "hidden", double(hidden), "1 to 4096, e.g. 64");
  require(embedding >= 1 && embedding <= 4096, "embedding", double(embedding), "1 to 4096, e.g. 64");
  require(eps > 0 && eps <= 5, "eps", eps, "a number above 0, at most 5, e.g. 0.1");
  require(alpha >= 0 && alpha <= 1, "alpha", alpha, "0 to 1, e.g. 0.5");
}

PfCandidate::PfCandidate(const PfRnnOptions& options) : kind_(options.normalisation) {
  if (kind_ == PfNormalisation::layer) {
    gain_ = register_parameter("gain", torch::ones({options.hidden}));
    shift_ = register_parameter("shift", torch::zeros({options.hidden}));
  } else if (kind_ == PfNormalisation::batch) {
    batch_ = register_module("batch", torch::nn::BatchNorm1d(options.particles));
  }
}

torch::Tensor PfCandidate::forward(const torch::Tensor& mean, const torch::Tensor& spread,
                                   const torch::Tensor& normal) {
  torch::Tensor drawn = torch::addcmul(mean, torch::softplus(spread), normal);
  if (kind_ == PfNormalisation::layer) {
    drawn = torch::layer_norm(drawn, {drawn.size(2)}, gain_, shift_);
  } else if (kind_ == PfNormalisation::batch) {
    drawn = batch_->forward(drawn);
  }
  return torch::leaky_relu(drawn);
}

PfRnn::PfRnn(const PfRnnOptions& options, Stream& rng) : options_(options) {
  options_.check();
  const long h = options_.hidden, e = options_.embedding;
  const bool lstm = options_.cell == PfCell::lstm;
  embed_ = register_module("embed", linear_layer(feature_count(), first_layer, rng));
  embed_more_ = register_module("embed_more", linear_layer(first_layer, e, rng));
  // PF-LSTM: f, i, o, mean, spread of g. PF-GRU: z, r, and mean and spread of n, which see r h instead of h.
  from_input_ = register_module("from_input", linear_layer(e, (lstm ? 5 : 4) * h, rng));
  from_hidden_ = register_module("from_hidden", linear_layer(h, (lstm ? 5 : 2) * h, rng));
  if (!lstm) candidate_from_hidden_ = register_module("candidate_from_hidden", linear_layer(h, 2 * h, rng));
  const bool bilinear = options_.weighing == PfWeighing::bilinear;
  weigh_ = register_module("weigh", bilinear ? linear_layer(e, h, rng) : linear_layer(h, 1, rng));
  read_ = register_module("read", linear_layer(h, 2, rng));
  candidate_ = register_module("candidate", std::make_shared<PfCandidate>(options_));
  torch::NoGradGuard no_grad;
  // A forget gate that starts open remembers from the first update on.
  if (lstm) from_input_->bias.narrow(0, 0, h).add_(1);
  // Candidates that start with little noise let the means be learned first.
  from_input_->bias.narrow(0, (lstm ? 4 : 3) * h, h).sub_(3);
}

long PfRnn::feature_count() const {
  return 3 + (options_.one_hot_actions ? action_count : 1) + (options_.innovation ? 4 : 0) +
         (options_.cells ? 2 + cell_count : 0);
}

torch::Tensor PfRnn::encode(std::span<const PfSight> sights) const {
  torch::Tensor features = torch::zeros({static_cast<long>(sights.size()), feature_count()});
  float* row = features.data_ptr<float>();
  for (const PfSight& sight : sights) {
    write_features(options_, sight, row);
    row += feature_count();
  }
  return features;
}

PfState PfRnn::initial(long lanes, long particles) const {
  const long k = particles > 0 ? particles : options_.particles;
  PfState state;
  state.h = torch::zeros({lanes, k, options_.hidden}, read_->weight.options().requires_grad(false));
  if (options_.cell == PfCell::lstm) state.c = torch::zeros_like(state.h);
  state.log_weights = torch::full({lanes, k}, -std::log(static_cast<double>(k)), state.h.options());
  return state;
}

// PF-LSTM: c' = sig(f) c + sig(i) g, h' = sig(o) tanh(c'). PF-GRU: h' = (1 - sig(z)) n + sig(z) h.
PfState PfRnn::move(const PfState& before, const torch::Tensor& input, const torch::Tensor& normal) {
  const long h = options_.hidden;
  const torch::Tensor from_input = from_input_->forward(input).unsqueeze(1);
  PfState after;
  after.log_weights = before.log_weights;
  if (options_.cell == PfCell::lstm) {
    const torch::Tensor sum = from_hidden_->forward(before.h).add_(from_input);
    const torch::Tensor gates = torch::sigmoid(sum.narrow(2, 0, 3 * h));
    const torch::Tensor g = candidate_->forward(sum.narrow(2, 3 * h, h), sum.narrow(2, 4 * h, h), normal);
    after.c = torch::addcmul(gates.narrow(2, h, h) * g, gates.narrow(2, 0, h), before.c);
    after.h = gates.narrow(2, 2 * h, h) * torch::tanh(after.c);
  } else {
    const torch::Tensor gates = torch::sigmoid(from_hidden_->forward(before.h) + from_input.narrow(2, 0, 2 * h));
    const torch::Tensor sum =
        candidate_from_hidden_->forward(gates.narrow(2, h, h) * before.h).add_(from_input.narrow(2, 2 * h, 2 * h));
    const torch::Tensor n = candidate_->forward(sum.narrow(2, 0, h), sum.narrow(2, h, h), normal);
    after.h = torch::lerp(n, before.h, gates.narrow(2, 0, h));
  }
  return after;
}

Ancestors soft_resample(const torch::Tensor& log_weights, double alpha, PfResampling resampling,
                        const torch::Tensor& uniform) {
  const long n = log_weights.size(0), k = log_weights.size(1);
  const torch::Tensor weights = log_weights.exp();
  const torch::Tensor q = weights * alpha + (1 - alpha) / static_cast<double>(k);
  torch::Tensor draws = uniform;
  if (resampling == PfResampling::systematic) {
    draws = (torch::arange(k, uniform.options()) + uniform.narrow(1, 0, 1)) / static_cast<double>(k);
  }
  // Sums of q end a little below or above 1: the last particle takes what is left.
  torch::Tensor chosen =
      torch::searchsorted(q.detach().cumsum(1), draws.contiguous(), /*out_int32=*/false, /*right=*/true);
  chosen.clamp_max_(k - 1);
  const torch::Tensor ratio = (log_weights - q.log()).gather(1, chosen);
  const torch::Tensor first_rows = (torch::arange(n, chosen.options()) * k).unsqueeze(1);
  return {(chosen + first_rows).flatten(), torch::log_softmax(ratio, 1)};
}

PfStep PfRnn::step(const PfState& before, const torch::Tensor& features, const torch::Tensor& shown,
                   const PfNoise& noise) {
  const long n = before.h.size(0), k = before.h.size(1), h = options_.hidden;
  torch::Tensor input = torch::relu(embed_->forward(features));
  input = torch::relu(embed_more_->forward(input));
  if (noise.embedding_mask.defined()) input = input * noise.embedding_mask;
  PfState moved = move(before, input, noise.normal);

  const torch::Tensor evidence = options_.weighing == PfWeighing::bilinear
                                     ? torch::matmul(moved.h, weigh_->forward(input).unsqueeze(2)).squeeze(2)
                                     : weigh_->forward(moved.h).squeeze(2);
  moved.log_weights = torch::log_softmax(moved.log_weights + evidence, 1);

  const Ancestors ancestors = soft_resample(moved.log_weights, options_.alpha, options_.resampling, noise.uniform);
  const auto resampled = [&](const torch::Tensor& t) {
    return t.reshape({n * k, h}).index_select(0, ancestors.rows).view({n, k, h});
  };
  PfStep result;
  result.state.h = resampled(moved.h);
  if (moved.c.defined()) result.state.c = resampled(moved.c);
  result.state.log_weights = ancestors.log_weights;

  const PfState& read = options_.read_before_resampling ? moved : result.state;
  result.weights = read.log_weights.exp();
  const torch::Tensor output = read_->forward(noise.hidden_mask.defined() ? read.h * noise.hidden_mask : read.h);
  if (options_.read_out == PfReadOut::residual) {
    result.places = output * options_.eps + shown.unsqueeze(1);
  } else {
    result.places = output * 5 + 5;
  }
  result.mean = (result.places * result.weights.unsqueeze(2)).sum(1);
  return result;
}

}  // namespace maximin::deep
