#include <maximin/deep/wandering.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace maximin::deep {
namespace {

constexpr int side = gridworld::side;
constexpr int cells = side * side;
constexpr int gold_cell = 4 * side + 9;

int number_of(Point p) {
  return static_cast<int>(std::floor(p.y)) * side + static_cast<int>(std::floor(p.x));
}

/// next[target][cell]: the neighbour by which a shortest way from the cell to the target goes, through free cells; the
/// cell itself where there is none.
using Ways = std::array<std::array<std::int8_t, cells>, cells>;

void ways_to(int target, std::array<std::int8_t, cells>& next) {
  for (int c = 0; c < cells; ++c) next[static_cast<std::size_t>(c)] = static_cast<std::int8_t>(c);
  std::vector<int> queue{target};
  std::array<bool, cells> seen{};
  seen[static_cast<std::size_t>(target)] = true;
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int i = queue[head] % side, j = queue[head] / side;
    for (const auto& [di, dj] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
      if (gridworld::cell(i + di, j + dj) != gridworld::Cell::free) continue;
      const int c = (j + dj) * side + i + di;
      if (seen[static_cast<std::size_t>(c)]) continue;
      seen[static_cast<std::size_t>(c)] = true;
      next[static_cast<std::size_t>(c)] = static_cast<std::int8_t>(queue[head]);
      queue.push_back(c);
    }
  }
}

const Ways& ways() {
  static const Ways table = [] {
    Ways all{};
    for (int target = 0; target < cells; ++target) ways_to(target, all[static_cast<std::size_t>(target)]);
    return all;
  }();
  return table;
}

int draw_target(Stream& rng) {
  if (rng.chance(1.0 / 3)) return gold_cell;
  while (true) {
    const int c = rng.below(cells);
    if (gridworld::cell(c % side, c / side) == gridworld::Cell::free) return c;
  }
}

double sign(Stream& rng) {
  return rng.chance(0.5) ? 1 : -1;
}

double wave(const double (&w)[3], Point p) {
  return std::sin(w[0] * p.x + w[1] * p.y + w[2]) >= 0 ? 1 : -1;
}

}  // namespace

void Wanderer::begin(Stream& rng) {
  now_ = walk_ == Walk::mixed ? static_cast<Walk>(rng.below(3)) : walk_;
  constexpr std::array<double, 3> keeps{0.5, 0.8, 0.95};
  keep_ = now_ == Walk::persistent ? keeps[static_cast<std::size_t>(rng.below(3))] : 0;
  last_ = rng.below(actions_drawn_);
  target_ = draw_target(rng);
}

Action Wanderer::act(Point truth, Stream& rng) {
  if (now_ == Walk::purposeful && !rng.chance(0.1)) return head_for_target(truth, rng);
  if (!rng.chance(keep_)) last_ = rng.below(actions_drawn_);
  return last_;
}

// The action whose direction is nearest to that of the centre of the next cell.
Action Wanderer::head_for_target(Point truth, Stream& rng) {
  const int here = number_of(truth);
  if (here == target_) target_ = draw_target(rng);
  const int next = ways()[static_cast<std::size_t>(target_)][static_cast<std::size_t>(here)];
  const double dx = next % side + 0.5 - truth.x, dy = next / side + 0.5 - truth.y;
  Action best = 0;
  double best_length = -1e9;
  for (Action a = 0; a < ContinuousGridworld::actions; ++a) {
    const gridworld::Move& move = gridworld::moves[static_cast<std::size_t>(a)];
    const double length = dx * move.dx + dy * move.dy;
    if (length > best_length) {
      best = a;
      best_length = length;
    }
  }
  return best;
}

void Deceiver::begin(Stream& rng) {
  draw_kind(rng);
}

void Deceiver::draw_kind(Stream& rng) {
  now_ = deception_;
  double radius = eps_;
  if (deception_ == Deception::mixed) {
    // Noise in the whole ball tells least, so it is drawn more often than others.
    const int kind = rng.below(deceptions + 1);
    now_ = kind == deceptions ? Deception::uniform : static_cast<Deception>(kind);
    if (rng.chance(0.15)) radius *= rng.uniform();
  }
  ball_ = ObservationBall(radius);
  side_x_ = sign(rng);
  side_y_ = sign(rng);
  flip_ = rng.uniform(0.05, 0.5);
  offset_ = {rng.uniform(-radius, radius), rng.uniform(-radius, radius)};
  target_ = {rng.uniform(0, side), rng.uniform(0, side)};
  for (double& w : wave_x_) w = rng.uniform(-3, 3);
  for (double& w : wave_y_) w = rng.uniform(-3, 3);
}

Point Deceiver::wanted(Point truth, Action last, Stream& rng) {
  const double r = ball_.eps();
  switch (now_) {
    case Deception::uniform:
      return ball_.draw(truth, rng);
    case Deception::flipping:
      if (rng.chance(flip_)) side_x_ = -side_x_;
      if (rng.chance(flip_)) side_y_ = -side_y_;
      [[fallthrough]];
    case Deception::corner:
      return {truth.x + side_x_ * r, truth.y + side_y_ * r};
    case Deception::drifting:
      offset_.x = std::clamp(offset_.x + rng.uniform(-0.3, 0.3) * r, -r, r);
      offset_.y = std::clamp(offset_.y + rng.uniform(-0.3, 0.3) * r, -r, r);
      return {truth.x + offset_.x, truth.y + offset_.y};
    case Deception::lagging:
      return last < 0 ? Point{truth.x + offset_.x, truth.y + offset_.y} : shown_;
    case Deception::leading: {
      if (last < 0) return {truth.x + offset_.x, truth.y + offset_.y};
      const gridworld::Move& move = gridworld::moves.at(static_cast<std::size_t>(last));
      return {truth.x + 100 * move.dx, truth.y + 100 * move.dy};
    }
    case Deception::beckoning:
      return target_;
    case Deception::field:
      return {truth.x + wave(wave_x_, truth) * r, truth.y + wave(wave_y_, truth) * r};
    case Deception::none:
    case Deception::mixed:
      break;
  }
  return truth;
}

Point Deceiver::show(Point truth, Action last, Stream& rng) {
  if (deception_ == Deception::mixed && last >= 0 && rng.chance(0.05)) draw_kind(rng);
  shown_ = ball_.project(truth, wanted(truth, last, rng));
  return shown_;
}

void Wandering::begin(std::uint64_t seed, std::uint64_t episode) {
  rng_ = Stream(seed, episode);
  steps_ = 0;
  last_action_ = -1;
  truth_ = world_.reset(rng_);
  wanderer_.begin(rng_);
  deceiver_.begin(rng_);
  shown_ = deceiver_.show(truth_, -1, rng_);
  last_shown_ = shown_;
  last_truth_ = truth_;
}

bool Wandering::step() {
  const Action action = wanderer_.act(truth_, rng_);
  const Outcome<Point> outcome = world_.step(truth_, action);
  if (outcome.terminal || ++steps_ >= horizon_) return false;
  last_truth_ = truth_;
  truth_ = outcome.next;
  last_action_ = action;
  last_shown_ = shown_;
  shown_ = deceiver_.show(truth_, action, rng_);
  return true;
}

}  // namespace maximin::deep
