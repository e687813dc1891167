#include <maximin/deep/sure_agent.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include <maximin/deep/attacks/adaptive_director.hpp>
#include <maximin/deep/attacks/best_response_attack.hpp>
#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/offset_attack.hpp>
#include <maximin/deep/attacks/pa_ad_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/evaluation.hpp>
#include <maximin/theory/rollout_in_step.hpp>

namespace maximin::deep {
namespace {

/// What episodes came to, beside what was sure of them.
struct Kept {
  int broken = 0;              ///< episodes worth less than was sure from their start
  double slackest = INFINITY;  ///< least of return less what was sure
};

/// Plays 100 steps each; every episode's start is taken from its first record.
Kept play(const HullControl& control, GridAgent& agent, GridAttack& attack, long episodes,
          const ObservationBall& ball) {
  ContinuousGridworld world;
  WithinBallInStep bounded(attack, ball);
  std::vector<double> sure(static_cast<std::size_t>(episodes));
  EpisodesInStep options;
  options.episodes = episodes;
  options.seed = 11;
  const auto played = rollout_in_step(world, agent, bounded, options, [&](long k, const auto& record) {
    if (record.time == 0) sure[static_cast<std::size_t>(k)] = control.sure_from(record.truth);
  });
  Kept kept;
  for (std::size_t k = 0; k < played.size(); ++k) {
    const double slack = played[k].total_reward - sure[k];
    kept.broken += slack < 0;
    kept.slackest = std::min(kept.slackest, slack);
  }
  return kept;
}

std::vector<std::shared_ptr<GridAttack>> attacks(const ObservationBall& ball) {
  Stream rng(1);
  const auto network = std::make_shared<QNetwork>(QNetworkShape{}, rng);
  return {std::make_shared<NoAttack>(),
          std::make_shared<RandomAttack>(ball),
          std::make_shared<ConstantOffsetAttack>(ball),
          std::make_shared<GradientAttack>(network, ball, GradientAttackOptions{}),
          std::make_shared<BestResponseAttack>(network, ball, BestResponseOptions{}),
          std::make_shared<AdaptiveDirector>(network, ball),
          std::make_shared<PaAdAttack>(network, ball),
          std::make_shared<LeastSureAttack>(ball)};
}

TEST(SureAgent, KeepsItsPromiseInEveryEpisodeWhoeverAttacks) {
  for (const auto& [eps, squares] : {std::pair(0.1, 2), std::pair(0.5, 2)}) {
    const ObservationBall ball(eps);
    const HullControl control(ball, squares);
    double slackest = INFINITY;
    for (const auto& attack : attacks(ball)) {
      SureAgent agent(control);
      const Kept kept = play(control, agent, *attack, 256, ball);
      EXPECT_EQ(kept.broken, 0) << "eps " << eps;
      slackest = std::min(slackest, kept.slackest);
    }
    EXPECT_LT(slackest, 100) << "a promise that nobody comes near is no check";
  }
}

/// Negative controls: an agent who forgets what it saw, and one who prepares for less than what comes.
class Forgetful final : public GridAgent {
 public:
  explicit Forgetful(const HullControl& control) : agent_(control) {}
  void resize(Lane lanes) override { agent_.resize(lanes); }
  void forget(Lane lane) override { agent_.forget(lane); }
  void act(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) override {
    for (const Lane l : lanes) agent_.forget(l);
    agent_.act(lanes, shown, streams, actions);
  }
  void would_do(std::span<const Lane> lanes, std::span<const Point> shown, std::span<Action> actions) const override {
    agent_.would_do(lanes, shown, actions);
  }

 private:
  SureAgent agent_;
};

TEST(SureAgent, APromiseThatIsBrokenIsFound) {
  const ObservationBall ball(0.5), small(0.1);
  const HullControl control(ball, 2), unprepared(small, 2);
  ConstantOffsetAttack attack(ball);
  Forgetful forgetful(control);
  EXPECT_GT(play(control, forgetful, attack, 256, ball).broken, 0);
  SureAgent agent(unprepared);
  EXPECT_GT(play(unprepared, agent, attack, 256, ball).broken, 0);
}

TEST(SureAgent, SaysWhatItWouldDo) {
  const ObservationBall ball(0.5);
  const HullControl control(ball, 1);
  SureAgent agent(control), same(control);
  RandomAttack attack(ball);
  ContinuousGridworld world;
  Stream rng(2);
  std::vector<Stream> streams(2, rng);
  const std::vector<Lane> lanes{0, 1}, asked{1, 0, 1};
  std::vector<Point> truths{world.reset(rng), world.reset(rng)}, shown(2);
  std::vector<Action> actions(2), would(3), again(2);
  agent.resize(2);
  same.resize(2);
  for (int t = 0; t < 12; ++t) {
    attack.perturb(lanes, truths, agent, streams, shown);
    agent.would_do(asked, std::vector<Point>{shown[1], shown[0], shown[1]}, would);
    agent.act(lanes, shown, streams, actions);
    same.act(lanes, shown, streams, again);
    EXPECT_EQ(would, (std::vector<Action>{actions[1], actions[0], actions[1]})) << t;
    EXPECT_EQ(actions, again) << "asking changes nothing";
    for (std::size_t k = 0; k < 2; ++k) truths[k] = world.step(truths[k], actions[k]).next;
  }
  NoAttack none;
  LeastSureAttack least(ball);
  Forgetful other(control);
  EXPECT_THROW(least.perturb(lanes, truths, other, streams, shown), std::invalid_argument);
}

TEST(SureAgent, IsEvaluatedAndDrawnAsAnyAgent) {
  const ObservationBall ball(0.5), smaller(0.1);
  const HullControl control(ball, 2), unprepared(smaller, 2);
  RandomAttack attack(ball);
  SureAgent agent(control);
  const AgentEvaluation evaluation = evaluate_agent(agent, attack, ball, 64, 5);
  EXPECT_EQ(evaluation.truth_in_belief, 1);
  EXPECT_GT(evaluation.belief_size, 0);
  EXPECT_EQ(evaluation.empty_intersections, 0);
  const EpisodeTrace trace = trace_episode(agent, attack, ball, 5, 1);
  ASSERT_FALSE(trace.steps.empty());
  for (const TraceStep& step : trace.steps) {
    EXPECT_TRUE(std::any_of(step.belief.boxes.begin(), step.belief.boxes.end(),
                            [&](const Box& box) { return box.contains(step.truth); }));
  }
  SureAgent deceived(unprepared);
  const AgentEvaluation wrong = evaluate_agent(deceived, attack, ball, 64, 5);
  EXPECT_LT(wrong.truth_in_belief, 1);
  EXPECT_GT(wrong.empty_intersections, 0);
}

}  // namespace
}  // namespace maximin::deep
