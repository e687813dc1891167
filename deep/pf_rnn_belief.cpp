#include <maximin/deep/pf_rnn_belief.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include <maximin/deep/range_check.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/gridworld/box_belief.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

constexpr Box whole_world{0, gridworld::side, 0, gridworld::side};
/// A corrected place keeps this distance from the edges of the box that it is in, so that it is there as a float too.
constexpr double float_margin = 4e-6;

double into(double v, double low, double high) {
  const double margin = std::min(float_margin, (high - low) / 2);
  return std::clamp(v, low + margin, high - margin);
}

double sup_distance(Point a, Point b) {
  return std::max(std::abs(a.x - b.x), std::abs(a.y - b.y));
}

/// The nearest place of the set, which must not be empty.
Point nearest(Point p, const BoxUnion& set) {
  Point best;
  double best_square = std::numeric_limits<double>::infinity();
  for (const Box& box : set.boxes()) {
    const Point q{into(p.x, box.x_low, box.x_high), into(p.y, box.y_low, box.y_high)};
    const double square = (q.x - p.x) * (q.x - p.x) + (q.y - p.y) * (q.y - p.y);
    if (square < best_square) {
      best = q;
      best_square = square;
    }
  }
  return best;
}

Box hull_of(std::span<const Point> places, double margin) {
  Box hull{places[0].x, places[0].x, places[0].y, places[0].y};
  for (const Point& p : places) {
    hull = {std::min(hull.x_low, p.x), std::max(hull.x_high, p.x), std::min(hull.y_low, p.y),
            std::max(hull.y_high, p.y)};
  }
  return {hull.x_low - margin, hull.x_high + margin, hull.y_low - margin, hull.y_high + margin};
}

