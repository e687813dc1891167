#include <maximin/deep/attacks/named_attack.hpp>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

std::shared_ptr<GridAttack> gradient(const AttackSetting& setting, const AttackTarget& target,
                                     AttackObjective objective) {
  GradientAttackOptions options;
  options.objective = objective;
  return std::make_shared<GradientAttack>(target.agent->values(), ObservationBall(setting.eps), options);
}

}  // namespace

const std::vector<NamedAttack>& named_attacks() {
  static const std::vector<NamedAttack> attacks{
      {"none", "natural", false, false},
      {"random", "random", false, false},
      {"constant-offset", "constant offset", false, false},
      {"pgd", "PGD", false, false},
      {"pgd-released", "PGD, cross-entropy", false, false},
      {"min-best", "MinBest", false, false},
      {"best-response", "best response", true, false},
  };
  return attacks;
}

const NamedAttack& attack_named(const std::string& name) {
  std::vector<std::string> names;
  for (const NamedAttack& attack : named_attacks()) {
    if (attack.name == name) return attack;
    names.push_back(attack.name);
  }
  const std::string nearest = nearest_name(name, names);
  throw InputError(fmt::format("attack: {}, expected {}", name,
                               nearest.empty() ? fmt::format("{}", fmt::join(names, ", ")) : nearest));
}

std::shared_ptr<GridAttack> make_attack(const AttackSetting& setting, const AttackTarget& target) {
  const std::string& name = attack_named(setting.name).name;
  const ObservationBall ball(setting.eps);
  if (name == "none") return std::make_shared<NoAttack>();
  if (name == "random") return std::make_shared<RandomAttack>(ball);
  if (name == "constant-offset") return std::make_shared<ConstantOffsetAttack>(ball);
  if (name == "pgd") return gradient(setting, target, AttackObjective::value);
  if (name == "pgd-released") return gradient(setting, target, AttackObjective::cross_entropy);
  if (name == "min-best") return gradient(setting, target, AttackObjective::min_best);
  return std::make_shared<BestResponseAttack>(target.judge, ball, BestResponseOptions{});
}

}  // namespace maximin::deep
