#pragma once

#include <memory>
#include <span>

#include <maximin/deep/attacks/director.hpp>
#include <maximin/deep/attacks/targeted_search.hpp>

namespace maximin::deep {

struct PaAdOptions {
  DirectorOptions director;
  TargetedSearchOptions actor;
};

/// PA-AD (Sun, Zheng, Liang and Huang 2022) in the form that is strongest against deterministic policies: a director
/// that sees the true state, and nothing of the defence, chooses the action to provoke; the actor looks for an
/// observation at which the network, by itself, takes it. It is non-adaptive when trained against the agent that acts
/// on what it is shown (ObservedState), adaptive when trained against the whole agent.
class PaAdAttack final : public Director {
 public:
  PaAdAttack(std::shared_ptr<ActionValueModule> q, const ObservationBall& ball, const PaAdOptions& options = {});

  Situations look(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent) const override;
  nlohmann::ordered_json about() const override;

 private:
  void realise(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> choices,
               std::span<Stream> streams, std::span<Point> shown) override;

  TargetedSearch actor_;
};

}  // namespace maximin::deep
