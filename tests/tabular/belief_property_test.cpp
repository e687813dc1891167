#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <set>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_update.hpp>

#include "belief_soundness.hpp"
#include "random_tables.hpp"

namespace maximin {
namespace {

constexpr int steps = 12;

bool includes(std::span<const State> large, std::span<const State> small) {
  return std::includes(large.begin(), large.end(), small.begin(), small.end());
}

Shown any_manner() {
  return *rc::gen::element(Shown::random, Shown::farthest, Shown::smallest_belief);
}

RC_GTEST_PROP(Belief, AlwaysHoldsTheTruth, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const BeliefFilter filter(model.mdp, balls);
  RC_ASSERT(keeps_the_truth(filter, model.mdp, balls, any_manner(), steps, rng));
}

/// Nested in the ball of the observation, hence within 2 eps of the truth: the rho of strengthening F.
RC_GTEST_PROP(Belief, LiesInTheBallAndWithinTwoEpsOfTheTruth, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const double two_eps = 2 * balls.radius() * (1 + 1e-12);
  const auto nested = [&](State truth, State observation, const Belief& belief) {
    return includes(balls.ball(observation), belief) && std::all_of(belief.begin(), belief.end(), [&](State m) {
             return balls.metric().distance(truth, m) <= two_eps;
           });
  };
  RC_ASSERT(keeps_the_truth(BeliefFilter(model.mdp, balls), model.mdp, balls, any_manner(), steps, rng, nested));
}

/// The update as a set comprehension over all states.
std::set<State> by_definition(const FiniteMdp<double>& mdp, const Perturbation<double>& balls, const Belief& belief,
                              Action a, State observation) {
  std::set<State> result;
  for (State next = 0; next < mdp.states(); ++next) {
    const bool reached = std::any_of(belief.begin(), belief.end(), [&](State m) {
      const auto row = mdp.successors(m, a);
      return std::any_of(row.begin(), row.end(), [&](const auto& successor) { return successor.target == next; });
    });
    if (reached && balls.contains(observation, next)) result.insert(next);
  }
  return result;
}

/// A non-empty random set of states, ascending.
Belief random_belief(State states, Stream& rng) {
  Belief belief;
  const State sure = rng.below(states);
  for (State s = 0; s < states; ++s) {
    if (s == sure || rng.chance(0.4)) belief.push_back(s);
  }
  return belief;
}

RC_GTEST_PROP(Belief, UpdateIsItsDefinition, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const Belief prior = random_belief(model.mdp.states(), rng);
  const Action a = rng.below(model.mdp.actions());
  const State observation = rng.below(model.mdp.states());
  Belief predicted, posterior;
  belief_successors(model.mdp, std::span<const State>(prior), a, predicted);
  const auto outcome = meet_observation(balls, std::span<const State>(predicted), observation, posterior);
  const auto expected = by_definition(model.mdp, balls, prior, a, observation);
  RC_ASSERT((outcome == BeliefUpdate::empty) == expected.empty());
  const auto ball = balls.ball(observation);
  const bool same = expected.empty() ? std::equal(posterior.begin(), posterior.end(), ball.begin(), ball.end())
                                     : std::equal(posterior.begin(), posterior.end(), expected.begin(), expected.end());
  RC_ASSERT(same);
  RC_TAG(expected.empty() ? "empty" : "met");
}

RC_GTEST_PROP(Belief, KnowingMoreBeforeIsKnowingMoreAfter, (const Model<double>& model, std::uint64_t seed)) {
  Stream rng(seed);
  const auto balls = make_perturbation(model);
  const Belief large = random_belief(model.mdp.states(), rng);
  Belief small;
  const State truth = large[static_cast<std::size_t>(rng.below(static_cast<int>(large.size())))];
  for (const State s : large) {
    if (s == truth || rng.chance(0.5)) small.push_back(s);
  }
  const Action a = rng.below(model.mdp.actions());
  const State next = model.mdp.successors(truth, a).front().target;
  Belief from_small, from_large, met_small, met_large;
  belief_successors(model.mdp, std::span<const State>(small), a, from_small);
  belief_successors(model.mdp, std::span<const State>(large), a, from_large);
  RC_ASSERT(includes(from_large, from_small));
  for (const State observation : balls.ball(next)) {
    RC_ASSERT(meet_observation(balls, std::span<const State>(from_small), observation, met_small) == BeliefUpdate::met);
    RC_ASSERT(meet_observation(balls, std::span<const State>(from_large), observation, met_large) == BeliefUpdate::met);
    RC_ASSERT(includes(met_large, met_small));
    RC_ASSERT(std::binary_search(met_small.begin(), met_small.end(), next));
  }
}

}  // namespace
}  // namespace maximin
