#include <maximin/deep/trainer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// Streams of one training: those of lane l in stretch n are number n * 2^20 + l, that of its draws from the replay
// memory n * 2^20 + 2^19.
Stream stream_of(std::uint64_t seed, long stretch, long which) {
  return Stream(seed, static_cast<std::uint64_t>(stretch) << 20U | static_cast<std::uint64_t>(which));
}
constexpr long replay_stream = 1L << 19;

}  // namespace

void TrainOptions::check() const {
  const RangeCheck require("training");
  require(frames >= 1, "frames", double(frames), "at least 1");
  require(lanes >= 1 && lanes <= 4096, "lanes", lanes, "1 to 4096");
  require(horizon >= 1, "horizon", double(horizon), "at least 1");
  require(frames_per_update >= 1, "frames_per_update", double(frames_per_update), "at least 1");
  require(batch >= 1 && batch <= 65536, "batch", double(batch), "1 to 65536");
  require(learning_rate > 0, "learning_rate", learning_rate, "a positive number");
  require(final_learning_rate >= 0, "final_learning_rate", final_learning_rate, "0 or more");
  require(adam_eps > 0, "adam_eps", adam_eps, "a positive number");
  require(gradient_clip > 0, "gradient_clip", gradient_clip, "a positive number");
  require(warm_up >= 0, "warm_up", double(warm_up), "0 or more");
  // Sums of them stay whole numbers.
  require(frames <= 1'000'000'000'000 && stretch_frames <= 1'000'000'000'000, "frames or stretch_frames",
          double(std::max(frames, stretch_frames)), "10^12 at most");
  require(averaged_share >= 0 && averaged_share <= 1, "averaged_share", averaged_share, "0 to 1");
  require(explore_start >= 0 && explore_start <= 1, "explore_start", explore_start, "0 to 1");
  require(explore_end >= 0 && explore_end <= 1, "explore_end", explore_end, "0 to 1");
  require(target_every >= 1, "target_every", double(target_every), "at least 1");
  require(reward_scale > 0, "reward_scale", reward_scale, "a positive number");
  require(stretch_frames >= lanes, "stretch_frames", double(stretch_frames), "at least one per lane");
  replay.check();
}

Trainer::Trainer(const TrainOptions& options, TrainingParts parts)
    : options_(options), parts_(std::move(parts)), replay_(options.replay, parts_.belief->states_per_belief()) {
  options_.check();
  const long outputs = parts_.online->shape().actions, actions = parts_.world->actions();
  if (outputs != actions) {
    throw InputError(
        fmt::format("training: a network of {} actions in a world of {}, expected as many", outputs, actions));
  }
  parts_.online->to(parts_.device);
  target_ = frozen_copy(*parts_.online);
  average_ = frozen_copy(*parts_.online);
  agent_ = std::make_unique<BeliefAgent>(parts_.loss->acting(parts_.online), parts_.belief, parts_.aggregator);
  std::vector<torch::Tensor> trained = parts_.online->parameters();
  for (const auto& module : parts_.loss->modules()) {
    module->to(parts_.device);
    for (auto& p : module->parameters()) {
      if (p.requires_grad()) trained.push_back(p);
    }
  }
  optimiser_ = std::make_unique<torch::optim::Adam>(
      trained, torch::optim::AdamOptions(options_.learning_rate).eps(options_.adam_eps));
  const auto n = static_cast<std::size_t>(options_.lanes);
  for (Lane l = 0; l < options_.lanes; ++l) all_lanes_.push_back(l);
  truths_.resize(n);
  learner_states_.resize(n);
  actions_.resize(n);
  pending_.resize(n);
  episodes_.resize(n);
  const long states = parts_.belief->states_per_belief();
  held_ = {torch::zeros({options_.lanes, states, 2}), torch::zeros({options_.lanes, states})};
}

double Trainer::exploration() const {
  const double share = options_.explore_frames <= 0
                           ? 1
                           : std::min(1.0, static_cast<double>(frames_) / static_cast<double>(options_.explore_frames));
  return options_.explore_start + share * (options_.explore_end - options_.explore_start);
}

void Trainer::begin_episode(std::size_t lane) {
  truths_[lane] = parts_.world->reset(streams_[lane]);
  agent_->forget(static_cast<Lane>(lane));
  parts_.attack->forget(static_cast<Lane>(lane));
  episodes_[lane] = {};
  pending_[lane] = {};
}

void Trainer::begin_lanes() {
  streams_.clear();
  for (const Lane l : all_lanes_) streams_.push_back(stream_of(options_.seed, stretches_, l));
  draws_ = stream_of(options_.seed, stretches_, replay_stream);
  agent_->resize(options_.lanes);
  parts_.attack->resize(options_.lanes);
  for (std::size_t l = 0; l < all_lanes_.size(); ++l) begin_episode(l);
}

