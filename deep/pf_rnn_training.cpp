#include <maximin/deep/pf_rnn_training.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include <ATen/CPUGeneratorImpl.h>

#include <maximin/deep/range_check.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

/// The trajectories in step.
class Lanes {
 public:
  explicit Lanes(const PfTrainingOptions& options, double eps) : options_(options) {
    lanes_.assign(static_cast<std::size_t>(options.batch),
                  Wandering(options.walk, options.deception, eps, options.actions_drawn, options.horizon));
    for (Wandering& lane : lanes_) begin(lane);
  }

  std::vector<PfSight> sights() const {
    std::vector<PfSight> all;
    for (const Wandering& lane : lanes_) all.push_back({lane.shown(), lane.last_shown(), lane.last_action()});
    return all;
  }
  torch::Tensor shown() const {
    return rows([](const Wandering& lane) { return lane.shown(); });
  }
  torch::Tensor truth(PfTarget target) const {
    return rows([&](const Wandering& lane) { return target == PfTarget::acted_on ? lane.truth() : lane.last_truth(); });
  }

  /// One step on. Returns whether each lane goes on with its trajectory, 1 or 0, [n, 1, 1].
  torch::Tensor step() {
    torch::Tensor goes_on = torch::ones({options_.batch, 1, 1});
    float* flag = goes_on.data_ptr<float>();
    for (Wandering& lane : lanes_) {
      if (!lane.step()) {
        begin(lane);
        *flag = 0;
      }
      ++flag;
    }
    return goes_on;
  }

 private:
  template <class Place>
  torch::Tensor rows(Place&& place) const {
    std::vector<Point> points;
    for (const Wandering& lane : lanes_) points.push_back(place(lane));
    return to_tensor(points);
  }
  void begin(Wandering& lane) {
    lane.begin(options_.seed,
               options_.trajectories > 0 ? next_ % static_cast<std::uint64_t>(options_.trajectories) : next_);
    ++next_;
  }

  PfTrainingOptions options_;
  std::vector<Wandering> lanes_;
  std::uint64_t next_ = 0;
};

torch::Tensor dropout_mask(torch::IntArrayRef sizes, double dropout, at::Generator& generator) {
  if (dropout <= 0) return {};
  return torch::empty(sizes).bernoulli_(1 - dropout, generator) / (1 - dropout);
}

PfNoise draw_noise(const PfState& state, const PfRnnOptions& shape, double dropout, at::Generator& generator) {
  PfNoise noise;
  noise.normal = torch::empty(state.h.sizes()).normal_(0, 1, generator);
  noise.uniform = torch::empty(state.log_weights.sizes()).uniform_(0, 1, generator);
  noise.embedding_mask = dropout_mask({state.h.size(0), shape.embedding}, dropout, generator);
  noise.hidden_mask = dropout_mask(state.h.sizes(), dropout, generator);
  return noise;
}

/// Where a trajectory is over, the state before a first observation.
void restart(PfState& state, const torch::Tensor& goes_on) {
  state.h = state.h * goes_on;
  if (state.c.defined()) state.c = state.c * goes_on;
  const double equal = -std::log(static_cast<double>(state.log_weights.size(1)));
  state.log_weights =
      torch::where(goes_on.squeeze(2) > 0, state.log_weights, torch::full({1, 1}, equal, state.log_weights.options()));
}

void detach(PfState& state) {
  state.h = state.h.detach();
  if (state.c.defined()) state.c = state.c.detach();
  state.log_weights = state.log_weights.detach();
}

double mean_distance(const torch::Tensor& a, const torch::Tensor& b) {
  return (a - b).norm(2, 1).mean().item<double>();
}

/// The mean loss over one window; the state and the lanes go on.
torch::Tensor window_loss(PfRnn& module, Lanes& lanes, PfState& state, const PfTrainingOptions& options,
                          at::Generator& generator, PfTrainingProgress& progress) {
  torch::Tensor sum = torch::zeros({});
  double weights = 0;
  const auto steps = static_cast<double>(options.window);
  for (long t = 0; t < options.window; ++t) {
    const torch::Tensor shown = lanes.shown(), truth = lanes.truth(options.target);
    const PfStep step = module.step(state, module.encode(lanes.sights()), shown,
                                    draw_noise(state, module.options(), options.dropout, generator));
    const double weight = std::exp(options.time_weight * static_cast<double>(t));
    sum = sum + pf_loss(step, truth, module.options().eps, options).mean() * weight;
    weights += weight;
    progress.mean_error += mean_distance(step.mean.detach(), truth) / steps;
    progress.shown_error += mean_distance(shown, truth) / steps;
    state = step.state;
    restart(state, lanes.step());
  }
  detach(state);
  return sum / weights;
}

