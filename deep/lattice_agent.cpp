#include <maximin/deep/lattice_agent.hpp>

#include <algorithm>
#include <iterator>
#include <utility>
#include <variant>

#include <torch/torch.h>

#include <maximin/theory/policies.hpp>

namespace maximin::deep {

QTable<double> values_on_lattice(ActionValueModule& q, const LatticeWorld& world) {
  torch::InferenceMode inference;
  std::vector<Point> places;
  for (State s = 0; s < world.mdp().states(); ++s) places.push_back(world.place(s));
  const torch::Tensor values = values_at(q, places).to(torch::kDouble);
  QTable<double> table(values.size(0), values.size(1));
  const auto entry = values.accessor<double, 2>();
  for (long s = 0; s < table.rows(); ++s) {
    for (long a = 0; a < table.cols(); ++a) table(s, a) = entry[s][a];
  }
  return table;
}

LatticeMind deep_mind(QTable<double> q, const AnyAggregator& aggregator, LatticeMemory memory,
                      const LatticeWorld& world) {
  auto decide = [q = std::move(q), aggregator, scratch = std::vector<double>()](std::span<const State> belief) mutable {
    return std::visit([&](const auto& kind) { return belief_action(q, belief, scratch, kind); }, aggregator);
  };
  if (memory == LatticeMemory::observed) return {memory, decide};
  return {memory, [decide, &world](std::span<const State> belief) mutable {
            Belief open;
            std::copy_if(belief.begin(), belief.end(), std::back_inserter(open),
                         [&](State s) { return !world.terminal(s); });
            return open.empty() ? Action(0) : decide(open);
          }};
}

void LatticeAgent::resize(Lane lanes) {
  lanes_.assign(static_cast<std::size_t>(lanes), Memory{});
}

void LatticeAgent::forget(Lane lane) {
  lanes_[static_cast<std::size_t>(lane)] = Memory{};
}

Belief LatticeAgent::would_believe(Lane lane, State shown) const {
  if (mind_.memory == LatticeMemory::observed) return {shown};
  const Memory& memory = lanes_[static_cast<std::size_t>(lane)];
  const auto ball = world_->balls().ball(shown);
  if (mind_.memory == LatticeMemory::ball || memory.belief.empty()) return {ball.begin(), ball.end()};
  Belief predicted, met;
  belief_successors(world_->mdp(), std::span<const State>(memory.belief), memory.last, predicted);
  meet_observation(world_->balls(), predicted, shown, met);
  return met;
}

Mind LatticeAgent::mind(Lane lane) const {
  const Memory& memory = lanes_[static_cast<std::size_t>(lane)];
  if (memory.belief.empty()) return {};
  const Point first = world_->place(memory.belief.front());
  Mind mind{true, memory.last, {}, {first.x, first.x, first.y, first.y}};
  for (const State s : memory.belief) {
    const Point p = world_->place(s);
    const auto share = 1 / static_cast<double>(memory.belief.size());
    mind.mean = {mind.mean.x + share * p.x, mind.mean.y + share * p.y};
    mind.hull = {std::min(mind.hull.x_low, p.x), std::max(mind.hull.x_high, p.x), std::min(mind.hull.y_low, p.y),
                 std::max(mind.hull.y_high, p.y)};
  }
  return mind;
}

void LatticeAgent::act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream>,
                       std::span<Action> actions) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    Belief belief = would_believe(lanes[k], world_->state(shown[k]));
    actions[k] = mind_.policy(belief);
    lanes_[static_cast<std::size_t>(lanes[k])] = {std::move(belief), actions[k]};
  }
}

void LatticeAgent::would_do(std::span<const Lane> lanes, std::span<const Point> shown,
                            std::span<Action> actions) const {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    actions[k] = mind_.policy(would_believe(lanes[k], world_->state(shown[k])));
  }
}

}  // namespace maximin::deep
