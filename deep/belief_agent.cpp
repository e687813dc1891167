#include <maximin/deep/belief_agent.hpp>

#include <utility>

#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensors.hpp>

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
  minds_.assign(static_cast<std::size_t>(lanes), {});
}

void BeliefAgent::forget(Lane lane) {
  belief_->forget(lane);
  minds_[static_cast<std::size_t>(lane)] = {};
}

torch::Tensor BeliefAgent::values(const BeliefStates& belief) const {
  torch::InferenceMode inference;
  const torch::Device device = device_of(*q_);
  const torch::Tensor states = belief.states.to(device);
  const torch::Tensor q = q_->forward(states.flatten(0, 1)).view({states.size(0), states.size(1), -1});
  return aggregate(aggregator_, q, belief.weights.to(device, q.scalar_type()));
}

std::vector<Action> BeliefAgent::last_of(std::span<const Lane> lanes) const {
  std::vector<Action> last;
  last.reserve(lanes.size());
  for (const Lane l : lanes) last.push_back(last_action(l));
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
  }
  remember(lanes, actions);
}

void BeliefAgent::remember(std::span<const Lane> lanes, std::span<const Action> actions) {
  const torch::Tensor& held = acted_on_.states;
  const bool places = held.dim() == 3 && held.size(2) == 2;
  torch::Tensor mean, low, high;
  if (places) {
    mean = torch::bmm(acted_on_.weights.unsqueeze(1), held).squeeze(1);
    low = held.amin(1);
    high = held.amax(1);
  }
  const std::vector<Point> means = places ? to_points(mean) : std::vector<Point>(lanes.size());
  const std::vector<Point> lows = places ? to_points(low) : means, highs = places ? to_points(high) : means;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    minds_[static_cast<std::size_t>(lanes[k])] = {
        true, actions[k], means[k], {lows[k].x, highs[k].x, lows[k].y, highs[k].y}};
  }
}

TraceBelief BeliefAgent::picture(Lane lane) const {
  TraceBelief out;
  if (const auto* sets = dynamic_cast<const SetBeliefs*>(belief_.get())) {
    out.boxes = sets->set(lane).boxes();
    return out;
  }
  const torch::Tensor places = acted_on_.states[0].contiguous(), weights = acted_on_.weights[0].contiguous();
  for (long k = 0; k < places.size(0); ++k) {
    out.points.push_back({places[k][0].item<double>(), places[k][1].item<double>()});
    out.weights.push_back(weights[k].item<double>());
  }
  return out;
}

torch::Tensor BeliefAgent::would_value(std::span<const Lane> lanes, std::span<const Point> shown) const {
  return values(belief_->peek(lanes, last_of(lanes), shown));
}

void BeliefAgent::would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const {
  write_greedy(would_value(lanes, shown), actions);
}

}  // namespace maximin::deep
