#include <maximin/deep/lattice_world.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include <maximin/models/make_perturbation.hpp>

namespace maximin::deep {
namespace {

/// The agent as an attack sees it that thinks of any place: asked about one, it is asked about the lattice point that
/// would be shown. It answers, and cannot act.
class Rounding final : public GridAgent {
 public:
  Rounding(const GridAgent& agent, const LatticeWorld& world, std::span<const Lane> lanes,
           std::span<const Point> truths)
      : agent_(&agent), world_(&world) {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const auto l = static_cast<std::size_t>(lanes[k]);
      if (l >= truths_.size()) truths_.resize(l + 1, -1);
      truths_[l] = world.state(truths[k]);
    }
  }

  void resize(Lane) override { only_asked(); }
  void forget(Lane) override { only_asked(); }
  void act(std::span<const Lane>, std::span<const Point>, std::span<Stream>, std::span<Action>) override {
    only_asked();
  }
  void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const override {
    std::vector<Point> rounded;
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      const State truth = truths_.at(static_cast<std::size_t>(lanes[k]));
      rounded.push_back(world_->place(world_->nearest_in_ball(truth, shown[k])));
    }
    agent_->would_do(lanes, rounded, actions);
  }
  Mind mind(Lane lane) const override { return agent_->mind(lane); }

 private:
  [[noreturn]] static void only_asked() { throw std::logic_error("attack: acts in the agent's place"); }

  const GridAgent* agent_;
  const LatticeWorld* world_;
  std::vector<State> truths_;  // by lane; -1 where nothing is shown now
};

}  // namespace

LatticeWorld::LatticeWorld(const GridworldLatticeOptions& options)
    : options_(options),
      model_(gridworld_lattice(options)),
      balls_(make_perturbation(model_)),
      environment_(model_.mdp, model_.start),
      per_axis_(static_cast<int>(std::lround(gridworld::side / options.spacing))) {
  state_at_.assign(static_cast<std::size_t>(per_axis_) * static_cast<std::size_t>(per_axis_), -1);
  const auto& points = model_.geometry.points;
  for (State s = 0; s < mdp().states(); ++s) {
    const Point at{gridworld::round_down(points(s, 0)), gridworld::round_down(points(s, 1))};
    const auto row = static_cast<long>(at.y / options.spacing), column = static_cast<long>(at.x / options.spacing);
    state_at_[static_cast<std::size_t>(row * per_axis_ + column)] = s;
    places_.push_back(at);
    if (!terminal(s)) starts_.push_back(s);
  }
}

Outcome<Point> LatticeWorld::step(Point at, Action action, Stream& rng) const {
  const Outcome<State> outcome = environment_.step(state(at), action, rng);
  return {place(outcome.next), outcome.reward, outcome.terminal};
}

State LatticeWorld::state(Point at) const {
  if (at.x >= 0 && at.y >= 0 && at.x < gridworld::side && at.y < gridworld::side) {
    const auto row = static_cast<long>(at.y / options_.spacing), column = static_cast<long>(at.x / options_.spacing);
    const State s = state_at_[static_cast<std::size_t>(row * per_axis_ + column)];
    if (s >= 0 && place(s) == at) return s;
  }
  throw std::invalid_argument(fmt::format("lattice: ({}, {}), expected a lattice point in no wall", at.x, at.y));
}

State LatticeWorld::nearest_in_ball(State truth, Point wanted) const {
  const auto ball = balls_.ball(truth);
  const auto distance = [&](State s) { return std::hypot(place(s).x - wanted.x, place(s).y - wanted.y); };
  return *std::min_element(ball.begin(), ball.end(), [&](State s, State t) { return distance(s) < distance(t); });
}

void OnLattice::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                        std::span<Stream> streams, std::span<Point> shown) {
  attack().perturb(lanes, truths, Rounding(agent, *world_, lanes, truths), streams, shown);
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    shown[k] = world_->place(world_->nearest_in_ball(world_->state(truths[k]), shown[k]));
  }
}

void WithinLatticeBall::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                                std::span<Stream> streams, std::span<Point> shown) {
  attack().perturb(lanes, truths, agent, streams, shown);
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto ball = world_->balls().ball(world_->state(truths[k]));
    const bool inside = std::any_of(ball.begin(), ball.end(), [&](State t) { return world_->place(t) == shown[k]; });
    if (inside) continue;
    throw std::logic_error(
        fmt::format("attack: showed ({}, {}) when ({}, {}) was true, which is no lattice point of its "
                    "ball",
                    shown[k].x, shown[k].y, truths[k].x, truths[k].y));
  }
}

}  // namespace maximin::deep
