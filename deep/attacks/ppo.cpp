#include <maximin/deep/attacks/ppo.hpp>

#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// Features come scaled: nothing is put before the first layer.
QNetworkPtr network(long inputs, const std::vector<long>& hidden, long outputs, Stream& rng) {
  QNetworkShape shape;
  shape.inputs = inputs;
  shape.hidden = hidden;
  shape.actions = outputs;
  shape.input_centre = 0;
  shape.input_scale = 1;
  return std::make_shared<QNetwork>(shape, rng);
}

torch::Tensor shuffled(long n, Stream& rng) {
  torch::Tensor order = torch::arange(n, torch::kLong);
  long* index = order.data_ptr<long>();
  for (long i = n - 1; i > 0; --i) std::swap(index[i], index[rng.below(static_cast<int>(i) + 1)]);
  return order;
}

}  // namespace

void PpoOptions::check() const {
  const RangeCheck require("ppo");
  require(discount >= 0 && discount <= 1, "discount", discount, "0 to 1");
  require(trace_decay >= 0 && trace_decay <= 1, "trace_decay", trace_decay, "0 to 1");
  require(clip > 0 && clip < 1, "clip", clip, "a number between 0 and 1");
  require(learning_rate > 0, "learning_rate", learning_rate, "a positive number");
  require(final_learning_rate >= 0, "final_learning_rate", final_learning_rate, "0 or more");
  require(entropy_bonus >= 0, "entropy_bonus", entropy_bonus, "0 or more");
  require(value_weight >= 0, "value_weight", value_weight, "0 or more");
  require(gradient_clip > 0, "gradient_clip", gradient_clip, "a positive number");
  require(epochs >= 1, "epochs", epochs, "at least 1");
  require(minibatch >= 2, "minibatch", double(minibatch), "at least 2");
}

ActorCritic::ActorCritic(long features, long choices, const std::vector<long>& hidden, Stream& rng)
    : policy_(network(features, hidden, choices, rng)), value_(network(features, hidden, 1, rng)) {
  register_module("policy", policy_);
  register_module("value", value_);
  torch::NoGradGuard no_grad;
  for (auto& p : policy_->layers().back()->parameters()) p.mul_(0.01);
}

torch::Tensor ActorCritic::log_policy(const Situations& situations) {
  return torch::log_softmax(policy_->forward(situations.features) + situations.prior, 1);
}

torch::Tensor ActorCritic::value(const torch::Tensor& features) {
  return value_->forward(features).squeeze(1);
}

torch::Tensor generalised_advantage(const torch::Tensor& rewards, const torch::Tensor& values,
                                    const torch::Tensor& over, double discount, double trace_decay) {
  torch::Tensor advantage = torch::empty_like(rewards);
  torch::Tensor ahead = torch::zeros_like(rewards[0]);
  for (long t = rewards.size(0) - 1; t >= 0; --t) {
    const torch::Tensor on = discount * (1 - over[t]);
    ahead = rewards[t] + on * values[t + 1] - values[t] + on * trace_decay * ahead;
    advantage[t].copy_(ahead);
  }
  return advantage;
}

Ppo::Ppo(std::shared_ptr<ActorCritic> network, const PpoOptions& options)
    : network_(std::move(network)),
      options_(options),
      optimiser_(network_->parameters(), torch::optim::AdamOptions(options.learning_rate).eps(1e-5)) {
  options_.check();
}

torch::Tensor Ppo::loss(const Experience& part) {
  const torch::Tensor log_policy = network_->log_policy(part.situations);
  const torch::Tensor log_now = log_policy.gather(1, part.choices.unsqueeze(1)).squeeze(1);
  const torch::Tensor ratio = (log_now - part.log_probability).exp();
  const torch::Tensor clipped = ratio.clamp(1 - options_.clip, 1 + options_.clip);
  const torch::Tensor gain = torch::minimum(ratio * part.advantage, clipped * part.advantage).mean();
  const torch::Tensor entropy = -(log_policy.exp() * log_policy).sum(1).mean();
  const torch::Tensor error = torch::mse_loss(network_->value(part.situations.features), part.target);
  return options_.value_weight * error - gain - options_.entropy_bonus * entropy;
}

void Ppo::learn(const Experience& experience, double fraction, Stream& rng) {
  const double rate =
      options_.learning_rate + std::min(1.0, fraction) * (options_.final_learning_rate - options_.learning_rate);
  optimiser_.param_groups()[0].options().set_lr(rate);
  const torch::Tensor& raw = experience.advantage;
  const torch::Tensor advantage = (raw - raw.mean()) / (raw.std() + 1e-8);
  for (int epoch = 0; epoch < options_.epochs; ++epoch) {
    for (const torch::Tensor& rows : shuffled(raw.size(0), rng).split(options_.minibatch)) {
      const Situations& all = experience.situations;
      optimiser_.zero_grad();
      loss({{all.features.index_select(0, rows), all.prior.index_select(0, rows)},
            experience.choices.index_select(0, rows),
            experience.log_probability.index_select(0, rows),
            advantage.index_select(0, rows),
            experience.target.index_select(0, rows)})
          .backward();
      torch::nn::utils::clip_grad_norm_(network_->parameters(), options_.gradient_clip);
      optimiser_.step();
    }
  }
}

}  // namespace maximin::deep
