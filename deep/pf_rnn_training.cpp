#include <maximin/deep/pf_rnn_training.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

#include <ATen/CPUGeneratorImpl.h>
#include <fmt/format.h>

#include <maximin/deep/range_check.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
/// The trajectories in step.
class PfTrainer::Lanes {
 public:
  explicit Lanes(const PfTrainingOptions& options, double eps) : options_(options) {
    const auto n = static_cast<std::size_t>(options.batch);
    lanes_.assign(n, Wandering(options.walk, options.deception, eps, options.actions_drawn, options.horizon));
    stands_.resize(n);
    for (std::size_t lane = 0; lane < n; ++lane) begin(lane, next_++);
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
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      ++stands_[lane].steps;
      if (lanes_[lane].step()) continue;
      begin(lane, next_++);
      flag[lane] = 0;
    }
    return goes_on;
  }

  /// Which trajectory each lane is on and how far, [n, 2]: they are functions of that and the seed.
  torch::Tensor stands() const {
    torch::Tensor out = torch::empty({options_.batch, 2}, torch::kInt64);
    auto row = out.accessor<std::int64_t, 2>();
    for (std::size_t lane = 0; lane < stands_.size(); ++lane) {
      row[static_cast<long>(lane)][0] = stands_[lane].trajectory;
      row[static_cast<long>(lane)][1] = stands_[lane].steps;
    }
    return out;
  }
  /// Goes there, after `updates` windows. Throws InputError when no training stands so.
  void stand(const torch::Tensor& where, long updates) {
    const auto row = where.accessor<std::int64_t, 2>();
    const long most = options_.batch * (1 + updates * options_.window);
    next_ = 0;
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
      const Stand stand{row[static_cast<long>(lane)][0], row[static_cast<long>(lane)][1]};
      if (stand.trajectory < 0 || stand.trajectory >= most || stand.steps < 0 || stand.steps >= options_.horizon)
        throw InputError("trajectories beyond the training's, expected its own");
      begin(lane, stand.trajectory);
      for (; stands_[lane].steps < stand.steps; ++stands_[lane].steps) {
        if (!lanes_[lane].step()) throw InputError("a trajectory beyond its end, expected where it stood before");
      }
      next_ = std::max(next_, stand.trajectory + 1);
    }
  }

 private:
  struct Stand {
    long trajectory = 0, steps = 0;
  };

  template <class Place>
  torch::Tensor rows(Place&& place) const {
    std::vector<Point> points;
    for (const Wandering& lane : lanes_) points.push_back(place(lane));
    return to_tensor(points);
  }
  void begin(std::size_t lane, long trajectory) {
    const long drawn = options_.trajectories > 0 ? trajectory % options_.trajectories : trajectory;
    lanes_[lane].begin(options_.seed, static_cast<std::uint64_t>(drawn));
    stands_[lane] = {trajectory, 0};
  }

  PfTrainingOptions options_;
  std::vector<Wandering> lanes_;
  std::vector<Stand> stands_;
  long next_ = 0;
};

namespace {

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

void set_learning_rate(torch::optim::RMSprop& optimizer, double rate) {
  for (auto& group : optimizer.param_groups()) group.options().set_lr(rate);
}

const PfTrainingOptions& checked(const PfTrainingOptions& options, const PfRnn& module) {
  options.check(module.options());
  return options;
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

PfTrainer::PfTrainer(PfRnnPtr module, const PfTrainingOptions& options)
    : module_(std::move(module)),
      options_(checked(options, *module_)),
      lanes_(std::make_unique<Lanes>(options, module_->options().eps)),
      state_(module_->initial(options.batch, options.particles)),
      generator_(at::make_generator<at::CPUGeneratorImpl>(options.seed)),
      optimiser_(module_->parameters(), torch::optim::RMSpropOptions(options.learning_rate)) {
  module_->train();
}

PfTrainer::~PfTrainer() = default;

/// The mean loss over one window; the state and the lanes go on.
torch::Tensor PfTrainer::window_loss(PfTrainingProgress& progress) {
  torch::Tensor sum = torch::zeros({});
  double weights = 0;
  const auto steps = static_cast<double>(options_.window);
  for (long t = 0; t < options_.window; ++t) {
    const torch::Tensor shown = lanes_->shown(), truth = lanes_->truth(options_.target);
    const PfStep step = module_->step(state_, module_->encode(lanes_->sights()), shown,
                                      draw_noise(state_, module_->options(), options_.dropout, generator_));
    const double weight = std::exp(options_.time_weight * static_cast<double>(t));
    sum = sum + pf_loss(step, truth, module_->options().eps, options_).mean() * weight;
    weights += weight;
    progress.mean_error += mean_distance(step.mean.detach(), truth) / steps;
    progress.shown_error += mean_distance(shown, truth) / steps;
    state_ = step.state;
    restart(state_, lanes_->step());
  }
  detach(state_);
  return sum / weights;
}

PfTrainingProgress PfTrainer::update() {
  set_learning_rate(optimiser_, rate_at(updates_, options_));
  PfTrainingProgress now;
  now.update = updates_ + 1;
  const torch::Tensor loss = window_loss(now);
  now.loss = loss.item<double>();
  if (!std::isfinite(now.loss)) {
    throw InputError(
        fmt::format("PF-RNN training: the loss is {} at update {}, expected a number, as with a smaller "
                    "learning_rate",
                    now.loss, now.update));
  }
  optimiser_.zero_grad();
  loss.backward();
  torch::nn::utils::clip_grad_norm_(module_->parameters(), options_.clip);
  optimiser_.step();
  ++updates_;
  return now;
}

void PfTrainer::save(TensorFile& file) const {
  file.tensors["updates"] = torch::tensor({updates_}, torch::kInt64);
  file.tensors["trajectories"] = lanes_->stands();
  file.tensors["h"] = state_.h;
  if (state_.c.defined()) file.tensors["c"] = state_.c;
  file.tensors["log_weights"] = state_.log_weights;
  put_module(file, "module", *module_);
  file.tensors["random"] = generator_.get_state();
  // LibTorch alone knows what its optimiser holds.
  std::ostringstream optimiser;
  torch::save(optimiser_, optimiser);
  file.tensors["optimiser"] = tensor_of_bytes(optimiser.str());
}

void PfTrainer::load(const TensorFile& file) {
  torch::Tensor updates = torch::zeros({1}, torch::kInt64), stands = lanes_->stands();
  file.copy_to("updates", updates);
  file.copy_to("trajectories", stands);
  const long done = updates[0].item<long>();
  if (done < 0 || done > options_.updates) throw InputError("updates beyond the training's, expected its own");
  lanes_->stand(stands, done);
  file.copy_to("h", state_.h);
  if (state_.c.defined()) file.copy_to("c", state_.c);
  file.copy_to("log_weights", state_.log_weights);
  get_module(file, "module", *module_);
  std::istringstream optimiser(bytes_of_tensor(file.at("optimiser")));
  try {
    generator_.set_state(file.at("random"));
    torch::load(optimiser_, optimiser);
  } catch (const std::exception&) {
    throw InputError("optimiser or random numbers of another version of LibTorch, expected the one that wrote them");
  }
  updates_ = done;
}

void train_pf_rnn(const PfRnnPtr& module, const PfTrainingOptions& options,
                  const std::function<bool(const PfTrainingProgress&)>& progress) {
  PfTrainer trainer(module, options);
  while (!trainer.done()) {
    const PfTrainingProgress now = trainer.update();
    if (progress && !progress(now)) break;
  }
  module->eval();
}

}  // namespace maximin::deep