/// What the learner takes for the state: the truth, or the mean of what is believed.
Point Trainer::learner_state(long row, Point truth) const {
  if (!options_.learn_from_belief) return truth;
  const BeliefStates& belief = agent_->acted_on();
  const torch::Tensor mean = (belief.states[row] * belief.weights[row].unsqueeze(1)).sum(0);
  return {mean[0].item<double>(), mean[1].item<double>()};
}

/// The attack shows, the agent believes and chooses, in these lanes.
void Trainer::look(std::span<const Lane> lanes) {
  std::vector<Point> truths, shown(lanes.size());
  std::vector<Action> actions(lanes.size());
  for (const Lane l : lanes) truths.push_back(truths_[static_cast<std::size_t>(l)]);
  parts_.attack->perturb(lanes, truths, *agent_, streams_, shown);
  agent_->act(lanes, shown, streams_, actions);
  for (std::size_t k = 0; k < lanes.size(); ++k) actions_[static_cast<std::size_t>(lanes[k])] = actions[k];
}

/// Keeps the beliefs that the last look came to.
void Trainer::hold(std::span<const Lane> lanes) {
  const BeliefStates& seen = agent_->acted_on();
  const torch::Tensor rows = torch::tensor(std::vector<Lane>(lanes.begin(), lanes.end()), torch::kLong);
  held_.states.index_copy_(0, rows, seen.states);
  held_.weights.index_copy_(0, rows, seen.weights);
}

/// Stores the transitions that waited for the next belief, and begins episodes anew where one was cut.
void Trainer::settle(std::span<const Lane> lanes) {
  std::vector<Lane> anew;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    Pending& waiting = pending_[l];
    learner_states_[l] = learner_state(static_cast<long>(k), truths_[l]);
    if (waiting.waiting) {
      waiting.transition.next = learner_states_[l];
      const bool stale = options_.bootstrap == BootstrapBelief::current;
      replay_.add(waiting.transition, stale ? held_ : agent_->acted_on(), stale ? lanes[k] : static_cast<long>(k));
      waiting.waiting = false;
    }
    if (waiting.truncated) {
      begin_episode(l);
      anew.push_back(lanes[k]);
    }
  }
  hold(lanes);
  if (anew.empty()) return;
  look(anew);
  hold(anew);
  for (std::size_t k = 0; k < anew.size(); ++k) {
    const auto l = static_cast<std::size_t>(anew[k]);
    learner_states_[l] = learner_state(static_cast<long>(k), truths_[l]);
  }
}

/// Every lane takes its action.
void Trainer::move(CurvePoint& point) {
  for (std::size_t l = 0; l < all_lanes_.size(); ++l) {
    const Outcome<Point> outcome = parts_.world->step(truths_[l], actions_[l], streams_[l]);
    Episode& episode = episodes_[l];
    episode.total_reward += outcome.reward;
    ++episode.steps;
    const bool cut = !outcome.terminal && episode.steps >= options_.horizon;
    const bool over = outcome.terminal || (cut && options_.truncation_is_terminal);
    pending_[l].transition = {learner_states_[l], actions_[l], outcome.reward * options_.reward_scale, outcome.next,
                              over};
    truths_[l] = outcome.next;
    if (outcome.terminal || cut) {
      ++point.episodes;
      point.mean_return += episode.total_reward;
    }
    if (over) {
      replay_.add(pending_[l].transition, held_, static_cast<long>(l));
      begin_episode(l);
    } else {
      pending_[l].waiting = true;
      pending_[l].truncated = cut;
    }
  }
  frames_ += static_cast<long>(all_lanes_.size());
}

/// The updates that are due.
void Trainer::learn(CurvePoint& point, long& updates) {
  if (frames_ < options_.warm_up || replay_.size() == 0) return;
  owed_ += static_cast<double>(all_lanes_.size()) / static_cast<double>(options_.frames_per_update);
  const double fraction = static_cast<double>(frames_) / static_cast<double>(options_.frames);
  const double rate =
      options_.learning_rate + std::min(1.0, fraction) * (options_.final_learning_rate - options_.learning_rate);
  optimiser_->param_groups()[0].options().set_lr(rate);
  for (; owed_ >= 1; owed_ -= 1) {
    const Replay::Draw draw = replay_.draw(options_.batch, fraction, draws_, parts_.device);
    const LossValue value = (*parts_.loss)(draw.batch, *parts_.online, *target_, {fraction});
    const torch::Tensor loss = (value.loss * draw.importance).mean();
    const double size = loss.item<double>();
    if (!std::isfinite(size)) {
      throw InputError(
          fmt::format("training: the loss is {} after {} frames, expected a number, as with a smaller "
                      "learning_rate",
                      size, frames_));
    }
    optimiser_->zero_grad();
    loss.backward();
    torch::nn::utils::clip_grad_norm_(optimiser_->param_groups()[0].params(), options_.gradient_clip);
    optimiser_->step();
    replay_.reprioritise(draw.indices, value.td_error);
    point.loss += size;
    ++updates;
  }
  if (frames_ - copied_at_ >= options_.target_every) copy_to_target();
}

