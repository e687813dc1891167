#include <gtest/gtest.h>

#include <maximin/tabular/belief_update.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/pessimistic_q_learning.hpp>
#include <maximin/tabular/value_iteration.hpp>
#include <maximin/theory/bellman.hpp>

#include "random_model.hpp"

namespace maximin {
namespace {

/// Algorithm 1 word by word: both policies anew for all states in every step. `respond(q, s)` is lines 5 to 7, the
/// action that the learner is led to in s; `advance(s, a)` tells it what was done.
template <class Respond, class Advance>
QTable<double> by_the_book(const FiniteMdp<double>& mdp, const PessimisticQLearningOptions& options, Respond respond,
                           Advance advance) {
  const TabularEnvironment<double> env(mdp);
  QTable<double> q = QTable<double>::Zero(mdp.states(), mdp.actions());
  QTable<long> visits = QTable<long>::Zero(mdp.states(), mdp.actions());
  long step = 0;
  for (long episode = 0; episode < options.episodes; ++episode) {
    Stream rng(options.seed, static_cast<std::uint64_t>(episode));
    State s = env.reset(rng);
    for (long t = 0; t < options.horizon; ++t) {
      Action a = respond(q, s, t == 0);
      if (rng.chance(options.exploration(step++, visits.row(s).sum()))) a = rng.below(mdp.actions());
      const auto outcome = env.step(s, a, rng);
      advance(q, s, a, t == 0);
      const double bootstrap = outcome.terminal ? 0 : q(outcome.next, respond(q, outcome.next, false));
      const double alpha = options.step_size(visits(s, a)++);
      q(s, a) += alpha * (mdp.reward(s, a) + mdp.discount() * bootstrap - q(s, a));
      if (outcome.terminal) break;
      s = outcome.next;
    }
  }
  return q;
}

PessimisticQLearningOptions short_run(TieBreak tie) {
  PessimisticQLearningOptions options;
  options.episodes = 20;
  options.horizon = 30;
  options.exploration = ExplorationSchedule::by_visits(3);
  options.tie = tie;
  return options;
}

TEST(PessimisticQLearning, IsAlgorithmOneByTheBook) {
  for (std::uint64_t trial = 0; trial < 30; ++trial) {
    Stream rng(21, trial);
    const auto mdp = random_model(rng.integer(2, 9), rng.integer(2, 4), 0.9, rng);
    const auto perturbation = line_balls(mdp.states(), rng.integer(0, 3));
    const auto options = short_run(trial % 2 == 0 ? TieBreak::lowest_index : TieBreak::highest_index);
    const auto respond = [&](const QTable<double>& q, State s, bool) {
      Policy policy;
      AttackPolicy attack;
      std::vector<double> scratch;
      maximin_policy(q, perturbation, policy, scratch, MinAggregator{}, options.tie);
      best_response_attack(q, policy, perturbation, attack, options.tie);
      return policy[static_cast<std::size_t>(attack[static_cast<std::size_t>(s)])];
    };
    const auto expected = by_the_book(mdp, options, respond, [](const auto&, State, Action, bool) {});
    EXPECT_EQ(pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, options).q, expected);
  }
}

TEST(PessimisticQLearning, TheBeliefTakesThePlaceOfTheBallByTheBook) {
  int differs_from_ball = 0;
  for (std::uint64_t trial = 0; trial < 30; ++trial) {
    Stream rng(22, trial);
    const auto mdp = random_model(rng.integer(2, 9), rng.integer(2, 4), 0.9, rng);
    const auto perturbation = line_balls(mdp.states(), rng.integer(1, 3));
    auto options = short_run(trial % 2 == 0 ? TieBreak::lowest_index : TieBreak::highest_index);
    BeliefFilter filter(mdp, perturbation);
    Action last = 0;
    // Tries every observation on a copy of the filter; returns what is shown and done.
    const auto lead = [&](const QTable<double>& q, State s, bool first) {
      std::vector<State> ball(perturbation.ball(s).begin(), perturbation.ball(s).end());
      if (options.tie == TieBreak::highest_index) std::reverse(ball.begin(), ball.end());
      std::pair<State, Action> worst{-1, 0};
      for (const State t : ball) {
        BeliefFilter probe = filter;
        const Belief& m = first ? probe.reset(t) : probe.update(last, t);
        std::vector<double> scratch;
        const Action a = belief_action(q, std::span<const State>(m), scratch, MinAggregator{}, options.tie);
        if (worst.first < 0 || q(s, a) < q(s, worst.second)) worst = {t, a};
      }
      return worst;
    };
    const auto respond = [&](const QTable<double>& q, State s, bool first) { return lead(q, s, first).second; };
    const auto advance = [&](const QTable<double>& q, State s, Action a, bool first) {
      const State shown = lead(q, s, first).first;
      first ? filter.reset(shown) : filter.update(last, shown);
      last = a;
    };
    options.uncertainty = Uncertainty::belief;
    const auto found = pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, options);
    EXPECT_EQ(found.q, by_the_book(mdp, options, respond, advance)) << "trial " << trial;
    EXPECT_EQ(filter.empty_intersections(), 0);
    options.uncertainty = Uncertainty::ball;
    differs_from_ball += found.q != pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, options).q;
  }
  EXPECT_GE(differs_from_ball, 15);
}