std::array<std::uint32_t, 2> key_of(Point first, std::uint64_t seed) {
  const auto x = std::bit_cast<std::uint64_t>(first.x), y = std::bit_cast<std::uint64_t>(first.y);
  const auto words = philox4x32({static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(x >> 32),
                                 static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(y >> 32)},
                                {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  return {words[0], words[1]};
}

/// Uniform on (0, 1], as far as a float tells.
float uniform_float(std::uint32_t word) {
  return (static_cast<float>(word >> 8) + 0.5F) * 0x1p-24F;
}

/// `count` uniform numbers of step `step` of an episode; `stream` tells apart what they are for.
void fill_uniform(float* out, long count, std::array<std::uint32_t, 2> key, std::uint32_t step, std::uint32_t stream) {
  for (long i = 0; i < count; i += 4) {
    const auto words = philox4x32({static_cast<std::uint32_t>(i), step, stream, 0}, key);
    for (long j = i; j < std::min(i + 4, count); ++j) *out++ = uniform_float(words[static_cast<std::size_t>(j - i)]);
  }
}

/// Box and Muller: pairs of rows of uniform numbers [n, 2, m] to standard normal ones [n, 2m].
torch::Tensor to_normal(const torch::Tensor& uniform) {
  const torch::Tensor radius = uniform.select(1, 0).log().mul_(-2).sqrt_();
  const torch::Tensor angle = uniform.select(1, 1) * (2 * std::numbers::pi);
  return torch::cat({angle.cos().mul_(radius), angle.sin().mul_(radius)}, 1);
}

PfState select(const PfState& state, const torch::Tensor& lanes) {
  return {state.h.index_select(0, lanes), state.c.defined() ? state.c.index_select(0, lanes) : torch::Tensor(),
          state.log_weights.index_select(0, lanes)};
}

torch::Tensor as_index(std::span<const Lane> lanes) {
  torch::Tensor index = torch::empty({static_cast<long>(lanes.size())}, torch::kLong);
  std::copy(lanes.begin(), lanes.end(), index.data_ptr<std::int64_t>());
  return index;
}

}  // namespace

PfBeliefOptions PfBeliefOptions::released() {
  PfBeliefOptions options;
  options.correct = false;
  options.forgets = false;
  return options;
}

void PfBeliefOptions::check() const {
  const RangeCheck require("PF-RNN belief");
  require(slack >= 0, "slack", slack, "0 or more, e.g. 0.5");
  require(hull_margin >= 0, "hull_margin", hull_margin, "0 or more, e.g. 0.25");
}

PfRnnBelief::PfRnnBelief(PfRnnPtr module, const PfBeliefOptions& options)
    : module_(std::move(module)), options_(options), ball_(module_->options().eps) {
  options_.check();
  module_->eval();
}

void PfRnnBelief::resize(Lane lanes) {
  const c10::InferenceMode inference;
  memory_.assign(static_cast<std::size_t>(lanes), Memory{});
  for (Memory& memory : memory_) memory.hull = whole_world;
  state_ = module_->initial(lanes);
  empty_ = 0;
}

void PfRnnBelief::forget(Lane lane) {
  if (!options_.forgets) return;
  const c10::InferenceMode inference;
  memory_.at(static_cast<std::size_t>(lane)) = Memory{};
  memory_[static_cast<std::size_t>(lane)].hull = whole_world;
  state_.h.select(0, lane).zero_();
  if (state_.c.defined()) state_.c.select(0, lane).zero_();
  state_.log_weights.select(0, lane).fill_(-std::log(static_cast<double>(states_per_belief())));
}

PfRnnBelief::Memory PfRnnBelief::after(const Memory& before, Point shown) const {
  Memory next = before;
  if (!before.started) next.key = key_of(shown, options_.seed);
  next.started = true;
  next.last = shown;
  next.step = before.started ? before.step + 1 : 0;
  return next;
}

PfNoise PfRnnBelief::noise(std::span<const Memory> memories) const {
  const long n = static_cast<long>(memories.size()), k = states_per_belief(), h = module_->options().hidden;
  const long half = (k * h + 1) / 2;
  torch::Tensor uniform = torch::empty({n, 2, half});
  PfNoise noise;
  noise.uniform = torch::empty({n, k});
  float* for_normal = uniform.data_ptr<float>();
  float* for_ancestors = noise.uniform.data_ptr<float>();
  for (const Memory& memory : memories) {
    fill_uniform(for_normal, 2 * half, memory.key, memory.step, 0);
    fill_uniform(for_ancestors, k, memory.key, memory.step, 1);
    for_normal += 2 * half;
    for_ancestors += k;
  }
  noise.normal = to_normal(uniform).narrow(1, 0, k * h).reshape({n, k, h});
  return noise;
}

bool PfRnnBelief::correct(Point shown, std::span<Point> places) const {
  const Box ball = ball_.around(shown);
  BoxUnion possible;
  bool met = false;
  for (Point& p : places) {
    const Point inside{into(p.x, ball.x_low, ball.x_high), into(p.y, ball.y_low, ball.y_high)};
    Point q = inside;
    if (gridworld::cell(inside) != gridworld::Cell::free || std::abs(inside.x - std::round(inside.x)) < float_margin ||
        std::abs(inside.y - std::round(inside.y)) < float_margin) {
      if (possible.empty()) possible = open_area().meet(ball);
      if (possible.empty()) break;
      q = nearest(p, possible);
    }
    met = met || sup_distance(p, q) <= options_.slack * ball_.eps();
    p = q;
  }
  if (met) return true;
  if (possible.empty()) possible = open_area().meet(ball);
  if (possible.empty()) possible = open_area();
  const std::vector<Point> even = possible.spread(static_cast<int>(places.size()));
  std::copy(even.begin(), even.end(), places.begin());
  return false;
}

PfRnnBelief::Look PfRnnBelief::look(std::span<const Lane> lanes, std::span<const Action> actions,
                                    std::span<const Point> shown) const {
  Look result;
  const auto n = lanes.size();
  if (n == 0) return {{}, {torch::empty({0, states_per_belief(), 2}), torch::empty({0, states_per_belief()})}, 0};
  std::vector<PfSight> sights(n);
  std::vector<Memory> memories(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Memory& before = memory_.at(static_cast<std::size_t>(lanes[k]));
    sights[k] = {shown[k], before.last, before.started ? actions[k] : -1};
    memories[k] = after(before, shown[k]);
  }
  PfStep step;
  std::vector<Point> places;
  {
    const c10::InferenceMode inference;
    step = module_->step(select(state_, as_index(lanes)), module_->encode(sights), to_tensor(shown), noise(memories));
    places = to_points(step.places.view({-1, 2}));
  }
  result.state = std::move(step.state);
  // Out of inference mode: what is handed out may be input of a network that is trained.
  torch::Tensor weights = torch::empty(step.weights.sizes());
  weights.copy_(step.weights);
  const auto k = static_cast<std::size_t>(states_per_belief());
  for (std::size_t lane = 0; options_.correct && lane < n; ++lane) {
    if (correct(shown[lane], std::span<Point>(places).subspan(lane * k, k))) continue;
    ++result.empty;
    weights[static_cast<long>(lane)].fill_(1 / static_cast<double>(k));
  }
  result.belief = {to_tensor(places).view({static_cast<long>(n), static_cast<long>(k), 2}), weights};
  return result;
}

BeliefStates PfRnnBelief::update(std::span<const Lane> lanes, std::span<const Action> actions,
                                 std::span<const Point> shown) {
  Look seen = look(lanes, actions, shown);
  if (lanes.empty()) return seen.belief;
  const c10::InferenceMode inference;
  const torch::Tensor index = as_index(lanes);
  state_.h.index_copy_(0, index, seen.state.h);
  if (state_.c.defined()) state_.c.index_copy_(0, index, seen.state.c);
  state_.log_weights.index_copy_(0, index, seen.state.log_weights);
  const std::vector<Point> places = to_points(seen.belief.states.view({-1, 2}));
  const auto k = static_cast<std::size_t>(states_per_belief());
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    Memory& memory = memory_[static_cast<std::size_t>(lanes[i])];
    memory = after(memory, shown[i]);
    memory.hull = hull_of(std::span<const Point>(places).subspan(i * k, k), options_.hull_margin * ball_.eps());
  }
  empty_ += seen.empty;
  return seen.belief;
}

BeliefStates PfRnnBelief::peek(std::span<const Lane> lanes, std::span<const Action> actions,
                               std::span<const Point> shown) const {
  return look(lanes, actions, shown).belief;
}

bool PfRnnBelief::holds(Lane lane, Point truth) const {
  return memory_.at(static_cast<std::size_t>(lane)).hull.contains(truth);
}

double PfRnnBelief::size(Lane lane) const {
  return open_area().meet(memory_.at(static_cast<std::size_t>(lane)).hull).area();
}

}  // namespace maximin::deep
