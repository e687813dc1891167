#include <maximin/deep/belief_agent.hpp>

#include <utility>

namespace maximin::deep {
namespace {

void write_greedy(const torch::Tensor& values, std::span<Action> actions) {
  const torch::Tensor best = values.argmax(1).to(torch::kCPU);
  const long* in = best.data_ptr<long>();
  for (Action& a : actions) a = static_cast<Action>(*in++);
}

}  // namespace

BeliefAgent::BeliefAgent(std::shared_ptr<ActionValueModule> q, std::shared_ptr<LaneBelief> belief,
                         AnyAggregator aggregator, double random_actions)
    : q_(std::move(q)),
      belief_(std::move(belief)),
      aggregator_(std::move(aggregator)),
      random_actions_(random_actions) {}

void BeliefAgent::resize(Lane lanes) {
  belief_->resize(lanes);
  last_.assign(static_cast<std::size_t>(lanes), 0);
}

void BeliefAgent::forget(Lane lane) {
  belief_->forget(lane);
  last_[static_cast<std::size_t>(lane)] = 0;
}

torch::Tensor BeliefAgent::values(const BeliefStates& belief) const {
  torch::InferenceMode inference;
  const torch::Device device = q_->parameters().front().device();
  const torch::Tensor states = belief.states.to(device);
  const torch::Tensor q = q_->forward(states.flatten(0, 1)).view({states.size(0), states.size(1), -1});
  return aggregate(aggregator_, q, belief.weights.to(device));
}

std::vector<Action> BeliefAgent::last_of(std::span<const Lane> lanes) const {
  std::vector<Action> last;
  last.reserve(lanes.size());
  for (const Lane l : lanes) last.push_back(last_[static_cast<std::size_t>(l)]);
  return last;
}

void BeliefAgent::act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
                      std::span<Action> actions) {
  acted_on_ = belief_->update(lanes, last_of(lanes), shown);
  const torch::Tensor q = values(acted_on_);
  write_greedy(q, actions);
  const int choices = static_cast<int>(q.size(1));
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    if (random_actions_ > 0 && streams[l].chance(random_actions_)) actions[k] = streams[l].below(choices);
    last_[l] = actions[k];
  }
}

torch::Tensor BeliefAgent::would_value(std::span<const Lane> lanes, std::span<const Point> shown) const {
  return values(belief_->peek(lanes, last_of(lanes), shown));
}

void BeliefAgent::would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const {
  write_greedy(would_value(lanes, shown), actions);
}

}  // namespace maximin::deep
