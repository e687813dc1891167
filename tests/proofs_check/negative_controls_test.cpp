// Each check must be able to fail. Here each is given something false, and does.

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include <maximin/proofs_check/examination.hpp>
#include <maximin/proofs_check/verdict_text.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/bounds.hpp>

#include "../tabular/belief_soundness.hpp"
#include "../tabular/random_model.hpp"
#include "independent.hpp"
#include "trap_model.hpp"

namespace maximin {
namespace {

/// What a check says of left <= right.
Verdict judged(double left, double right, double slack = 1e-9) {
  Check check;
  check.observe(left, right, slack);
  return check.verdict;
}

std::set<ClaimId> violated_claims(const Examination& found) {
  std::set<ClaimId> violated;
  for (const Claim& c : claims()) {
    if (found.check(c.id).verdict == Verdict::violated) violated.insert(c.id);
  }
  return violated;
}

TEST(NegativeControl, Theorem1AsPrintedFailsForOneSidedRewards) {
  const auto mdp = one_sided<double>();
  const auto balls = one_sided_balls<double>();
  const auto printed = examine(mdp, balls, {.reading = Reading::paper});
  const Check& theorem = printed.check(ClaimId::theorem_1);
  EXPECT_EQ(theorem.verdict, Verdict::violated);
  EXPECT_NEAR(theorem.left, 10, 1e-9);
  EXPECT_EQ(theorem.right, 6);
  EXPECT_EQ(outcome(printed), Outcome::violated);
  EXPECT_EQ(violated_claims(printed), (std::set{ClaimId::lemma_1, ClaimId::lemma_2, ClaimId::theorem_1}))
      << "what the paper prints, and nothing of the strengthenings";

  const auto corrected = examine(mdp, balls, {.reading = Reading::corrected});
  EXPECT_EQ(corrected.check(ClaimId::theorem_1).verdict, Verdict::holds);
  EXPECT_NEAR(corrected.check(ClaimId::theorem_1).left, 10, 1e-9);
  EXPECT_EQ(violated_claims(corrected), std::set<ClaimId>());
  EXPECT_EQ(outcome(corrected), Outcome::holds);
}

/// The trap holds every claim, and every claim that has 2 eps in it fails with eps.
class EpsForTwoEps : public testing::TestWithParam<ClaimId> {};

TEST_P(EpsForTwoEps, IsViolatedOnTheTrap) {
  const auto found = examine(trap(), trap_balls());
  const Check& check = found.check(GetParam());
  EXPECT_EQ(check.verdict, Verdict::holds);
  EXPECT_EQ(judged(check.left, check.right, check.slack), Verdict::holds);
  EXPECT_EQ(judged(check.left, check.right / 2, check.slack), Verdict::violated);
}

INSTANTIATE_TEST_SUITE_P(Claims, EpsForTwoEps,
                         testing::Values(ClaimId::lemma_2, ClaimId::theorem_1, ClaimId::a_optimal_attacker,
                                         ClaimId::b_one_sided, ClaimId::c_finite_n, ClaimId::d_total_variation,
                                         ClaimId::e_test_time, ClaimId::f_belief));

TEST(NegativeControl, TheTrapIsWorthWhatItIsSaidToBe) {
  const auto found = examine(trap(), trap_balls());
  EXPECT_EQ(found.constants.l_r.value, 1);
  EXPECT_EQ(found.constants.l_p.value, 0);
  EXPECT_EQ(found.constants.k_tv.value, 0);
  EXPECT_NEAR(found.lipschitz_of_q_star, 1, 1e-12);
  const Check& e = found.check(ClaimId::e_test_time);
  EXPECT_NEAR(e.left, 0.25 * trap_loss / 0.75, 1e-12);
  EXPECT_NEAR(e.right, 0.25 * 2 / 0.75, 1e-12);
  EXPECT_NEAR(found.check(ClaimId::lemma_2).left, 0.25 * trap_loss, 1e-12);
  EXPECT_NEAR(found.check(ClaimId::f_belief).left, trap_loss, 1e-12);
  EXPECT_EQ(found.check(ClaimId::f_belief).right, 2 / 0.75) << "rho = 2 eps";
  EXPECT_TRUE(found.attack_changes_action);
  EXPECT_TRUE(found.pessimism_changes_action);
}

Policy maximin_of_q_star(const FiniteMdp<double>& mdp, const Perturbation<double>& balls) {
  Policy policy;
  std::vector<double> scratch;
  maximin_policy(policy_iteration(mdp).q, balls, policy, scratch);
  return policy;
}

/// max (Q* - Q of the policy against the optimal attacker within `reach`).
double gap(const FiniteMdp<double>& mdp, const Perturbation<double>& reach, const Policy& policy) {
  return (policy_iteration(mdp).q - evaluate_against_optimal_attack(mdp, reach, policy).q).maxCoeff();
}

TEST(NegativeControl, AnAttackerOutsideTheBallBreaksTheBound) {
  const auto mdp = trap();
  const auto balls = trap_balls();
  const Policy policy = maximin_of_q_star(mdp, balls);
  const double bound = examine(mdp, balls).check(ClaimId::e_test_time).right;
  EXPECT_EQ(judged(gap(mdp, balls, policy), bound), Verdict::holds);
  const double outside = gap(mdp, trap_balls(10), policy);
  EXPECT_NEAR(outside, 0.25 * 10 / 0.75, 1e-9) << "state 0 passes for state 10, where action 2 is best";
  EXPECT_EQ(judged(outside, bound), Verdict::violated);
}

/// The belief update with its last successor forgotten.
class SkipsLastSuccessor {
 public:
  SkipsLastSuccessor(const FiniteMdp<double>& mdp, const Perturbation<double>& balls) : mdp_(&mdp), balls_(&balls) {}

