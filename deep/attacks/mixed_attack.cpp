#include <maximin/deep/attacks/mixed_attack.hpp>

#include <cmath>
#include <stdexcept>
#include <utility>

namespace maximin::deep {

MixedAttack::MixedAttack(std::vector<Part> parts) : parts_(std::move(parts)) {
  for (const Part& p : parts_) {
    if (!(p.weight > 0 && std::isfinite(p.weight))) throw std::invalid_argument("mixed attack: a weight not positive");
    total_ += p.weight;
  }
  if (parts_.empty()) throw std::invalid_argument("mixed attack: no parts");
}

void MixedAttack::resize(Lane lanes) {
  for (const Part& p : parts_) p.attack->resize(lanes);
  chosen_.assign(static_cast<std::size_t>(lanes), -1);
}

void MixedAttack::forget(Lane lane) {
  for (const Part& p : parts_) p.attack->forget(lane);
  chosen_[static_cast<std::size_t>(lane)] = -1;
}

int MixedAttack::draw(Stream& rng) const {
  double left = rng.uniform() * total_;
  int part = 0;
  while (part + 1 < static_cast<int>(parts_.size()) && left >= parts_[static_cast<std::size_t>(part)].weight) {
    left -= parts_[static_cast<std::size_t>(part++)].weight;
  }
  return part;
}

void MixedAttack::perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
                          std::span<Stream> streams, std::span<Point> shown) {
  for (const Lane lane : lanes) {
    int& chosen = chosen_[static_cast<std::size_t>(lane)];
    if (chosen < 0) chosen = draw(streams[static_cast<std::size_t>(lane)]);
  }
  std::vector<Lane> some_lanes;
  std::vector<Point> some_truths, some_shown;
  std::vector<std::size_t> where;
  for (int part = 0; part < static_cast<int>(parts_.size()); ++part) {
    some_lanes.clear();
    some_truths.clear();
    where.clear();
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      if (chosen_[static_cast<std::size_t>(lanes[k])] != part) continue;
      some_lanes.push_back(lanes[k]);
      some_truths.push_back(truths[k]);
      where.push_back(k);
    }
    if (where.empty()) continue;
    some_shown.resize(where.size());
    parts_[static_cast<std::size_t>(part)].attack->perturb(some_lanes, some_truths, agent, streams, some_shown);
    for (std::size_t i = 0; i < where.size(); ++i) shown[where[i]] = some_shown[i];
  }
}

}  // namespace maximin::deep
