#include <maximin/deep/sure_agent.hpp>

#include <limits>
#include <stdexcept>

namespace maximin::deep {

void SureAgent::act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
                    std::span<Action> actions) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const auto l = static_cast<std::size_t>(lanes[k]);
    actions[k] = lanes_[l].act(shown[k], streams[l]);
  }
}

Mind SureAgent::mind(Lane lane) const {
  const HullAgent& in = lanes_[static_cast<std::size_t>(lane)];
  if (!in.started()) return {};
  Mind mind{true, in.last_action(), {}, belief(lane).hull()};
  const double area = belief(lane).area();
  for (const Box& box : belief(lane).boxes()) {
    const double share = box.area() / area;
    mind.mean.x += share * (box.x_low + box.x_high) / 2;
    mind.mean.y += share * (box.y_low + box.y_high) / 2;
  }
  return mind;
}

long SureAgent::empty_intersections() const {
  long sum = 0;
  for (const HullAgent& in : lanes_) sum += in.belief_model().empty_intersections();
  return sum;
}

void SureAgent::would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const BoxUnion belief = lanes_[static_cast<std::size_t>(lanes[k])].would_believe(shown[k]);
    actions[k] = control_->covers(belief) ? control_->choice(belief).action : Action(0);
  }
}

double SureAgent::would_be_sure_of(Lane lane, Point shown) const {
  const BoxUnion belief = lanes_[static_cast<std::size_t>(lane)].would_believe(shown);
  return control_->covers(belief) ? control_->choice(belief).value : -std::numeric_limits<double>::infinity();
}

void LeastSureAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                              std::span<Stream> streams, std::span<Point> shown) {
  const auto* sure = dynamic_cast<const SureAgent*>(&agent);
  if (!sure) throw std::invalid_argument("least sure: expected an agent that is sure of its return");
  std::vector<Point> candidates;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    const Point truth = truths[k];
    candidates.clear();
    for (const double x : {ball_.low(truth.x), truth.x, ball_.high(truth.x)}) {
      for (const double y : {ball_.low(truth.y), truth.y, ball_.high(truth.y)}) candidates.push_back({x, y});
    }
    for (int i = 0; i < random_; ++i)
      candidates.push_back(ball_.draw(truth, streams[static_cast<std::size_t>(lanes[k])]));
    double least = std::numeric_limits<double>::infinity();
    for (const Point& c : candidates) {
      const double value = sure->would_be_sure_of(lanes[k], c);
      if (value >= least) continue;
      least = value;
      shown[k] = c;
    }
  }
}

}  // namespace maximin::deep
