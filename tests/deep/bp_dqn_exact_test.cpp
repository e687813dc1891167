// BP-DQN against the exact layer: on finite models whose states are points, the network trains as it does in the
// Gridworld, and what its policy is worth in the worst case is then computed exactly.
//
// What is compared, and why. Where pessimistic Q-iteration settles, its Q is the worst case of its own policy pi:
// it values a state by Q(s, pi(omega(s))). BP-DQN does not see s when it acts and values it by
// max_a min_{m in M} Q(m, a), M being its belief about s: never more than Q(s, .) of the action it takes, so its fixed
// point is another one, and nothing forces its policy to be as good. Both policies are however read off their tables
// alike, as the maximin over the ball, and a policy is worth what it is worth whatever table it came from. So the test
// compares exact worst-case values of policies, not tables, and checks the table against the fixed point of BP-DQN's
// own target. Among models on which pessimistic Q-iteration settles there are those where the policy of BP-DQN's exact
// fixed point, the truth being shown, is as good within the tolerance below, and those where it is worse and learning
// that target well does not mend it. The models below are of the first kind, ones where pessimism matters; the last
// test keeps one of the second in sight.
#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/attacks/place_attacks.hpp>
#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/losses/td_loss.hpp>
#include <maximin/deep/place_beliefs.hpp>
#include <maximin/deep/set_beliefs.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/deep/trainer.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bellman.hpp>
#include "lipschitz_places.hpp"

