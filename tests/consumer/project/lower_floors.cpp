#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <utility>

// Two states, two actions, balls of both states: the policy pairs cycle with period 3 and never settle.
long period_of_the_cycle() {
  maximin::FiniteMdpBuilder<double> builder(2, 2, 0.9);
  builder.reward(0, 1, 2).reward(1, 0, 3);
  builder.transition(0, 0, 0, 1).transition(0, 1, 0, 1).transition(1, 0, 0, 1).transition(1, 1, 1, 1);
  const maximin::Perturbation<double> perturbation(maximin::Metric<double>::discrete(2), 1.0);
  return maximin::pessimistic_q_iteration(std::move(builder).build(), perturbation).period;
}
