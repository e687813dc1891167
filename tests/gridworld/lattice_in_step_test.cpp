#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <map>
#include <vector>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/gridworld_lattice.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/tabular/tabular_agents.hpp>
#include <maximin/tabular/tabular_attacks.hpp>
#include <maximin/tabular/tabular_environment.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/rollout_in_step.hpp>

/// The exact layer's agents and attacks, in one episode after the other and in many in step.
namespace maximin {
namespace {

bool same(const Episode& x, const Episode& y) {
  return x.discounted_return == y.discounted_return && x.total_reward == y.total_reward && x.steps == y.steps &&
         x.terminal == y.terminal;
}

/// How many of the episodes in step are not, to the last bit, what `rollout` plays with the same stream.
template <class AgentT, class AttackT>
int differences(const TabularEnvironment<double>& env, const AgentT& agent, const AttackT& attack,
                const EpisodesInStep& options, bool wrong_streams = false) {
  EachLane<AgentT> agents(agent);
  EachLaneAttack<AttackT> attacks(attack);
  long records = 0;
  const auto in_step = rollout_in_step(env, agents, attacks, options, [&](long, const auto&) { ++records; });
  int differ = 0;
  long steps = 0;
  AgentT alone(agent);
  AttackT lone_attack(attack);
  for (long k = 0; k < options.episodes; ++k) {
    Stream rng(options.seed, static_cast<std::uint64_t>(k) + wrong_streams);
    const Episode e = rollout(env, alone, lone_attack, options.discount, options.horizon, rng);
    differ += !same(e, in_step[static_cast<std::size_t>(k)]);
    steps += in_step[static_cast<std::size_t>(k)].steps;
  }
  EXPECT_EQ(records, steps) << "every step is observed once";
  return differ;
}

/// Shows the truth for a while, then the last state of its ball: it remembers, and must be made to forget.
class Impatient {
 public:
  explicit Impatient(const Perturbation<double>& balls) : balls_(&balls) {}
  void forget() { shown_ = 0; }
  template <class AgentT>
  State perturb(State truth, const AgentT&, Stream&) {
    const auto ball = balls_->ball(truth);
    return shown_++ < 9 ? truth : ball.back();
  }

 private:
  const Perturbation<double>* balls_;
  int shown_ = 0;
};

/// The same, but never made to forget.
class Grudging : private Impatient {
 public:
  using Impatient::Impatient;
  using Impatient::perturb;
};

/// A policy that draws: its answers depend on the stream being its own.
class Dithering {
 public:
  using ObservationType = State;
  using ActionType = Action;
  explicit Dithering(Action actions) : actions_(actions) {}
  Action begin(State, Stream& rng) const { return rng.below(actions_); }
  Action act(State o, Stream& rng) const { return begin(o, rng); }

 private:
  Action actions_;
};

class InStep {
 public:
  explicit InStep(const Model<double>& model)
      : mdp_(model.mdp),
        balls_(make_perturbation(model)),
        env_(model.start.empty() ? TabularEnvironment<double>(mdp_) : TabularEnvironment<double>(mdp_, model.start)),
        q_(policy_iteration(mdp_).q) {}

  /// Differences over all pairs of agents and attacks, for so many lanes.
  int differences_with(Lane lanes, long horizon, bool wrong_streams = false) const {
    const EpisodesInStep options{mdp_.discount(), horizon, 25, 3, lanes};
    int sum = 0;
    const auto against_all = [&](const auto& agent) {
      sum += differences(env_, agent, NoAttack{}, options, wrong_streams);
      sum += differences(env_, agent, RandomAttack<double>(balls_), options, wrong_streams);
      sum += differences(env_, agent, Impatient(balls_), options, wrong_streams);
      if constexpr (TransparentAgent<std::decay_t<decltype(agent)>>) {
        sum += differences(env_, agent, MyopicAttack<double>(q_, balls_), options, wrong_streams);
      }
    };
    against_all(TabularAgent(greedy()));
    against_all(BeliefAgent(q_, BallBelief(balls_)));
    against_all(BeliefAgent(q_, BeliefFilter<double>(mdp_, balls_), MeanAggregator{}));
    against_all(Dithering(mdp_.actions()));
    return sum;
  }

  /// Of an attack that is not made to forget, whose lanes have seen other episodes before.
  int differences_of_a_grudge(Lane lanes) const {
    return differences(env_, TabularAgent(greedy()), Grudging(balls_), {mdp_.discount(), 40, 25, 3, lanes});
  }

 private:
  Policy greedy() const {
    Policy policy(static_cast<std::size_t>(mdp_.states()));
    for (State s = 0; s < mdp_.states(); ++s) q_.row(s).maxCoeff(&policy[static_cast<std::size_t>(s)]);
    return policy;
  }

  FiniteMdp<double> mdp_;
  Perturbation<double> balls_;
  TabularEnvironment<double> env_;
  QTable<double> q_;
};

TEST(RolloutInStep, OnTheLatticeIsRolloutWhateverTheLanes) {
  const InStep play(gridworld_lattice());
  for (const Lane lanes : {1, 2, 7, 25, 64}) EXPECT_EQ(play.differences_with(lanes, 60), 0) << lanes;
}

RC_GTEST_PROP(RolloutInStep, OnRandomModelsIsRolloutWhateverTheLanes, (const Model<double>& model)) {
  const InStep play(model);
  const Lane lanes = *rc::gen::inRange(1, 30);
  RC_ASSERT(play.differences_with(lanes, *rc::gen::inRange(0, 12)) == 0);
}

TEST(RolloutInStep, TheComparisonFindsDifferences) {
  const InStep play(gridworld_lattice());
  EXPECT_GT(play.differences_with(7, 60, /*wrong_streams=*/true), 100);
  EXPECT_GT(play.differences_of_a_grudge(7), 0) << "what is remembered from another episode shows";
}

TEST(RolloutInStep, BeginsWithWhicheverEpisode) {
  const auto model = gridworld_lattice();
  const TabularEnvironment<double> env(model.mdp);
  EachLane<Dithering> agents(Dithering(8));
  EachLaneAttack<NoAttack> attacks{NoAttack{}};
  const auto paths = [&](const EpisodesInStep& options) {
    std::map<long, std::vector<State>> way;
    const auto played = rollout_in_step(env, agents, attacks, options,
                                        [&](long number, const auto& record) { way[number].push_back(record.next); });
    EXPECT_EQ(played.size(), static_cast<std::size_t>(options.episodes));
    return way;
  };
  auto all = paths({.horizon = 30, .episodes = 12});
  const auto last = paths({.horizon = 30, .episodes = 5, .lanes = 2, .first = 7});
  EXPECT_NE(all[0], all[7]);
  std::erase_if(all, [](const auto& way) { return way.first < 7; });
  EXPECT_EQ(last, all);
}

TEST(RolloutInStep, PlaysNothingInNoTimeAndRefusesNoLanes) {
  const auto model = gridworld_lattice();
  const TabularEnvironment<double> env(model.mdp);
  EachLane<Dithering> agents(Dithering(8));
  EachLaneAttack<NoAttack> attacks{NoAttack{}};
  for (const Episode& e : rollout_in_step(env, agents, attacks, {.horizon = 0, .episodes = 5})) EXPECT_EQ(e.steps, 0);
  EXPECT_TRUE(rollout_in_step(env, agents, attacks, {.episodes = 0}).empty());
  EXPECT_THROW(rollout_in_step(env, agents, attacks, {.lanes = 0}), InputError);
}

}  // namespace
}  // namespace maximin
