#include <maximin/theory/rollout.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace maximin {
namespace {

/// Counts down from `start`; a step pays the state it leaves times the action; 0 is the end.
struct Countdown {
  using StateType = int;
  using ActionType = int;
  int start = 3;
  bool random_start = false;

  int reset(Stream& rng) const { return random_start ? rng.integer(1, start) : start; }
  Outcome<int> step(int s, int a, Stream&) const { return {s - 1, static_cast<double>(s * a), s == 1}; }
};

/// Does what it sees, and remembers it.
struct Parrot {
  using ObservationType = int;
  using ActionType = int;
  std::vector<std::string> calls;
  std::vector<int> seen;

  int begin(int o, Stream&) {
    calls.push_back("begin");
    seen.push_back(o);
    return o;
  }
  int act(int o, Stream&) {
    calls.push_back("act");
    seen.push_back(o);
    return o;
  }
  void forget() { calls.push_back("forget"); }
};

/// Shows one more than the truth, and what it knows of the agent.
struct PlusOne {
  std::vector<std::size_t> agent_had_seen;
  int forgotten = 0;

  int perturb(int truth, const Parrot& agent, Stream&) {
    agent_had_seen.push_back(agent.seen.size());
    return truth + 1;
  }
  void forget() { ++forgotten; }
};

static_assert(Environment<Countdown>);
static_assert(Agent<Parrot>);
static_assert(Attack<PlusOne, int, Parrot>);
static_assert(!Environment<Parrot>);
static_assert(!Agent<Countdown>);
static_assert(!Attack<Countdown, int, Parrot>);

TEST(Rollout, PerturbsWhatIsSeenNotWhereItIs) {
  Countdown env;
  Parrot agent;
  PlusOne attack;
  Stream rng(1);
  std::vector<StepRecord<int, int, int>> steps;
  const Episode e = rollout(env, agent, attack, 0.5, 100, rng, [&](const auto& record, const Parrot& seen_by) {
    steps.push_back(record);
    EXPECT_EQ(seen_by.seen.size(), steps.size());
  });
  // States 3, 2, 1, shown as 4, 3, 2: rewards 12, 6, 2.
  EXPECT_EQ(agent.seen, (std::vector<int>{4, 3, 2}));
  EXPECT_EQ(e.total_reward, 20);
  EXPECT_EQ(e.discounted_return, 12 + 0.5 * 6 + 0.25 * 2);
  EXPECT_EQ(e.steps, 3);
  EXPECT_TRUE(e.terminal);
  ASSERT_EQ(steps.size(), 3u);
  EXPECT_EQ(steps[1].time, 1);
  EXPECT_EQ(steps[1].truth, 2);
  EXPECT_EQ(steps[1].shown, 3);
  EXPECT_EQ(steps[1].action, 3);
  EXPECT_EQ(steps[1].reward, 6);
  EXPECT_EQ(steps[1].next, 1);
  EXPECT_FALSE(steps[1].terminal);
  EXPECT_TRUE(steps[2].terminal);
}

TEST(Rollout, ForgetsFirstThenBeginsThenActs) {
  Countdown env;
  Parrot agent;
  PlusOne attack;
  Stream rng(1);
  rollout(env, agent, attack, 0.5, 100, rng);
  EXPECT_EQ(agent.calls, (std::vector<std::string>{"forget", "begin", "act", "act"}));
  EXPECT_EQ(attack.forgotten, 1);
  EXPECT_EQ(attack.agent_had_seen, (std::vector<std::size_t>{0, 1, 2})) << "the attack moves first";
}

TEST(Rollout, StopsAtTheHorizon) {
  Countdown env{.start = 10};
  Parrot agent;
  PlusOne attack;
  Stream rng(1);
  const Episode cut = rollout(env, agent, attack, 0.5, 4, rng);
  EXPECT_EQ(cut.steps, 4);
  EXPECT_FALSE(cut.terminal);
  const Episode none = rollout(env, agent, attack, 0.5, 0, rng);
  EXPECT_EQ(none.steps, 0);
  EXPECT_EQ(none.discounted_return, 0);
}

TEST(Evaluate, MeanAndIntervalOfIndependentEpisodes) {
  Countdown env{.start = 6, .random_start = true};
  Parrot agent;
  PlusOne attack;
  constexpr long episodes = 50;
  const Evaluation all = evaluate(env, agent, attack, 0.9, 100, episodes, 8);
  std::vector<double> returns;
  for (std::uint64_t k = 0; k < episodes; ++k) {
    Stream rng(8, k);
    returns.push_back(rollout(env, agent, attack, 0.9, 100, rng).discounted_return);
  }
  double mean = 0, squares = 0;
  for (const double x : returns) mean += x / episodes;
  for (const double x : returns) squares += (x - mean) * (x - mean);
  EXPECT_EQ(all.episodes, episodes);
  EXPECT_NEAR(all.mean, mean, 1e-12 * mean);
  EXPECT_NEAR(all.half_width, 1.96 * std::sqrt(squares / (episodes - 1) / episodes), 1e-12 * mean);
}

TEST(Evaluate, OneEpisodeSaysNothingOfTheSpread) {
  Countdown env;
  Parrot agent;
  PlusOne attack;
  const Evaluation one = evaluate(env, agent, attack, 0.5, 100, 1, 8);
  EXPECT_EQ(one.mean, 15.5);
  EXPECT_EQ(one.half_width, INFINITY);
}

}  // namespace
}  // namespace maximin