  const Belief& reset(State observation) {
    const auto ball = balls_->ball(observation);
    belief_.assign(ball.begin(), ball.end());
    return belief_;
  }
  const Belief& update(Action a, State observation) {
    Belief predicted;
    for (const State m : belief_) {
      const auto row = mdp_->successors(m, a);
      const auto kept = row.first(std::max<std::size_t>(1, row.size() - 1));
      for (const auto& next : kept) predicted.push_back(next.target);
    }
    std::sort(predicted.begin(), predicted.end());
    predicted.erase(std::unique(predicted.begin(), predicted.end()), predicted.end());
    meet_observation(*balls_, std::span<const State>(predicted), observation, belief_);
    return belief_;
  }

 private:
  const FiniteMdp<double>* mdp_;
  const Perturbation<double>* balls_;
  Belief belief_;
};

/// The belief update one step late: it meets the ball of the observation before.
class OneObservationLate : public BeliefFilter<double> {
 public:
  OneObservationLate(const FiniteMdp<double>& mdp, const Perturbation<double>& balls) : BeliefFilter(mdp, balls) {}

  const Belief& reset(State observation) {
    last_ = observation;
    return BeliefFilter::reset(observation);
  }
  const Belief& update(Action a, State observation) {
    return BeliefFilter::update(a, std::exchange(last_, observation));
  }

