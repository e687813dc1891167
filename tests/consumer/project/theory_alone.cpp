// The smallest program that links Maximin: a model of two states, its balls, and one pessimistic update.
#include <cstdio>
#include <maximin/theory/bellman.hpp>
#include <utility>

int main() {
  maximin::FiniteMdpBuilder<double> builder(2, 1, 0.5);
  builder.reward(0, 0, 1.0).transition(0, 0, 1, 1.0).transition(1, 0, 1, 1.0);
  const maximin::FiniteMdp<double> mdp = std::move(builder).build();
  const maximin::Perturbation<double> perturbation(maximin::Metric<double>::discrete(2), 1.0);

  maximin::QTable<double> q = maximin::QTable<double>::Zero(2, 1), next;
  maximin::PessimisticStep<double> step;
  maximin::pessimistic_update(mdp, perturbation, q, step, next);
  std::printf("Q_1(0,0) = %g\n", next(0, 0));
  return next(0, 0) == 1.0 && next(1, 0) == 0.0 ? 0 : 1;
}
