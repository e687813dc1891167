// An attack of one's own on an agent, trained (its file as argument) or not: shows every state as
// the lower right corner of its ball.
#include <algorithm>
#include <cstdio>
#include <maximin/deep/evaluation.hpp>
#include <maximin/deep/runtime.hpp>
#include <maximin/deep/trained_agent.hpp>
#include <numeric>

namespace deep = maximin::deep;

class Corner final : public deep::GridAttack {
 public:
  explicit Corner(const maximin::ObservationBall& ball) : ball_(ball) {}
  void perturb(std::span<const maximin::Lane> lanes, std::span<const maximin::Point> truths, const deep::GridAgent&,
               std::span<maximin::Stream>, std::span<maximin::Point> shown) override {
    for (std::size_t k = 0; k < lanes.size(); ++k) {
      shown[k] = ball_.project(truths[k], {truths[k].x + ball_.eps(), truths[k].y - ball_.eps()});
    }
  }

 private:
  maximin::ObservationBall ball_;
};

int main(int argc, char** argv) {
  deep::prepare_runtime();
  const deep::TrainedAgent trained =
      argc > 1 ? deep::read_agent(argv[1]) : deep::untrained(deep::recipe("bp-dqn", 0.5, 1));
  const auto agent = deep::make_agent(trained, deep::acting_of(trained.spec));
  const maximin::ObservationBall ball(0.5);
  Corner attack(ball);
  const deep::AgentEvaluation e = deep::evaluate_agent(*agent, attack, ball, 20, 1000);
  const double sum = std::accumulate(e.returns.begin(), e.returns.end(), 0.0);
  std::printf("mean return %.1f, truth in belief %.0f %%\n", sum / 20, 100 * e.truth_in_belief);
  return e.returns.size() == 20 && e.truth_in_belief == 1 ? 0 : 1;
}