 private:
  State last_ = 0;
};

/// Of 200 episodes on random models, how many lose the truth.
template <class Filter>
int lost(Shown shown) {
  int count = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Stream rng(1, trial);
    const auto mdp = random_model(10, 2, 0.9, rng);
    const auto balls = line_balls(10, 1);
    count += !keeps_the_truth(Filter(mdp, balls), mdp, balls, shown, 20, rng);
  }
  return count;
}

TEST(NegativeControl, AnOffByOneInTheBeliefUpdateLosesTheTruth) {
  for (const Shown shown : {Shown::random, Shown::farthest, Shown::smallest_belief}) {
    EXPECT_EQ(lost<BeliefFilter<double>>(shown), 0);
    EXPECT_GT(lost<SkipsLastSuccessor>(shown), 20);
    EXPECT_GT(lost<OneObservationLate>(shown), 20);
  }
}

TEST(NegativeControl, AnAgentThatMinimisesBreaksTheBound) {
  const auto mdp = trap();
  const auto balls = trap_balls();
  const QTable<double> against = -policy_iteration(mdp).q;  // argmax min of -Q is argmin max of Q
  Policy swapped;
  std::vector<double> scratch;
  maximin_policy(against, balls, swapped, scratch);
  EXPECT_EQ(judged(gap(mdp, balls, swapped), examine(mdp, balls).check(ClaimId::e_test_time).right), Verdict::violated);
}

/// E does not tell min from max over the ball: a maximax policy loses at most 2 eps L a step too, by the same argument.
/// What does is the definition: no action has a better worst case.
TEST(NegativeControl, AnOptimistIsFoundOutByItsWorstCase) {
  const auto balls = trap_balls();
  const QTable<double> q = policy_iteration(trap()).q;
  const auto regret = [&](const Policy& policy) {
    double largest = 0;
    for (State t = 0; t < 4; ++t) {
      const auto worst = [&](Action a) {
        double least = INFINITY;
        for (const State m : balls.ball(t)) least = std::min(least, q(m, a));
        return least;
      };
      const double best = std::max({worst(0), worst(1), worst(2)});
      largest = std::max(largest, best - worst(policy[static_cast<std::size_t>(t)]));
    }
    return largest;
  };
  Policy pessimist, optimist;
  std::vector<double> scratch;
  maximin_policy(q, balls, pessimist, scratch);
  maximin_policy(q, balls, optimist, scratch, MaxAggregator{});
  EXPECT_EQ(judged(regret(pessimist), 0), Verdict::holds);
  EXPECT_EQ(judged(regret(optimist), 0), Verdict::violated);
}

/// An attacker that helps leaves a smaller gap, which no bound minds. The identity T^{pi_n}_rob Q_n = Q_{n+1} of
/// strengthening A does.
TEST(NegativeControl, AnAttackerThatHelpsIsFoundOutByTheIdentityOfA) {
  const auto mdp = trap();
  const auto balls = trap_balls();
  const QTable<double> q = mdp.rewards();
  Policy policy, composed;
  std::vector<double> scratch;
  maximin_policy(q, balls, policy, scratch);
  Values<double> v;
  QTable<double> robust, next;
  bellman_robust(mdp, policy, balls, q, v, robust);
  const auto defect = [&](const QTable<double>& judged_by) {
    AttackPolicy attack;
    best_response_attack(judged_by, policy, balls, attack);
    compose(policy, attack, composed);
    bellman_pair(mdp, composed, q, v, next);
    return (next - robust).cwiseAbs().maxCoeff();
  };
  EXPECT_EQ(judged(defect(q), 0), Verdict::holds);
  EXPECT_EQ(judged(defect(-q), 0), Verdict::violated);
}

/// Two states that stay what they are, rewards -1 and 1: Lemma 1 with the repaired constant is attained, so nothing in
/// it can be left out.
TEST(NegativeControl, NoFactorOfLemma1CanBeDropped) {
  FiniteMdpBuilder<double> b(2, 1, 0.5);
  b.transition(0, 0, 0, 1).transition(1, 0, 1, 1).reward(0, 0, -1).reward(1, 0, 1);
  const auto mdp = std::move(b).build();
  const auto balls = on_line<double>({0, 1}, 1);
  const independent::Subject subject{mdp, balls};
  const double l = independent::lipschitz(reference::of_pair(mdp, {0, 0}), balls.metric());
  EXPECT_NEAR(l, 4, 1e-12);
  EXPECT_EQ(judged(l, bounds::lipschitz_of_q(0.5, 2.0, 1.0, 2, 1.0)), Verdict::holds);
  EXPECT_EQ(judged(l, bounds::lipschitz_of_q_tv(0.5, 2.0, 1.0, 2.0)), Verdict::holds);
  EXPECT_EQ(judged(l, bounds::lipschitz_of_q(0.5, 2.0, 1.0, 1, 1.0)), Verdict::violated) << "without |S|";
  EXPECT_EQ(judged(l, bounds::lipschitz_of_q_tv(0.5, 2.0, 0.5, 2.0)), Verdict::violated) << "half of the K";
  EXPECT_EQ(judged(l, bounds::lipschitz_of_q_tv(0.5, 2.0, 1.0, 1.0)), Verdict::violated) << "R_max for span(R)";
  EXPECT_EQ(judged(l, subject.c.l_r), Verdict::violated) << "l_r alone";
}

/// Nothing is confused, so Delta = 0; but Q_0 = 0 knows nothing yet. B is a statement about the limit, and C about
/// every n only with the distance of Q_0 from Q* in it.
TEST(NegativeControl, BIsOnlyTrueInTheLimitAndCNeedsTheStart) {
  FiniteMdpBuilder<double> b(1, 2, 0.5);
  b.transition(0, 0, 0, 1).transition(0, 1, 0, 1).reward(0, 1, 1);
  const auto mdp = std::move(b).build();
  const auto balls = on_line<double>({0}, 0);
  const auto found = examine(mdp, balls);
  EXPECT_EQ(violated_claims(found), std::set<ClaimId>());
  EXPECT_NEAR(found.check(ClaimId::b_one_sided).left, 0, 1e-9);
  const double first_gap = gap(mdp, balls, {0});  // pi_0 takes action 0, for ever worth nothing
  EXPECT_NEAR(first_gap, 1, 1e-9);
  EXPECT_EQ(judged(first_gap, found.check(ClaimId::b_one_sided).right), Verdict::violated);
  EXPECT_EQ(judged(first_gap, bounds::finite_n(0.5, 0.0, 0.0, 0.0, 0)), Verdict::violated) << "d_0 left out";
  EXPECT_EQ(judged(first_gap, bounds::finite_n(0.5, 0.0, 2.0, 0.0, 0)), Verdict::holds);
}

/// Two states next to each other, steep but nearly equal, must not hide a gross violation between two others: Lemma 1
/// is looked at for every pair, not only for the steepest.
TEST(NegativeControl, ASteepPairDoesNotHideAViolatedOne) {
  FiniteMdpBuilder<double> b(5, 2, 0.5);
  for (Action a = 0; a < 2; ++a) {
    b.reward(1, a, -1).reward(2, a, -20).transition(2, a, 2, 1).transition(3, a, 3, 1);
    b.transition(4, a, 3, 0.9999999999997).transition(4, a, 2, 3e-13);
  }
  b.transition(0, 0, 0, 1).transition(0, 1, 2, 1).transition(1, 1, 1, 1).transition(1, 0, 2, 1);
  const auto mdp = std::move(b).build();
  Metric<double>::Points points(5, 2);
  points << 0, 0, 1, 0, 20, 0, 0, 50, 1e-13, 50;
  const Perturbation<double> balls(Metric<double>::from_points(points, Norm::l1), 1.0);
  const Check lemma = examine(mdp, balls, {.reading = Reading::paper}).check(ClaimId::lemma_1);
  EXPECT_EQ(lemma.verdict, Verdict::violated);
  EXPECT_NEAR(lemma.left, 21, 1e-9);
  EXPECT_EQ(lemma.right, 1);
}

}  // namespace
}  // namespace maximin