void set_learning_rate(torch::optim::RMSprop& optimizer, double rate) {
  for (auto& group : optimizer.param_groups()) group.options().set_lr(rate);
}

double rate_at(long update, const PfTrainingOptions& options) {
  if (!options.decay) return options.learning_rate;
  const double done = static_cast<double>(update) / static_cast<double>(options.updates);
  return options.learning_rate * std::min(1.0, 2 * (1 - done) + 1e-3);
}

}  // namespace

void PfTrainingOptions::check(const PfRnnOptions& shape) const {
  const RangeCheck require("PF-RNN training");
  require(updates >= 0, "updates", double(updates), "0 or more");
  require(batch >= 1, "batch", double(batch), "1 or more, e.g. 64");
  require(window >= 1, "window", double(window), "1 or more, e.g. 10");
  require(horizon >= 1, "horizon", double(horizon), "1 or more, e.g. 100");
  require(particles >= 0, "particles", double(particles), "0 or more, e.g. 8");
  require(actions_drawn >= 1 && actions_drawn <= 8, "actions_drawn", actions_drawn, "1 to 8");
  require(trajectories >= 0, "trajectories", double(trajectories), "0 or more");
  require(learning_rate > 0, "learning_rate", learning_rate, "above 0, e.g. 0.0005");
  require(clip > 0, "clip", clip, "above 0, e.g. 3");
  require(mean_weight >= 0, "mean_weight", mean_weight, "0 or more");
  require(elbo_weight >= 0, "elbo_weight", elbo_weight, "0 or more");
  require(time_weight >= 0 && time_weight <= 1, "time_weight", time_weight, "0 to 1");
  require(dropout >= 0 && dropout < 1, "dropout", dropout, "0 to below 1");
  require(kernel >= 0, "kernel", kernel, "0 or more, e.g. 0.25");
  require(shape.normalisation != PfNormalisation::batch || particles == 0 || particles == shape.particles, "particles",
          double(particles), "0 when normalisation is over the batch");
}

PfTrainingOptions PfTrainingOptions::published() {
  PfTrainingOptions options;
  options.walk = Walk::random;
  options.deception = Deception::uniform;
  options.actions_drawn = 7;
  options.trajectories = 30;
  options.target = PfTarget::previous;
  options.batch = 128;
  options.particles = 0;
  options.learning_rate = 5e-4;
  options.decay = false;
  options.dropout = 0.5;
  options.elbo_weight = 1;
  options.kernel = 0;
  options.time_weight = 0.1;
  return options;
}

torch::Tensor pf_loss(const PfStep& step, const torch::Tensor& truth, double eps, const PfTrainingOptions& options) {
  const double unit = options.kernel > 0 ? eps : 1;  // both parts as published, or both in balls
  const torch::Tensor mean_loss = (step.mean - truth).square().sum(1) / (unit * unit);
  const torch::Tensor squares = (step.places - truth.unsqueeze(1)).square().sum(2);
  const double width = options.kernel * eps;
  const torch::Tensor errors = options.kernel > 0 ? squares / (2 * width * width) : squares;
  const double log_k = std::log(static_cast<double>(errors.size(1)));
  return mean_loss * options.mean_weight + (log_k - torch::logsumexp(-errors, 1)) * options.elbo_weight;
}

void train_pf_rnn(PfRnn& module, const PfTrainingOptions& options,
                  const std::function<bool(const PfTrainingProgress&)>& progress) {
  options.check(module.options());
  module.train();
  at::Generator generator = at::make_generator<at::CPUGeneratorImpl>(options.seed);
  torch::optim::RMSprop optimizer(module.parameters(), torch::optim::RMSpropOptions(options.learning_rate));
  Lanes lanes(options, module.options().eps);
  PfState state = module.initial(options.batch, options.particles);
  for (long update = 1; update <= options.updates; ++update) {
    set_learning_rate(optimizer, rate_at(update - 1, options));
    PfTrainingProgress now;
    now.update = update;
    const torch::Tensor loss = window_loss(module, lanes, state, options, generator, now);
    now.loss = loss.item<double>();
    if (!std::isfinite(now.loss)) {
      throw InputError(
          fmt::format("PF-RNN training: the loss is {} at update {}, expected a number, as with a smaller "
                      "learning_rate",
                      now.loss, update));
    }
    optimizer.zero_grad();
    loss.backward();
    torch::nn::utils::clip_grad_norm_(module.parameters(), options.clip);
    optimizer.step();
    if (progress && !progress(now)) break;
  }
  module.eval();
}

}  // namespace maximin::deep
