#include <maximin/deep/replay.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// 8 GiB of places in beliefs.
constexpr long most_states = 1L << 30U;

}  // namespace

void ReplayOptions::check() const {
  const RangeCheck require("replay");
  require(capacity >= 1 && capacity <= 10'000'000, "capacity", static_cast<double>(capacity), "1 to 10 million");
  require(alpha >= 0 && alpha <= 4, "alpha", alpha, "0 to 4");
  require(beta_start >= 0 && beta_start <= 1, "beta_start", beta_start, "0 to 1");
}

Replay::Replay(const ReplayOptions& options, long belief_states) : options_(options) {
  options.check();
  const long n = options.capacity;
  if (n > most_states / belief_states) {
    throw InputError(fmt::format("replay: capacity {} with {} states to a belief, expected at most {} states in all", n,
                                 belief_states, most_states));
  }
  states_ = torch::zeros({n, 2});
  next_states_ = torch::zeros({n, 2});
  actions_ = torch::zeros({n}, torch::kInt64);
  rewards_ = torch::zeros({n});
  terminal_ = torch::zeros({n});
  beliefs_ = torch::zeros({n, belief_states, 2});
  belief_weights_ = torch::zeros({n, belief_states});
  if (options.prioritised) {
    leaves_ = static_cast<long>(std::bit_ceil(static_cast<unsigned long>(n)));
    tree_.assign(static_cast<std::size_t>(2 * leaves_), 0.0);
  }
}

void Replay::set_priority(long index, double priority) {
  auto node = static_cast<std::size_t>(leaves_ + index);
  tree_[node] = priority;
  while (node > 1) {
    node /= 2;
    tree_[node] = tree_[2 * node] + tree_[2 * node + 1];
  }
}

long Replay::pick(double mass) const {
  std::size_t node = 1;
  while (node < static_cast<std::size_t>(leaves_)) {
    node *= 2;
    if (mass >= tree_[node] && tree_[node + 1] > 0) mass -= tree_[node++];
  }
  return static_cast<long>(node) - leaves_;
}

void Replay::add(const Transition& t, const BeliefStates& next_belief, long row) {
  const long i = next_;
  float* state = states_.data_ptr<float>() + 2 * i;
  float* next = next_states_.data_ptr<float>() + 2 * i;
  state[0] = static_cast<float>(t.state.x);
  state[1] = static_cast<float>(t.state.y);
  next[0] = static_cast<float>(t.next.x);
  next[1] = static_cast<float>(t.next.y);
  actions_.data_ptr<long>()[i] = t.action;
  rewards_.data_ptr<float>()[i] = static_cast<float>(t.reward);
  terminal_.data_ptr<float>()[i] = t.terminal ? 1.0F : 0.0F;
  const long k = beliefs_.size(1);
  TORCH_INTERNAL_ASSERT(t.terminal || (next_belief.states.is_contiguous() && next_belief.states.size(1) == k &&
                                       next_belief.states.scalar_type() == torch::kFloat));
  float* belief = beliefs_.data_ptr<float>() + 2 * k * i;
  float* weight = belief_weights_.data_ptr<float>() + k * i;
  if (t.terminal) {
    std::fill_n(belief, 2 * k, 0.0F);
    std::fill_n(weight, k, 1.0F / static_cast<float>(k));
  } else {
    std::copy_n(next_belief.states.data_ptr<float>() + 2 * k * row, 2 * k, belief);
    std::copy_n(next_belief.weights.data_ptr<float>() + k * row, k, weight);
  }
  if (options_.prioritised) set_priority(i, largest_);
  next_ = (next_ + 1) % options_.capacity;
  size_ = std::min(size_ + 1, options_.capacity);
}