/// Long and exploring, so that every pair is met often.
PessimisticQLearningOptions long_run(std::uint64_t seed) {
  PessimisticQLearningOptions options;
  options.episodes = 20'000;
  options.horizon = 20;
  options.exploration = ExplorationSchedule::constant(0.5);
  options.step_size = StepSizeSchedule::polynomial(0.75);
  options.seed = seed;
  return options;
}

/// Largest distance that a run of this length may keep from its fixed point, as a fraction of max|R|/(1-gamma).
constexpr double tolerance = 0.02;

TEST(PessimisticQLearning, WithTrivialBallsItIsQLearning) {
  for (std::uint64_t trial = 0; trial < 5; ++trial) {
    Stream rng(23, trial);
    const auto mdp = random_model(5, 3, 0.6, rng);
    const auto perturbation = line_balls(5, 0);
    const auto options = long_run(trial);
    const auto greedy = [](const QTable<double>& q, State s, bool) {
      Action best = 0;
      q.row(s).maxCoeff(&best);
      return best;
    };
    const auto plain = by_the_book(mdp, options, greedy, [](const auto&, State, Action, bool) {});
    const auto found = pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, options);
    EXPECT_EQ(found.q, plain);
    EXPECT_LT((found.q - value_iteration(mdp).q).cwiseAbs().maxCoeff(), tolerance / 0.4);
  }
}

TEST(PessimisticQLearning, ApproachesTheFixedPointWherePessimisticQIterationSettles) {
  int settled = 0, attack_matters = 0, reached = 0, reached_by_wrong_target = 0;
  for (std::uint64_t trial = 0; trial < 12; ++trial) {
    Stream rng(24, trial);
    const auto mdp = random_model(5, 3, 0.6, rng);
    const auto perturbation = line_balls(5, 1);
    const auto fixed = pessimistic_q_iteration(mdp, perturbation);
    if (fixed.fate != Fate::settled) continue;
    ++settled;
    const double slack = tolerance / 0.4;
    const TabularEnvironment<double> env(mdp);
    const auto distance = [&](const QTable<double>& q) { return (q - fixed.q).cwiseAbs().maxCoeff(); };
    reached += distance(pessimistic_q_learning(env, perturbation, long_run(trial)).q) < slack;
    // Negative control: the target max_a Q(s',a), as if there were no attacker.
    if (distance(value_iteration(mdp).q) < 2 * slack) continue;
    ++attack_matters;
    reached_by_wrong_target += distance(pessimistic_q_learning(env, line_balls(5, 0), long_run(trial)).q) < slack;
  }
  EXPECT_GE(settled, 8);
  EXPECT_GE(attack_matters, 5);
  EXPECT_GE(reached, settled - 1) << "trial 4 is the exception, see below";
  EXPECT_EQ(reached_by_wrong_target, 0);
}

/// |T^{pi_Q o omega_Q} Q - Q|: zero at a fixed point of pessimistic Q-iteration, and only there.
double residual(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation, const QTable<double>& q) {
  PessimisticStep<double> step;
  QTable<double> next;
  pessimistic_update(mdp, perturbation, q, step, next);
  return (next - q).cwiseAbs().maxCoeff();
}

