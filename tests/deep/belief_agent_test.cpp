#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <maximin/deep/attacks/gradient_attack.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/belief_agent.hpp>
#include <maximin/deep/losses/wocar_loss.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/rollout_in_step.hpp>

#include "tiny_networks.hpp"

namespace maximin::deep::belief_agent_test {  // of its own: built as one unit with its neighbours
namespace {

constexpr Lane lanes = 6;
const ObservationBall ball(0.5);

QNetworkPtr wild_network() {
  Stream rng(21);
  QNetworkShape shape;
  shape.hidden = {32, 32};
  shape.waves = 2;
  return random_network(shape, rng, torch::kFloat, 3);
}

std::shared_ptr<LaneBelief> belief_named(const std::string& name) {
  if (name == "observed") return std::make_shared<ObservedState>();
  return std::make_shared<SetBeliefs>(name == "ball" ? SetBelief::ball : SetBelief::exact, ball, 9);
}

/// Plays with the agent and asks it before each step what it will do, for every lane twice. Returns how often it then
/// did something else. `after`: asks after the step instead, when its memory has moved on.
int broken_promises(BeliefAgent& agent, bool after = false) {
  ContinuousGridworld world;
  std::vector<Stream> streams;
  std::vector<Point> truths, shown(lanes);
  std::vector<Lane> every, twice;
  for (Lane l = 0; l < lanes; ++l) {
    streams.emplace_back(3, static_cast<std::uint64_t>(l));
    truths.push_back(world.reset(streams.back()));
    every.push_back(l);
    twice.insert(twice.begin(), {l, l});
  }
  agent.resize(lanes);
  int broken = 0;
  for (int step = 0; step < 120; ++step) {
    std::vector<Point> candidates;
    for (std::size_t i = 0; i < lanes; ++i) shown[i] = ball.draw(truths[i], streams[i]);
    for (const Lane l : twice) candidates.push_back(shown[static_cast<std::size_t>(l)]);
    std::vector<Action> promised(twice.size()), done(lanes);
    if (!after) agent.would_do(twice, candidates, promised);
    agent.act(every, shown, streams, done);
    if (after) agent.would_do(twice, candidates, promised);
    for (std::size_t k = 0; k < twice.size(); ++k) broken += promised[k] != done[static_cast<std::size_t>(twice[k])];
    for (std::size_t i = 0; i < lanes; ++i) {
      EXPECT_EQ(agent.last_action(every[i]), done[i]);
      const Outcome<Point> outcome = world.step(truths[i], done[i]);
      truths[i] = outcome.terminal ? world.reset(streams[i]) : outcome.next;
      if (outcome.terminal) agent.forget(every[i]);
    }
  }
  return broken;
}

TEST(BeliefAgent, DoesWhatItSaysItWouldDo) {
  const QNetworkPtr q = wild_network();
  for (const char* belief : {"observed", "ball", "exact"}) {
    for (const char* aggregator : {"min", "mean", "cvar:0.25"}) {
      BeliefAgent agent(q, belief_named(belief), aggregator_named(aggregator));
      EXPECT_EQ(broken_promises(agent), 0) << belief << ' ' << aggregator;
    }
  }
  BeliefAgent remembers(q, belief_named("exact"), MinAggregator{}),
      erratic(q, belief_named("ball"), MinAggregator{}, 0.5);
  EXPECT_GT(broken_promises(remembers, true), 0);
  EXPECT_GT(broken_promises(erratic), 0);
}

/// An agent of one lane for each lane.
class OneByOne {
 public:
  using ObservationType = Point;
  using ActionType = Action;
  OneByOne(const QNetworkPtr& q, const std::string& belief) {
    for (Lane l = 0; l < lanes; ++l)
      agents_.push_back(std::make_unique<BeliefAgent>(q, belief_named(belief), MinAggregator{}));
  }
  void resize(Lane) {
    for (const auto& agent : agents_) agent->resize(1);
  }
  void forget(Lane lane) { agents_[static_cast<std::size_t>(lane)]->forget(0); }
  void act(std::span<const Lane> some, std::span<const Point> shown, std::span<Stream> streams,
           std::span<Action> actions) {
    for (std::size_t k = 0; k < some.size(); ++k) {
      const auto l = static_cast<std::size_t>(some[k]);
      agents_[l]->act(std::vector<Lane>{0}, shown.subspan(k, 1), streams.subspan(l, 1), actions.subspan(k, 1));
    }
  }

