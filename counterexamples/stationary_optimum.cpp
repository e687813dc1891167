#include <algorithm>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_evaluation.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  enum : State { good, bad, states };
  enum : Action { wait, act, actions };
  FiniteMdpBuilder<Rational> b(states, actions, Rational(1, 2));
  b.reward(good, act, 1).reward(bad, act, -1);
  for (const State s : {good, bad}) {
    for (const Action a : {wait, act}) b.transition(s, a, s, 1);
  }
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = Rational(1);
  model.name = "stationary-optimum";
  model.state_names = {"good", "bad"};
  model.action_names = {"wait", "act"};
  return model;
}

/// Calls `visit` with every deterministic policy.
template <class Visit>
void for_each_policy(const FiniteMdp<Rational>& mdp, Visit visit) {
  Policy policy(static_cast<std::size_t>(mdp.states()), 0);
  for (;;) {
    visit(std::as_const(policy));
    std::size_t i = 0;
    while (i < policy.size() && ++policy[i] == mdp.actions()) policy[i++] = 0;
    if (i == policy.size()) return;
  }
}

/// Every deterministic policy with its values against the strongest attacker, and the best of them from each state.
struct Enumeration {
  std::vector<std::pair<Policy, Values<Rational>>> all;
  Values<Rational> best;

  bool some_policy_is_best_everywhere() const {
    return std::any_of(all.begin(), all.end(), [&](const auto& entry) { return entry.second == best; });
  }
};

Enumeration enumerate(const Model<Rational>& model) {
  const auto balls = make_perturbation(model);
  Enumeration result;
  for_each_policy(model.mdp, [&](const Policy& policy) {
    Values<Rational> v = evaluate_against_optimal_attack(model.mdp, balls, policy).v;
    result.best = result.all.empty() ? v : Values<Rational>(result.best.cwiseMax(v));
    result.all.emplace_back(policy, std::move(v));
  });
  return result;
}

/// A state that is in every ball: whatever is true, the attacker may show it.
std::optional<State> common_disguise(const Perturbation<Rational>& balls) {
  for (State t = 0; t < balls.states(); ++t) {
    if (static_cast<State>(balls.ball(t).size()) == balls.states()) return t;
  }
  return std::nullopt;
}

bool actions_lead_alike(const FiniteMdp<Rational>& mdp) {
  for (State s = 0; s < mdp.states(); ++s) {
    const auto first = mdp.successors(s, 0);
    for (Action a = 1; a < mdp.actions(); ++a) {
      const auto row = mdp.successors(s, a);
      if (!std::equal(first.begin(), first.end(), row.begin(), row.end())) return false;
    }
  }
  return true;
}

/// The most that sum_s V(s) can be for any policy, at random or not, where an attacker may show the same state always
/// and no action changes where one goes: the policy is then one distribution over actions, V is linear in it, and a
/// linear function on a simplex is largest in a corner. Nothing where this argument does not apply.
std::optional<Rational> most_of_any_policy(const Model<Rational>& model) {
  if (!common_disguise(make_perturbation(model)) || !actions_lead_alike(model.mdp)) return std::nullopt;
  std::optional<Rational> most;
  for (Action a = 0; a < model.mdp.actions(); ++a) {
    const Policy constant(static_cast<std::size_t>(model.mdp.states()), a);
    const Rational sum = solve_policy_values(model.mdp, constant).sum();
    most = most ? std::max(*most, sum) : sum;
  }
  return most;
}

Counterexample::Finding check(const Model<Rational>& model) {
  const Enumeration policies = enumerate(model);
  const Rational needed = policies.best.sum();
  const bool none = !policies.some_policy_is_best_everywhere();
  const auto most = most_of_any_policy(model);
  Counterexample::Finding finding{{"best values from each state, summed", needed},
                                  {"the most that one policy's values sum to", most.value_or(needed)},
                                  none && most && *most < needed,
                                  {}};
  for (const auto& [policy, v] : policies.all) {
    finding.evidence.push_back(fmt::format("policy {}: worth {}", policy_text(model, policy), exact_text(model, v)));
  }
  finding.evidence.push_back(fmt::format("of {} deterministic policies {}", policies.all.size(),
                                         none ? "none is best everywhere" : "one is best everywhere"));
  finding.evidence.push_back(most ? "policies at random: bounded by the corners of one simplex"
                                  : "policies at random: the argument does not apply, nothing is said of them");
  return finding;
}

bool searched(const Model<Rational>& model) {
  return !enumerate(model).some_policy_is_best_everywhere();
}

}  // namespace

Counterexample stationary_optimum() {
  return {
      .name = "stationary-optimum",
      .title = "No stationary policy is optimal for every initial state under attack",
      .claim = "Against the strongest attacker some stationary policy, at random or not, is optimal from every state.",
      .explanation =
          "Acting pays 1 in the good state and costs 1 in the bad one, one never leaves, and the two look alike. From "
          "the\n"
          "good state always acting is best, worth 2, the most there is; from the bad one always waiting, worth 0. "
          "One\n"
          "policy cannot do both. Deterministic policies: all four are tried. Policies at random: an attacker who "
          "always\n"
          "shows the same state makes any of them one distribution over actions, in which V is linear here, so that "
          "the\n"
          "two values sum to at most 0, not 2. (Zhang et al., 2020, show this of SA-MDPs on a larger model.)\n"
          "Smallest: with one state, or one action, some policy is always best. With 2 x 2 the claim about "
          "deterministic\n"
          "policies holds on every model of the search's family with fewer rewards and moves, by enumeration.",
      .model = model,
      .check = check,
      .searched = searched,
  };
}

}  // namespace maximin
