// The optimal attack against every stationary attack there is, on models small enough to try them all.

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <maximin/models/arbitrary_mdp.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/theory/policies.hpp>

#include "random_tables.hpp"
#include "reference.hpp"

namespace maximin {
namespace {

/// Calls visit(attack) with every omega that shows a state of B(s) in s.
template <class Visit>
void for_each_attack(const Perturbation<double>& balls, Visit visit) {
  const auto n = static_cast<std::size_t>(balls.states());
  std::vector<std::size_t> shown(n, 0);
  AttackPolicy attack(n);
  for (;;) {
    for (std::size_t s = 0; s < n; ++s) attack[s] = balls.ball(static_cast<State>(s))[shown[s]];
    visit(attack);
    std::size_t s = 0;
    while (s < n && ++shown[s] == balls.ball(static_cast<State>(s)).size()) shown[s++] = 0;
    if (s == n) return;
  }
}

RC_GTEST_PROP(OptimalAttack, IsTheLeastOfAllStationaryAttacks, ()) {
  const auto model = *rc::gen::resize(30, arbitrary_model());  // up to four states: at most 256 attacks
  Stream rng(*rc::gen::arbitrary<std::uint64_t>());
  const auto& mdp = model.mdp;
  const auto balls = make_perturbation(model);
  const Policy policy = random_policy(mdp, rng);
  const auto found = evaluate_against_optimal_attack(mdp, balls, policy);
  const auto slack = static_cast<long double>(found.error) + 1e-15L * reference::scale(mdp);
  Values<long double> least = Values<long double>::Constant(mdp.states(), INFINITY);
  Policy composed;
  for_each_attack(balls, [&](const AttackPolicy& attack) {
    compose(policy, attack, composed);
    least = least.cwiseMin(reference::values_of(mdp, composed));
  });
  const Values<long double> difference = found.v.cast<long double>() - least;
  RC_ASSERT(difference.maxCoeff() <= slack);   // no stationary attack is stronger, from any start
  RC_ASSERT(difference.minCoeff() >= -slack);  // nor does it claim more than any attack attains
  RC_TAG(balls.largest_ball() > 1 ? "several disguises" : "none");
}

}  // namespace
}  // namespace maximin
