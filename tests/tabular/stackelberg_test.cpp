#include <gtest/gtest.h>

#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/tabular/stackelberg.hpp>
#include <maximin/tabular/value_iteration.hpp>

#include "random_model.hpp"

namespace maximin {
namespace {

/// Max over pi of min over omega of the value of the pair, both enumerated: the definition, with nothing but the value
/// of a fixed pair.
Values<double> brute_force(const FiniteMdp<double>& mdp, const Perturbation<double>& perturbation) {
  const State n = mdp.states();
  const auto next = [](auto& digits, auto below) {
    for (std::size_t i = 0; i < digits.size(); ++i) {
      if (++digits[i] < below(i)) return true;
      digits[i] = 0;
    }
    return false;
  };
  Values<double> best = Values<double>::Constant(n, -1e300);
  Policy policy(static_cast<std::size_t>(n), 0);
  do {
    Values<double> worst = Values<double>::Constant(n, 1e300);
    std::vector<std::size_t> shown(static_cast<std::size_t>(n), 0);
    do {
      Policy composed;
      for (State s = 0; s < n; ++s) {
        const State t = perturbation.ball(s)[shown[static_cast<std::size_t>(s)]];
        composed.push_back(policy[static_cast<std::size_t>(t)]);
      }
      worst = worst.cwiseMin(solve_policy_values(mdp, composed));
    } while (next(shown, [&](std::size_t s) { return perturbation.ball(static_cast<State>(s)).size(); }));
    best = best.cwiseMax(worst);
  } while (next(policy, [&](std::size_t) { return mdp.actions(); }));
  return best;
}

/// Two states that look alike, gamma = 1/2. Action 0 pays 2 in state 0 and 0 in state 1, action 1 pays 0 in state 0 and
/// 1 in state 1; both keep the state. By hand: pi = (0,0) is worth (4, 0), (1,1) is worth (0, 2), and a mixed pi lets
/// the attacker pick the worse action in each state, (0, 0).
FiniteMdp<double> lookalikes() {
  FiniteMdpBuilder<double> b(2, 2, 0.5);
  for (State s = 0; s < 2; ++s) {
    for (Action a = 0; a < 2; ++a) b.transition(s, a, s, 1);
  }
  b.reward(0, 0, 2).reward(1, 1, 1);
  return std::move(b).build();
}

TEST(Stackelberg, NoPolicyIsBestForBothLookalikes) {
  const auto found = stackelberg_values(lookalikes(), line_balls(2, 1));
  EXPECT_NEAR(found.v[0], 4, 1e-11);
  EXPECT_NEAR(found.v[1], 2, 1e-11);
  EXPECT_EQ(found.best_for_state[0], (Policy{0, 0}));
  EXPECT_EQ(found.best_for_state[1], (Policy{1, 1}));
  EXPECT_EQ(found.compromise, (Policy{0, 0}));
  EXPECT_NEAR(found.shortfall, 2, 1e-11);
  EXPECT_FALSE(found.one_policy_is_best_everywhere());
  EXPECT_EQ(found.policies, 4);
  EXPECT_EQ(found.distinct, 3) << "the attacker sees no difference between (0,1) and (1,0)";
}

TEST(Stackelberg, TheBestPolicyForAStartDistribution) {
  StackelbergOptions<double> options;
  options.start = {0.25, 0.75};  // (0,0) is worth 1, (1,1) is worth 1.5
  const auto found = stackelberg_values(lookalikes(), line_balls(2, 1), options);
  ASSERT_TRUE(found.best_for_start.has_value());
  EXPECT_EQ(*found.best_for_start, (Policy{1, 1}));
  EXPECT_NEAR(found.value_for_start, 1.5, 1e-11);
  options.start = {0.5, 0.5};  // 2 against 1
  EXPECT_EQ(*stackelberg_values(lookalikes(), line_balls(2, 1), options).best_for_start, (Policy{0, 0}));
  EXPECT_FALSE(stackelberg_values(lookalikes(), line_balls(2, 1)).best_for_start.has_value());
}

TEST(Stackelberg, WithoutAttackOnePolicyIsBestEverywhere) {
  for (std::uint64_t trial = 0; trial < 20; ++trial) {
    Stream rng(31, trial);
    const auto mdp = random_model(rng.integer(2, 4), 3, rng.uniform(0.3, 0.95), rng);
    const auto found = stackelberg_values(mdp, line_balls(mdp.states(), 0));
    const auto best = value_iteration(mdp);
    EXPECT_LE((found.v - best.v).cwiseAbs().maxCoeff(), found.error + best.error);
    EXPECT_TRUE(found.one_policy_is_best_everywhere()) << found.shortfall << " > " << found.slack;
    EXPECT_EQ(found.distinct, found.policies);
  }
}

TEST(Stackelberg, AgreesWithEnumerationOfBothPlayers) {
  int without_equilibrium = 0;
  for (std::uint64_t trial = 0; trial < 40; ++trial) {
    Stream rng(32, trial);
    const auto mdp = random_model(3, rng.integer(2, 3), rng.uniform(0.3, 0.95), rng);
    const auto perturbation = line_balls(3, rng.integer(1, 2));
    const auto found = stackelberg_values(mdp, perturbation);
    EXPECT_LE((found.v - brute_force(mdp, perturbation)).cwiseAbs().maxCoeff(), found.error + 1e-12);
    for (State s = 0; s < 3; ++s) {
      const auto& policy = found.best_for_state[static_cast<std::size_t>(s)];
      EXPECT_NEAR(evaluate_against_optimal_attack(mdp, perturbation, policy).v[s], found.v[s], 2 * found.error);
    }
    EXPECT_LE(found.distinct, found.policies);
    without_equilibrium += !found.one_policy_is_best_everywhere();
  }
  EXPECT_GE(without_equilibrium, 5) << "the impossibility must be seen";
  EXPECT_LE(without_equilibrium, 35) << "and so must its absence";
}

TEST(Stackelberg, SkippedPoliciesAreWorthWhatTheirTwinIs) {
  Stream rng(33);
  const auto mdp = random_model(4, 3, 0.9, rng);
  const auto perturbation = line_balls(4, 2);
  long observed = 0;
  Values<double> best = Values<double>::Constant(4, -1e300);
  const auto found = stackelberg_values<double>(mdp, perturbation, {}, [&](const Policy&, const Values<double>& v) {
    ++observed;
    best = best.cwiseMax(v);
  });
  EXPECT_EQ(observed, found.distinct);
  EXPECT_LT(observed, found.policies);
  EXPECT_EQ(best, found.v);
  EXPECT_LE((found.v - brute_force(mdp, perturbation)).cwiseAbs().maxCoeff(), found.error + 1e-12);
}

TEST(Stackelberg, RefusesWhatIsTooLargeAndSaysHowLarge) {
  Stream rng(34);
  const auto mdp = random_model(40, 3, 0.9, rng);
  try {
    stackelberg_values(mdp, line_balls(40, 1));
    FAIL() << "3^40 policies";
  } catch (const BudgetExhausted& e) {
    EXPECT_NE(std::string(e.what()).find("3^40"), std::string::npos) << e.what();
  }
  StackelbergOptions<double> options;
  options.max_policies = 4;
  EXPECT_NO_THROW(stackelberg_values(lookalikes(), line_balls(2, 1), options));
  options.max_policies = 3;
  EXPECT_THROW(stackelberg_values(lookalikes(), line_balls(2, 1), options), BudgetExhausted);
}

TEST(Stackelberg, RefusesWhatDoesNotFit) {
  EXPECT_THROW(stackelberg_values(lookalikes(), line_balls(3, 1)), InputError);
  StackelbergOptions<double> options;
  options.start = {1};
  EXPECT_THROW(stackelberg_values(lookalikes(), line_balls(2, 1), options), InputError);
  options.start = {0.5, 0.6};
  EXPECT_THROW(stackelberg_values(lookalikes(), line_balls(2, 1), options), InputError);
  options.start = {1.5, -0.5};
  EXPECT_THROW(stackelberg_values(lookalikes(), line_balls(2, 1), options), InputError);
}

}  // namespace
}  // namespace maximin
