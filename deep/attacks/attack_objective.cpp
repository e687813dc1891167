#include <maximin/deep/attacks/attack_objective.hpp>

namespace maximin::deep {

torch::Tensor smooth_objective(AttackObjective objective, const torch::Tensor& q_shown, const AttackedStates& truths) {
  switch (objective) {
    case AttackObjective::value:
      return (torch::softmax(q_shown, 1) * truths.q).sum(1);
    case AttackObjective::min_best:
      return torch::softmax(q_shown, 1).gather(1, truths.best).squeeze(1);
    case AttackObjective::cross_entropy:
      break;
  }
  return torch::log_softmax(q_shown, 1).gather(1, truths.best).squeeze(1);
}

torch::Tensor hard_objective(AttackObjective objective, const torch::Tensor& q_shown, const AttackedStates& truths) {
  if (objective != AttackObjective::value) return smooth_objective(objective, q_shown, truths);
  return truths.q.gather(1, q_shown.argmax(1, true)).squeeze(1);
}

}  // namespace maximin::deep