Replay::Draw Replay::draw(long b, double progress, Stream& rng, torch::Device device) const {
  Draw out;
  out.importance = torch::ones({b});
  float* importance = out.importance.data_ptr<float>();
  const double beta = options_.beta_start + (1 - options_.beta_start) * std::clamp(progress, 0.0, 1.0);
  for (long j = 0; j < b; ++j) {
    if (!options_.prioritised) {
      out.indices.push_back(rng.below(static_cast<int>(size_)));
      continue;
    }
    out.indices.push_back(pick(rng.uniform() * tree_[1]));
    const double p = tree_[static_cast<std::size_t>(leaves_ + out.indices.back())] / tree_[1];
    importance[j] = static_cast<float>(std::pow(p * static_cast<double>(size_), -beta));
  }
  if (options_.prioritised) out.importance /= out.importance.max();
  const torch::Tensor rows = torch::tensor(out.indices, torch::kInt64);
  const auto take = [&](const torch::Tensor& t) { return t.index_select(0, rows).to(device); };
  out.batch = {take(states_),   take(actions_),     take(rewards_),
               take(terminal_), take(next_states_), {take(beliefs_), take(belief_weights_)}};
  out.importance = out.importance.to(device);
  return out;
}

void Replay::reprioritise(const std::vector<long>& indices, const torch::Tensor& td_error) {
  if (!options_.prioritised) return;
  const torch::Tensor errors = td_error.to(torch::kCPU, torch::kFloat).contiguous();
  for (std::size_t j = 0; j < indices.size(); ++j) {
    const double size = std::abs(static_cast<double>(errors.data_ptr<float>()[j])) + 1e-6;
    const double priority = std::pow(size, options_.alpha);
    largest_ = std::max(largest_, priority);
    set_priority(indices[j], priority);
  }
}

namespace {

constexpr const char* row_names[] = {"states",      "actions", "rewards",       "terminal",
                                     "next_states", "beliefs", "belief_weights"};

}  // namespace

std::array<torch::Tensor, 7> Replay::rows() const {
  return {states_, actions_, rewards_, terminal_, next_states_, beliefs_, belief_weights_};
}

void Replay::save(TensorFile& file) const {
  file.tensors["replay.counters"] = torch::tensor({size_, next_}, torch::kInt64);
  file.tensors["replay.largest"] = torch::tensor({largest_}, torch::kDouble);
  const auto all = rows();
  for (std::size_t i = 0; i < all.size(); ++i) {
    file.tensors[std::string("replay.") + row_names[i]] = all[i].slice(0, 0, size_);
  }
  if (!options_.prioritised) return;
  const std::vector<double> leaves(tree_.begin() + leaves_, tree_.begin() + leaves_ + size_);
  file.tensors["replay.priorities"] = torch::tensor(leaves, torch::kDouble);
}

void Replay::load(const TensorFile& file) {
  torch::Tensor counters = torch::zeros({2}, torch::kInt64), largest = torch::zeros({1}, torch::kDouble);
  file.copy_to("replay.counters", counters);
  file.copy_to("replay.largest", largest);
  const long size = counters[0].item<long>(), next = counters[1].item<long>();
  if (size < 0 || size > options_.capacity || next < 0 || next >= options_.capacity ||
      (size < options_.capacity && next != size)) {
    throw InputError(
        fmt::format("replay memory of {} transitions, the next at {}, expected at most {} and the next "
                    "behind the last",
                    size, next, options_.capacity));
  }
  const auto all = rows();
  for (std::size_t i = 0; i < all.size(); ++i) {
    file.copy_to(std::string("replay.") + row_names[i], all[i].slice(0, 0, size));
  }
  const torch::Tensor taken = actions_.slice(0, 0, size);
  if (taken.lt(0).any().item<bool>() || taken.ge(ContinuousGridworld::actions).any().item<bool>()) {
    throw InputError("replay memory with an action that there is none of, expected 0 to 7");
  }
  size_ = size;
  next_ = next;
  largest_ = largest[0].item<double>();
  if (!options_.prioritised) return;
  torch::Tensor leaves = torch::zeros({size_}, torch::kDouble);
  file.copy_to("replay.priorities", leaves);
  if (!(largest_ > 0 && std::isfinite(largest_)) || !(leaves.gt(0) & leaves.isfinite()).all().item<bool>()) {
    throw InputError("replay memory with a priority that is none, expected positive numbers");
  }
  std::fill(tree_.begin(), tree_.end(), 0.0);
  std::copy_n(leaves.data_ptr<double>(), size_, tree_.begin() + leaves_);
  for (std::size_t node = static_cast<std::size_t>(leaves_) - 1; node >= 1; --node) {
    tree_[node] = tree_[2 * node] + tree_[2 * node + 1];
  }
}

}  // namespace maximin::deep
