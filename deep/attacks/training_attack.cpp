#include <maximin/deep/attacks/training_attack.hpp>

#include <utility>
#include <vector>

#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/mixed_attack.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

std::shared_ptr<GridAttack> gradient(const std::shared_ptr<ActionValueModule>& q, const ObservationBall& ball,
                                     AttackObjective objective) {
  GradientAttackOptions options;
  options.objective = objective;
  return std::make_shared<GradientAttack>(q, ball, options);
}

}  // namespace

std::shared_ptr<GridAttack> training_attack(const std::string& name, const ObservationBall& ball,
                                            const std::shared_ptr<ActionValueModule>& trained, const QNetwork& judge) {
  if (name == "none") return std::make_shared<NoAttack>();
  if (name == "random") return std::make_shared<RandomAttack>(ball);
  if (name == "pgd") return gradient(trained, ball, AttackObjective::value);
  if (name == "min-best") return gradient(trained, ball, AttackObjective::min_best);
  if (name != "mixed") {
    throw InputError("training attack: " + name + ", expected none, random, pgd, min-best or mixed");
  }
  std::vector<MixedAttack::Part> parts;
  parts.push_back({std::make_shared<NoAttack>(), 0.1});
  parts.push_back({std::make_shared<RandomAttack>(ball), 0.1});
  parts.push_back({std::make_shared<ConstantOffsetAttack>(ball), 0.25});
  parts.push_back({gradient(trained, ball, AttackObjective::value), 0.1});
  parts.push_back({gradient(trained, ball, AttackObjective::min_best), 0.1});
  parts.push_back({std::make_shared<BestResponseAttack>(frozen_copy(judge), ball, BestResponseOptions{2, 2}), 0.35});
  return std::make_shared<MixedAttack>(std::move(parts));
}

}  // namespace maximin::deep
