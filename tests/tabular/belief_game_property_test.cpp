#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_game.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>

#include "random_tables.hpp"
#include "reference.hpp"

namespace maximin {
namespace {

/// Some policy on beliefs, without rhyme or reason.
BeliefPolicy whimsical_policy(Action actions, std::uint64_t seed) {
  return [actions, seed](std::span<const State> belief) {
    std::uint64_t members = 0;
    for (const State s : belief) members |= std::uint64_t{1} << s;
    return Stream(seed, members).below(actions);
  };
}

BeliefPolicy maximin_or_whim(const FiniteMdp<double>& mdp, Stream& rng) {
  if (rng.chance(0.5)) return maximin_belief_policy(policy_iteration(mdp).q);
  return whimsical_policy(mdp.actions(), rng());
}

/// Where every state may follow every other, the belief is the ball: history is worth nothing.
RC_GTEST_PROP(BeliefGame, WithoutNewsIsTheOptimalAttackOnTheStationaryPolicy,
              (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto mdp = altered(model.mdp, model.mdp.discount(), 0.25);
  const auto balls = make_perturbation(model);
  const auto policy = maximin_or_whim(mdp, rng);
  const auto game = solve_belief_game(mdp, balls, policy);
  const auto stationary = evaluate_against_optimal_attack(mdp, balls, stationary_policy_of(balls, policy));
  RC_ASSERT((game.v - stationary.v).cwiseAbs().maxCoeff() <= game.error + stationary.error);
  RC_ASSERT(game.reach <= 2 * balls.radius());
}

/// Where nothing is confused, the belief is the truth: the value of a policy that sees it.
RC_GTEST_PROP(BeliefGame, OfTrivialBallsIsThePolicysValue, (const FiniteMdp<double>& mdp, std::uint64_t seed)) {
  Stream rng(seed);
  const Perturbation<double> alone(Metric<double>::discrete(mdp.states()), 0);
  const auto policy = maximin_or_whim(mdp, rng);
  const auto game = solve_belief_game(mdp, alone, policy);
  const auto value = reference::values_of(mdp, stationary_policy_of(alone, policy));
  const auto off = (game.v.cast<long double>() - value).cwiseAbs().maxCoeff();
  RC_ASSERT(off <= static_cast<long double>(game.error) + 1e-15L * reference::scale(mdp));
  RC_ASSERT(game.reach == 0);
  RC_ASSERT(game.positions == mdp.states());
  RC_ASSERT(game.mean_size == 1);
}

/// The game for a few steps by its rules, with sets, from the root down.
class FewSteps {
 public:
  FewSteps(const FiniteMdp<double>& mdp, const Perturbation<double>& balls, const BeliefPolicy& policy)
      : mdp_(mdp), balls_(balls), policy_(policy) {}

  /// The worst that the attacker can do when `truth` is true, `possible` is what the agent holds possible before it
  /// sees anything, and `left` steps are left.
  double attacked(State truth, const std::set<State>& possible, int left) {
    double worst = INFINITY;
    for (const State shown : balls_.ball(truth)) {
      Belief belief;
      for (const State m : possible) {
        if (balls_.contains(shown, m)) belief.push_back(m);
      }
      worst = std::min(worst, played(truth, belief, left));
    }
    return worst;
  }

 private:
  double played(State truth, const Belief& belief, int left) {
    if (left == 0) return 0;
    const auto [known, is_new] = known_.try_emplace({truth, belief, left}, 0.0);
    if (!is_new) return known->second;
    const Action a = policy_(belief);
    std::set<State> possible;
    for (const State m : belief) {
      for (const auto& next : mdp_.successors(m, a)) possible.insert(next.target);
    }
    double value = mdp_.reward(truth, a);
    for (const auto& next : mdp_.successors(truth, a)) {
      value += mdp_.discount() * next.probability * attacked(next.target, possible, left - 1);
    }
    return known_[{truth, belief, left}] = value;
  }

  const FiniteMdp<double>& mdp_;
  const Perturbation<double>& balls_;
  const BeliefPolicy& policy_;
  std::map<std::tuple<State, Belief, int>, double> known_;
};

RC_GTEST_PROP(BeliefGame, AgreesWithItsRulesPlayedOut, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  constexpr int horizon = 9;
  const auto mdp = altered(model.mdp, 0.1, 0);
  const auto balls = make_perturbation(model);
  const auto policy = maximin_or_whim(mdp, rng);
  const auto game = solve_belief_game(mdp, balls, policy);
  std::set<State> everything;
  for (State s = 0; s < mdp.states(); ++s) everything.insert(s);
  FewSteps rules(mdp, balls, policy);
  const double left_over = 2e-9 * static_cast<double>(reference::scale(mdp));
  for (State s = 0; s < mdp.states(); ++s) {
    RC_ASSERT(std::abs(game.v[s] - rules.attacked(s, everything, horizon)) <= left_over + game.error);
  }
  RC_TAG(game.positions > mdp.states() ? "several beliefs per state" : "one");
}

/// What is reported of the positions is what they say themselves, each of them sound.
RC_GTEST_PROP(BeliefGame, ReachAndSizeAreThoseOfItsPositions, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto game = solve_belief_game(model.mdp, balls, maximin_or_whim(model.mdp, rng), {.keep_positions = true});
  double reach = 0, members = 0;
  std::set<Belief> beliefs;
  for (const auto& [position, value] : game.w) {
    const auto& [truth, belief] = position;
    RC_ASSERT(std::binary_search(belief.begin(), belief.end(), truth));
    for (const State m : belief) reach = std::max(reach, balls.metric().distance(truth, m));
    members += static_cast<double>(belief.size());
    beliefs.insert(belief);
  }
  const auto positions = static_cast<double>(game.w.size());
  RC_ASSERT(game.positions == static_cast<long>(game.w.size()));
  RC_ASSERT(game.beliefs == static_cast<long>(beliefs.size()));
  RC_ASSERT(game.reach == reach);
  RC_ASSERT(std::abs(game.mean_size - members / positions) <= 1e-12 * game.mean_size);
}

/// V* belongs to an agent that sees the truth and meets no attacker.
RC_GTEST_PROP(BeliefGame, IsNoMoreThanTheOptimalValue, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const auto policy = maximin_or_whim(model.mdp, rng);
  const auto game = solve_belief_game(model.mdp, balls, policy);
  const auto best = policy_iteration(model.mdp);
  RC_ASSERT((game.v - best.v).maxCoeff() <= game.error + best.error);
}

}  // namespace
}  // namespace maximin
