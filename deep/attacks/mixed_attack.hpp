#pragma once

#include <memory>
#include <span>
#include <vector>

#include <maximin/deep/agent.hpp>

namespace maximin::deep {

/// For each episode one of several attacks, drawn with given probabilities from the lane's stream: what an agent is
/// trained against that should withstand more than one.
class MixedAttack final : public GridAttack {
 public:
  struct Part {
    std::shared_ptr<GridAttack> attack;
    double weight = 1;
  };

  /// Throws std::invalid_argument when there is no part, or a weight is not positive.
  explicit MixedAttack(std::vector<Part> parts);

  void resize(Lane lanes) override;
  void forget(Lane lane) override;
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  int draw(Stream& rng) const;

  std::vector<Part> parts_;
  double total_ = 0;
  std::vector<int> chosen_;  // of each lane; -1 before the first observation
};

}  // namespace maximin::deep