TEST(PessimisticQLearning, MayRestWhereThereIsNoFixedPoint) {
  // Iteration settles, from zero and from where the learning rests; yet the learning rests elsewhere.
  Stream rng(24, 4);
  const auto mdp = random_model(5, 3, 0.6, rng);
  const auto perturbation = line_balls(5, 1);
  const auto fixed = pessimistic_q_iteration(mdp, perturbation);
  ASSERT_EQ(fixed.fate, Fate::settled);
  auto options = long_run(4);
  for (const long episodes : {5'000, 50'000}) {
    options.episodes = episodes;
    const auto q = pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, options).q;
    EXPECT_NEAR((q - fixed.q).cwiseAbs().maxCoeff(), 0.485, 0.02);
    EXPECT_GT(residual(mdp, perturbation, q), 0.4);
  }
}

TEST(PessimisticQLearning, MayFindAnotherFixedPoint) {
  Stream rng(24, 24);
  const auto mdp = random_model(5, 3, 0.6, rng);
  const auto perturbation = line_balls(5, 1);
  const auto fixed = pessimistic_q_iteration(mdp, perturbation);
  ASSERT_EQ(fixed.fate, Fate::settled);
  PessimisticQIterationOptions<double> from_there;
  from_there.initial = pessimistic_q_learning(TabularEnvironment<double>(mdp), perturbation, long_run(24)).q;
  const auto other = pessimistic_q_iteration(mdp, perturbation, from_there);
  EXPECT_EQ(other.fate, Fate::settled);
  EXPECT_LT(residual(mdp, perturbation, other.q), 1e-9);
  EXPECT_LT(residual(mdp, perturbation, fixed.q), 1e-9);
  EXPECT_GT((other.q - fixed.q).cwiseAbs().maxCoeff(), 0.5);
  EXPECT_LT((other.q - *from_there.initial).cwiseAbs().maxCoeff(), tolerance / 0.4);
}

/// The action alone decides where one goes: after one step a belief knows the truth, a ball of everything knows
/// nothing.
FiniteMdp<double> teleport() {
  FiniteMdpBuilder<double> b(3, 3, 0.5);
  const double pay[3][3] = {{0, 1, -1}, {-1, 0, 1}, {1, -1, 0}};
  for (State s = 0; s < 3; ++s) {
    for (Action a = 0; a < 3; ++a) b.transition(s, a, a, 1).reward(s, a, pay[s][a]);
  }
  return std::move(b).build();
}