 private:
  std::vector<std::unique_ptr<BeliefAgent>> agents_;
};

/// Shows a random place of the ball, whoever acts.
struct Anywhere {
  void resize(Lane) {}
  void forget(Lane) {}
  template <class AgentT>
  void perturb(std::span<const Lane> some, std::span<const Point> truths, const AgentT&, std::span<Stream> streams,
               std::span<Point> shown) {
    for (std::size_t k = 0; k < some.size(); ++k)
      shown[k] = ball.draw(truths[k], streams[static_cast<std::size_t>(some[k])]);
  }
};

template <class AgentT>
std::vector<double> returns(AgentT& agent) {
  ContinuousGridworld world;
  Anywhere attack;
  EpisodesInStep options;
  options.lanes = lanes;
  options.episodes = 14;  // more than lanes: they begin anew at different times
  options.horizon = 60;
  std::vector<double> out;
  rollout_in_step(world, agent, attack, options, [&](long k, const StepRecord<Point, Point, Action>& record) {
    out.push_back(static_cast<double>(k) + record.action);
    out.push_back(record.next.x);
  });
  std::sort(out.begin(), out.end());
  return out;
}

TEST(BeliefAgent, LanesTogetherActAsEachAlone) {
  const QNetworkPtr q = wild_network();
  for (const char* belief : {"observed", "ball", "exact"}) {
    BeliefAgent together(q, belief_named(belief), MinAggregator{});
    OneByOne apart(q, belief);
    EXPECT_EQ(returns(together), returns(apart)) << belief;
    if (std::string(belief) == "observed") continue;
    BeliefAgent other(q, belief_named(belief), MeanAggregator{});
    EXPECT_NE(returns(other), returns(apart)) << belief;
  }
}

TEST(BeliefAgent, ChoosesByTheAggregateAndNowAndThenAtRandom) {
  const QNetworkPtr q = wild_network();
  const std::vector<Lane> one{0};
  std::vector<Stream> streams{Stream(1)};
  std::vector<Action> action(1);
  BeliefAgent pessimist(q, belief_named("ball"), MinAggregator{});
  pessimist.resize(1);
  int different = 0;
  for (int i = 0; i < 50; ++i) {
    const std::vector<Point> shown{ball.draw({4.5, 5.5}, streams[0])};
    const torch::Tensor values = pessimist.would_value(one, shown);
    Stream before = streams[0];
    pessimist.act(one, shown, streams, action);
    ASSERT_EQ(before(), Stream(streams[0])());  // no number of the stream was taken
    torch::NoGradGuard no_grad;
    const torch::Tensor all = q->forward(pessimist.acted_on().states[0]);
    ASSERT_TRUE(torch::allclose(values[0], all.amin(0), 0, 1e-5));
    ASSERT_EQ(action[0], all.amin(0).argmax().item<long>());
    different += action[0] != all.mean(0).argmax().item<long>();
    pessimist.forget(0);
  }
  EXPECT_GT(different, 0);  // from the greedy action of the mean

  // Always at random: all actions alike. One time in four: seven eighths of a quarter differ from the greedy one.
  BeliefAgent drunk(q, belief_named("observed"), MinAggregator{}, 1),
      tipsy(q, belief_named("observed"), MinAggregator{}, 0.25);
  drunk.resize(1);
  tipsy.resize(1);
  const std::vector<Point> same{{4.5, 4.5}};
  std::array<double, 8> counts{};
  double strayed = 0;
  std::vector<Action> greedy(1);
  tipsy.would_do(one, same, greedy);
  for (int i = 0; i < 4000; ++i) {
    drunk.act(one, same, streams, action);
    ++counts.at(static_cast<std::size_t>(action[0]));
    tipsy.act(one, same, streams, action);
    strayed += action[0] != greedy[0];
  }
  double chi_square = 0;
  for (const double c : counts) chi_square += (c - 500) * (c - 500) / 500;
  EXPECT_LT(chi_square, 24.3);  // 7 degrees of freedom, 1 in 1,000
  EXPECT_NEAR(strayed / 4000, 0.25 * 7 / 8, 0.025);
}

TEST(BeliefAgent, ActsByTheMixedValuesOfAWorstCaseAwareAgent) {
  Stream rng(8);
  QNetworkShape shape;
  WocarLossOptions options;
  options.worst_share = 1;
  WocarLoss loss(options, shape, rng);
  const QNetworkPtr q = std::make_shared<QNetwork>(shape, rng);
  const auto values = loss.acting(q);
  BeliefAgent agent(values, belief_named("observed"), MinAggregator{});
  agent.resize(1);
  const std::vector<Point> shown{{4.5, 5.5}};
  const torch::Tensor got = agent.would_value(std::vector<Lane>{0}, shown);
  EXPECT_TRUE(torch::allclose(got, loss.critic().forward(to_tensor(shown))));
  EXPECT_FALSE(torch::allclose(got, q->forward(to_tensor(shown))));
  // Attacks on it find their way too.
  GradientAttack attack(values, ball, {});
  std::vector<Stream> streams{Stream(1)};
  std::vector<Point> out(1);
  attack.perturb(std::vector<Lane>{0}, shown, agent, streams, out);
  EXPECT_TRUE(ball.contains(shown[0], out[0]));
}

}  // namespace
}  // namespace maximin::deep::belief_agent_test