namespace maximin::deep {
namespace {

/// Everything below is in units of max|R|/(1-gamma), this is the stated tolerance.
constexpr double tolerance = 0.02;

/// Who perturbs while BP-DQN learns.
enum class Opponent { none, best_response };

/// One application of BP-DQN's target to a table: R + gamma P U, U(s) = max_a min_{m in B(o)} Q(m, a), where o is what
/// is shown when s is true. Returns U, and the maximin policy, of the table.
struct Reading {
  Policy policy;
  Values<double> u;
};
Reading read(const LipschitzPlaces& m, const QTable<double>& q, Opponent opponent) {
  Reading r{{}, Values<double>(q.rows())};
  std::vector<double> scratch;
  maximin_policy(q, m.balls, r.policy, scratch);
  AttackPolicy shown = no_attack(m.places.states());
  if (opponent == Opponent::best_response) best_response_attack(q, r.policy, m.balls, shown);
  for (State s = 0; s < m.places.states(); ++s) {
    const State o = shown[static_cast<std::size_t>(s)];
    r.u[s] = std::numeric_limits<double>::infinity();
    for (const State t : m.balls.ball(o)) r.u[s] = std::min(r.u[s], q(t, r.policy[static_cast<std::size_t>(o)]));
  }
  return r;
}

/// The table that the target leads back to itself; nothing where it was not reached: with the truth shown the target is
/// a contraction, under best responses it need not be.
std::optional<QTable<double>> fixed_point(const LipschitzPlaces& m, Opponent opponent,
                                          BootstrapBelief bootstrap = BootstrapBelief::next) {
  QTable<double> q = QTable<double>::Zero(m.model.mdp.states(), m.model.mdp.actions()), next = q;
  for (int round = 0; round < 500; ++round) {
    const Values<double> u = read(m, q, opponent).u;
    backup(m.model.mdp, u, next);
    if (bootstrap == BootstrapBelief::current) {
      next = m.model.mdp.rewards().colwise() + m.model.mdp.discount() * u;
    }
    q.swap(next);
  }
  if ((q - next).cwiseAbs().maxCoeff() > 1e-12 * m.scale()) return std::nullopt;
  return q;
}

TrainOptions options(const LipschitzPlaces& m) {
  TrainOptions o;
  o.frames = 40'000;
  o.horizon = 20;
  o.frames_per_update = 8;
  o.learning_rate = 5e-3;
  o.adam_eps = 1e-8;
  o.warm_up = 2000;
  o.explore_end = 0.5;
  o.explore_frames = o.frames;
  o.target_every = 1000;
  o.reward_scale = 0.3 / m.model.mdp.rewards().cwiseAbs().maxCoeff();
  o.stretch_frames = o.frames;
  o.replay.capacity = o.frames;
  return o;
}

enum class Learner { bp_dqn, dqn, bp_dqn_with_the_printed_target };

/// What a training came to.
struct Learned {
  QTable<double> q;  ///< in rewards
  Policy policy;     ///< the agent's, observation by observation
};

Learned outcome(const LipschitzPlaces& m, BeliefAgent& agent, QNetwork& online, double reward_scale) {
  const State n = m.places.states();
  std::vector<Point> all;
  for (State s = 0; s < n; ++s) all.push_back(m.places.point(s));
  Learned learned{QTable<double>(n, m.model.mdp.actions()), Policy(static_cast<std::size_t>(n))};
  agent.resize(1);
  agent.would_do(std::vector<Lane>(all.size(), 0), all, learned.policy);
  torch::NoGradGuard no_grad;
  const torch::Tensor q = online.forward(to_tensor(all)).to(torch::kDouble).contiguous() / reward_scale;
  std::copy_n(q.data_ptr<double>(), learned.q.size(), learned.q.data());
  return learned;
}

/// Trains with the Trainer that the Gridworld's agents are trained with.
Learned train(const LipschitzPlaces& m, Learner learner, Opponent opponent) {
  TrainOptions o = options(m);
  if (learner == Learner::bp_dqn_with_the_printed_target) o.bootstrap = BootstrapBelief::current;
  TrainingParts parts;
  Stream weights(o.seed, std::uint64_t{1} << 62U);
  parts.online = std::make_shared<QNetwork>(QNetworkShape{.inputs = 2,
                                                          .hidden = {64, 64},
                                                          .actions = m.model.mdp.actions(),
                                                          .input_centre = 0.5,
                                                          .input_scale = 2,
                                                          .waves = 3},
                                            weights);
  if (learner == Learner::dqn) {
    parts.belief = std::make_shared<ObservedState>();
  } else {
    parts.belief = std::make_shared<PlaceBeliefs>(SetBelief::ball, m.model.mdp, m.balls, m.places);
  }
  parts.aggregator = MinAggregator{};
  if (opponent == Opponent::best_response) {
    parts.attack = std::make_shared<PlaceBestResponse>(parts.online, m.balls, m.places);
  } else {
    parts.attack = std::make_shared<NoAttack>();
  }
  parts.loss = std::make_shared<TdLoss>(
      TdLossOptions{.td = {.discount = m.model.mdp.discount(), .double_q = false}, .aggregator = MinAggregator{}});
  parts.world = std::make_shared<PlacesWorld>(m.environment, m.places);
  Trainer trainer(o, parts);
  while (!trainer.done()) trainer.stretch();
  return outcome(m, trainer.agent(), *parts.online, o.reward_scale);
}

/// By how much the worst case of `policy` falls short of that of pessimistic Q-iteration's, in the worst state and in
/// the mean; negative where it is better.
struct Shortfall {
  double worst, mean;
};
Shortfall shortfall(const LipschitzPlaces& m, const Policy& policy) {
  const Values<double> lost = (m.worst_case(m.policy) - m.worst_case(policy)) / m.scale();
  return {lost.maxCoeff(), lost.mean()};
}

/// What makes a model one to test on: the iteration settles, to the worst case of its own policy; and the policy that
/// is optimal where nobody attacks is another one, and much worse.
void expect_fit(const LipschitzPlaces& m) {
  ASSERT_EQ(m.pessimistic.fate, Fate::settled);
  Values<double> own;
  attacked_values(m.pessimistic.q, m.policy, m.balls, own);
  EXPECT_LT((own - m.worst_case(m.policy)).cwiseAbs().maxCoeff(), 1e-9 * m.scale());
  Policy greedy;
  greedy_policy(policy_iteration(m.model.mdp).q, greedy);
  EXPECT_NE(greedy, m.policy);
  EXPECT_GT(shortfall(m, greedy).mean, 6 * tolerance);
}

/// Trains BP-DQN and checks its policy in every state, and its table against the fixed point of its target.
void expect_reached(const LipschitzPlaces& m, Opponent opponent) {
  expect_fit(m);
  const QTable<double> exact = fixed_point(m, opponent).value();
  const Learned learned = train(m, Learner::bp_dqn, opponent);
  EXPECT_LT((learned.q - exact).cwiseAbs().maxCoeff(), 2 * tolerance * m.scale());
  EXPECT_LT(shortfall(m, learned.policy).worst, tolerance);
}

// Control: vanilla DQN, trained as long on the same model, finds the optimal values and fails by far.
TEST(BpDqn, ReachesTheExactWorstCaseOfPessimisticQIterationAndDqnDoesNot) {
  const LipschitzPlaces m(83, 0.15);
  expect_reached(m, Opponent::none);
  const Learned vanilla = train(m, Learner::dqn, Opponent::none);
  EXPECT_LT((vanilla.q - policy_iteration(m.model.mdp).q).cwiseAbs().maxCoeff(), 2 * tolerance * m.scale());
  EXPECT_GT(shortfall(m, vanilla.policy).mean, 6 * tolerance);
}

// Control: the target as the paper prints it, with the belief of s_t in the place of that of s_{t+1}.
TEST(BpDqn, ReachesItUnderBestResponsesAndWithThePrintedTargetDoesNot) {
  const LipschitzPlaces m(138, 0.15);
  expect_reached(m, Opponent::best_response);
  const Learned printed = train(m, Learner::bp_dqn_with_the_printed_target, Opponent::none);
  EXPECT_GT(shortfall(m, printed.policy).mean, 4 * tolerance);
  const QTable<double> exact = fixed_point(m, Opponent::none, BootstrapBelief::current).value();
  EXPECT_LT((printed.q - exact).cwiseAbs().maxCoeff(), 2 * tolerance * m.scale());
}

// What is known of BP-DQN's fixed point without a network. Under best responses it promises no more than its policy
// keeps: it values s by min_{m in B(o)} Q(m, pi(o)) <= Q(s, pi(o)) = min_{t in B(s)} Q(s, pi(t)), so that Q is below
// what T^pi_rob makes of it, and therefore below the fixed point of T^pi_rob. With the truth shown it may promise more.
// And its policy may be worse than that of pessimistic Q-iteration.
TEST(BpDqn, ItsFixedPointPromisesLessThanItKeepsAndMayFallShort) {
  int kept = 0, promised_too_much = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const LipschitzPlaces m(seed, 0.15);
    for (const Opponent opponent : {Opponent::best_response, Opponent::none}) {
      const auto q = fixed_point(m, opponent);
      if (!q) continue;
      const Reading r = read(m, *q, opponent);
      const double excess = (r.u - m.worst_case(r.policy)).maxCoeff() / m.scale();
      if (opponent == Opponent::none) {
        promised_too_much += excess > 1e-3;
      } else {
        EXPECT_LT(excess, 1e-9) << seed;
        ++kept;
      }
    }
  }
  EXPECT_GT(kept, 20);
  EXPECT_GT(promised_too_much, 0);  // the bound is not true of just any target
  const LipschitzPlaces m(37, 0.15);
  expect_fit(m);
  const Reading r = read(m, fixed_point(m, Opponent::none).value(), Opponent::none);
  EXPECT_GT(shortfall(m, r.policy).mean, 1.5 * tolerance);
}

}  // namespace
}  // namespace maximin::deep
