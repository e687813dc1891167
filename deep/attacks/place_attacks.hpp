#pragma once

#include <memory>
#include <span>

#include <maximin/deep/agent.hpp>
#include <maximin/deep/places.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/theory/perturbation.hpp>

/// The attacks of the tabular layer, on agents that see places. Perturbation and places must outlive them.
namespace maximin::deep {

/// A stationary omega, e.g. the optimal attack on a fixed policy: shows the place of attack[s] when s is true.
class FixedPlaceAttack final : public GridAttack {
 public:
  /// Throws std::logic_error when attack[s] is not in B(s), so that a broken attack can never be reported as a strong
  /// one; InputError when it is not of the perturbation's size.
  FixedPlaceAttack(AttackPolicy attack, const Perturbation<double>& perturbation, const Places& places);
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  AttackPolicy attack_;
  const Places* places_;
};

/// The best response to the agent's next action, judged by action values (paper, Algorithm 1 line 6): shows
/// argmin_{t in B(s)} Q_judge(s, what the agent would do on seeing t), the first t among equals. The judge may be the
/// network that is being trained.
class PlaceBestResponse final : public GridAttack {
 public:
  PlaceBestResponse(std::shared_ptr<ActionValueModule> judge, const Perturbation<double>& perturbation,
                    const Places& places);
  void perturb(std::span<const Lane> lanes, std::span<const Point> truths, const GridAgent& agent,
               std::span<Stream> streams, std::span<Point> shown) override;

 private:
  std::shared_ptr<ActionValueModule> judge_;
  const Perturbation<double>* perturbation_;
  const Places* places_;
};

}  // namespace maximin::deep