TEST(PessimisticQLearning, ABeliefThatKnowsTheTruthLearnsQStar) {
  const auto mdp = teleport();
  const auto perturbation = line_balls(3, 2);
  auto options = long_run(1);
  options.episodes = 2000;
  options.step_size = StepSizeSchedule::constant(0.5);
  const auto best = value_iteration(mdp).q;
  const TabularEnvironment<double> env(mdp);
  EXPECT_GT((pessimistic_q_learning(env, perturbation, options).q - best).cwiseAbs().maxCoeff(), 0.5);
  options.uncertainty = Uncertainty::belief;
  EXPECT_LT((pessimistic_q_learning(env, perturbation, options).q - best).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(PessimisticQLearning, TerminalStatesAreWorthNothing) {
  // A corridor to a dead end: -1 per step, so Q(s) = -(distance to the end) discounted.
  FiniteMdpBuilder<double> b(4, 1, 0.5);
  for (State s = 0; s < 3; ++s) b.transition(s, 0, s + 1, 1).reward(s, 0, -1);
  b.transition(3, 0, 3, 1);
  const auto mdp = std::move(b).build();
  PessimisticQLearningOptions options;
  options.step_size = StepSizeSchedule::constant(1);
  options.episodes = 20;
  const auto found = pessimistic_q_learning(TabularEnvironment(mdp, State{0}), line_balls(4, 0), options);
  EXPECT_EQ(found.q(2, 0), -1);
  EXPECT_EQ(found.q(1, 0), -1.5);
  EXPECT_EQ(found.q(0, 0), -1.75);
  EXPECT_EQ(found.steps, 60);
  EXPECT_EQ(found.visits(0, 0), 20);
  EXPECT_EQ(found.visits(3, 0), 0);
}

TEST(PessimisticQLearning, ReportsEveryEpisodeAndStopsWhenAsked) {
  Stream rng(25);
  const auto mdp = random_model(4, 2, 0.5, rng);
  PessimisticQLearningOptions options;
  options.horizon = 10;
  options.episodes = 50;
  long seen = 0;
  const auto found = pessimistic_q_learning<double>(TabularEnvironment<double>(mdp), line_balls(4, 1), options,
                                                    [&](const LearningProgress<double>& progress) {
                                                      EXPECT_EQ(progress.episode, seen++);
                                                      EXPECT_EQ(progress.steps, 10 * seen);
                                                      EXPECT_LE(std::abs(progress.discounted_return), 2);
                                                      EXPECT_GT(progress.largest_update, 0);
                                                      return seen < 7;
                                                    });
  EXPECT_EQ(found.episodes, 7);
  EXPECT_EQ(found.steps, 70);
  EXPECT_EQ(found.visits.sum(), 70);
}

TEST(PessimisticQLearning, IsAFunctionOfTheSeed) {
  Stream rng(26);
  const auto mdp = random_model(4, 2, 0.5, rng);
  PessimisticQLearningOptions options;
  options.episodes = 5;
  const TabularEnvironment<double> env(mdp);
  const auto perturbation = line_balls(4, 1);
  const auto first = pessimistic_q_learning(env, perturbation, options).q;
  EXPECT_EQ(first, pessimistic_q_learning(env, perturbation, options).q);
  options.seed = 2;
  EXPECT_NE(first, pessimistic_q_learning(env, perturbation, options).q);
}

TEST(Schedules, Values) {
  const auto linear = ExplorationSchedule::linear(1, 0.2, 100);
  EXPECT_EQ(linear(0, 5), 1);
  EXPECT_NEAR(linear(50, 5), 0.6, 1e-15);
  EXPECT_NEAR(linear(1000, 5), 0.2, 1e-15);
  EXPECT_EQ(ExplorationSchedule::constant(0.3)(7, 7), 0.3);
  EXPECT_EQ(ExplorationSchedule::by_visits(2)(7, 0), 1);
  EXPECT_EQ(ExplorationSchedule::by_visits(2)(7, 6), 0.25);
  EXPECT_EQ(StepSizeSchedule::constant(0.3)(7), 0.3);
  EXPECT_EQ(StepSizeSchedule::polynomial(1)(0), 1);
  EXPECT_EQ(StepSizeSchedule::polynomial(1)(3), 0.25);
  EXPECT_EQ(StepSizeSchedule::polynomial(0.5)(3), 0.5);
}

TEST(Schedules, RefuseValuesOutOfRange) {
  EXPECT_THROW(ExplorationSchedule::constant(1.1), InputError);
  EXPECT_THROW(ExplorationSchedule::constant(NAN), InputError);
  EXPECT_THROW(ExplorationSchedule::linear(1, -0.1, 10), InputError);
  EXPECT_THROW(ExplorationSchedule::linear(1, 0, 0), InputError);
  EXPECT_THROW(ExplorationSchedule::by_visits(0), InputError);
  EXPECT_THROW(StepSizeSchedule::constant(0), InputError);
  EXPECT_THROW(StepSizeSchedule::constant(NAN), InputError);
  EXPECT_THROW(StepSizeSchedule::polynomial(1.5), InputError);
}

TEST(PessimisticQLearning, RefusesWhatDoesNotFit) {
  Stream rng(27);
  const auto mdp = random_model(4, 2, 0.5, rng);
  const TabularEnvironment<double> env(mdp);
  PessimisticQLearningOptions options;
  EXPECT_THROW(pessimistic_q_learning(env, line_balls(5, 1), options), InputError);
  options.horizon = 0;
  EXPECT_THROW(pessimistic_q_learning(env, line_balls(4, 1), options), InputError);
  options.horizon = 1;
  options.episodes = 0;
  EXPECT_THROW(pessimistic_q_learning(env, line_balls(4, 1), options), InputError);
}

}  // namespace
}  // namespace maximin