void Trainer::copy_to_target() {
  target_->copy_from(*parts_.online);
  parts_.loss->copy_targets();
  copied_at_ = frames_;
  const double left = static_cast<double>(options_.frames - frames_) / static_cast<double>(options_.frames);
  if (!(options_.averaged_share > 0) || left >= options_.averaged_share) return;
  ++averaged_;
  torch::NoGradGuard no_grad;
  const auto online = parts_.online->parameters(), average = average_->parameters();
  for (std::size_t i = 0; i < average.size(); ++i) {
    torch::Tensor mean = average[i];
    mean += (online[i] - mean) / static_cast<double>(averaged_);
  }
}

CurvePoint Trainer::stretch() {
  CurvePoint point;
  long updates = 0, looks = 0, held = 0;
  double area = 0;
  begin_lanes();
  // What would be less than half a stretch belongs to the one before it.
  const long left = options_.frames - frames_;
  const long wanted = 2 * left < 3 * options_.stretch_frames ? left : options_.stretch_frames;
  const long ticks = (wanted + options_.lanes - 1) / options_.lanes;
  for (long tick = 0; tick < ticks; ++tick) {
    agent_->set_random_actions(exploration());
    look(all_lanes_);
    for (std::size_t l = 0; l < all_lanes_.size(); ++l) {
      held += agent_->belief().holds(all_lanes_[l], truths_[l]);
      area += agent_->belief().size(all_lanes_[l]);
      ++looks;
    }
    settle(all_lanes_);
    move(point);
    learn(point, updates);
  }
  look(all_lanes_);
  settle(all_lanes_);
  ++stretches_;
  updates_ += updates;
  if (done() && averaged_ > 0) parts_.online->copy_from(*average_);
  const double none = std::numeric_limits<double>::quiet_NaN();
  point.frames = frames_;
  point.updates = updates_;
  point.mean_return = point.episodes > 0 ? point.mean_return / static_cast<double>(point.episodes) : none;
  point.loss = updates > 0 ? point.loss / static_cast<double>(updates) : none;
  point.exploration = exploration();
  point.believed = static_cast<double>(held) / static_cast<double>(looks);
  point.belief_size = area / static_cast<double>(looks);
  return point;
}

void Trainer::save(TensorFile& file) const {
  file.tensors["counters"] = torch::tensor({frames_, updates_, stretches_, copied_at_, averaged_}, torch::kInt64);
  file.tensors["owed"] = torch::tensor({owed_}, torch::kDouble);
  put_module(file, "online", *parts_.online);
  put_module(file, "target", *target_);
  put_module(file, "average", *average_);
  const auto modules = parts_.loss->modules();
  for (std::size_t i = 0; i < modules.size(); ++i) put_module(file, "loss" + std::to_string(i), *modules[i]);
  replay_.save(file);
  // LibTorch alone knows what its optimiser holds.
  std::ostringstream optimiser;
  torch::save(*optimiser_, optimiser);
  file.tensors["optimiser"] = tensor_of_bytes(optimiser.str());
}

void Trainer::load(const TensorFile& file) {
  torch::Tensor counters = torch::zeros({5}, torch::kInt64), owed = torch::zeros({1}, torch::kDouble);
  file.copy_to("counters", counters);
  file.copy_to("owed", owed);
  if (counters.lt(0).any().item<bool>()) throw InputError("counters below 0, expected what a training counted");
  const double due = owed[0].item<double>(), at_most = 1 + static_cast<double>(options_.lanes);
  const bool counted =
      counters[0].item<long>() <= options_.frames && counters[3].item<long>() <= counters[0].item<long>();
  if (!counted || !(due >= 0 && due <= at_most)) throw InputError("counters beyond the training's, expected its own");
  get_module(file, "online", *parts_.online);
  get_module(file, "target", *target_);
  get_module(file, "average", *average_);
  const auto modules = parts_.loss->modules();
  for (std::size_t i = 0; i < modules.size(); ++i) get_module(file, "loss" + std::to_string(i), *modules[i]);
  replay_.load(file);
  std::istringstream optimiser(bytes_of_tensor(file.at("optimiser")));
  try {
    torch::load(*optimiser_, optimiser);
  } catch (const std::exception&) {
    throw InputError("optimiser of another kind or version of LibTorch, expected the one that wrote it");
  }
  frames_ = counters[0].item<long>();
  updates_ = counters[1].item<long>();
  stretches_ = counters[2].item<long>();
  copied_at_ = counters[3].item<long>();
  averaged_ = counters[4].item<long>();
  owed_ = owed[0].item<double>();
}

}  // namespace maximin::deep
