#include <maximin/deep/attacks/training_attack.hpp>

#include <string_view>
#include <utility>
#include <vector>

#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/mixed_attack.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>

namespace maximin::deep {
namespace {

std::shared_ptr<GridAttack> unchecked(const std::string& name, const ObservationBall& ball,
                                      const std::shared_ptr<ActionValueModule>& trained, const QNetwork& judge) {
  if (name == "none") return std::make_shared<NoAttack>();
  if (name == "random") return std::make_shared<RandomAttack>(ball);
  const auto gradient = [&](std::string_view which) {
    return std::make_shared<GradientAttack>(trained, ball, gradient_attack_named(which));
  };
  if (name != "mixed") return gradient(name);
  std::vector<MixedAttack::Part> parts;
  parts.push_back({std::make_shared<NoAttack>(), 0.1});
  parts.push_back({std::make_shared<RandomAttack>(ball), 0.1});
  parts.push_back({std::make_shared<ConstantOffsetAttack>(ball), 0.25});
  parts.push_back({gradient("pgd"), 0.1});
  parts.push_back({gradient("min-best"), 0.1});
  parts.push_back({std::make_shared<BestResponseAttack>(frozen_copy(judge), ball, BestResponseOptions{2, 2}), 0.35});
  return std::make_shared<MixedAttack>(std::move(parts));
}

}  // namespace

std::shared_ptr<GridAttack> training_attack(const std::string& name, const ObservationBall& ball,
                                            const std::shared_ptr<ActionValueModule>& trained, const QNetwork& judge) {
  return std::make_shared<WithinBallInStep>(unchecked(name, ball, trained, judge), ball);
}

}  // namespace maximin::deep
