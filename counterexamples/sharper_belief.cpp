#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/proofs_check/certificate/belief_positions.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  enum : State { low, high, states };
  enum : Action { reset, gamble, collect, actions };
  FiniteMdpBuilder<Rational> b(states, actions, Rational(1, 2));
  b.transition(low, reset, low, 1).transition(high, reset, low, 1).reward(high, reset, -1);
  b.transition(low, gamble, low, Rational(1, 2)).transition(low, gamble, high, Rational(1, 2));
  b.transition(high, gamble, high, 1).reward(high, gamble, -2);
  b.transition(low, collect, low, 1).transition(high, collect, high, 1).reward(low, collect, -2);
  b.reward(high, collect, 1);
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = Rational(1);
  model.name = "sharper-belief";
  model.state_names = {"low", "high"};
  model.action_names = {"reset", "gamble", "collect"};
  return model;
}

/// What the maximin policy of Q* is worth against the strongest attacker, by what it is taken over.
struct Worths {
  Values<Rational> ball;    ///< the ball of what is seen
  Values<Rational> belief;  ///< the exact belief, which is a part of that ball
};

Values<Rational> worth_on_ball(const Model<Rational>& model, const ExactGeometry& geometry, const QTable<Rational>& q,
                               TieBreak tie) {
  Policy policy;
  std::vector<Rational> scratch;
  maximin_policy(q, geometry.balls(), policy, scratch, MinAggregator{}, tie);
  return evaluate_against_optimal_attack(model.mdp, geometry.balls(), policy).v;
}

Worths worths(const Model<Rational>& model, TieBreak tie) {
  const ExactGeometry geometry(model);
  SolverOptions solver;
  solver.tie = tie;
  const QTable<Rational> q = policy_iteration(model.mdp, solver).q;
  const auto game = certify_belief_game(model.mdp, geometry, q, {.tie = tie});
  if (!game || !game->exact)
    throw BudgetExhausted("sharper-belief: too many beliefs for exact values, expected a smaller model");
  return {worth_on_ball(model, geometry, q, tie), start_values(*game, geometry.balls())};
}

/// The state from which the exact belief loses most.
State most_hurt(const Worths& w) {
  Eigen::Index s = 0;
  (w.ball - w.belief).maxCoeff(&s);
  return static_cast<State>(s);
}

bool hurts(const Worths& w, State s) {
  return w.belief[s] < w.ball[s];
}

Counterexample::Finding check(const Model<Rational>& model) {
  const Worths low = worths(model, TieBreak::lowest_index), high = worths(model, TieBreak::highest_index);
  const State s = most_hurt(low);
  return {{fmt::format("worst case of maximin on the ball, from state {}, at least", model.state_name(s)), low.ball[s]},
          {fmt::format("worst case of maximin on the exact belief, from state {}", model.state_name(s)), low.belief[s]},
          hurts(low, s) && hurts(high, s),
          {fmt::format("on the ball: {}", exact_text(model, low.ball)),
           fmt::format("on the exact belief: {}", exact_text(model, low.belief)),
           fmt::format("the same with the other tie-break: {}",
                       low.ball == high.ball && low.belief == high.belief ? "yes" : "no")}};
}

bool searched(const Model<Rational>& model) {
  const Worths low = worths(model, TieBreak::lowest_index);
  const State s = most_hurt(low);
  return hurts(low, s) && hurts(worths(model, TieBreak::highest_index), s);
}

}  // namespace

Counterexample sharper_belief() {
  return {
      .name = "sharper-belief",
      .title = "A sharper belief can hurt",
      .claim =
          "Maximin of Q* over the exact belief is worth no less, against the strongest attacker, than maximin of Q* "
          "over "
          "the whole ball of what is seen.",
      .explanation =
          "low and high look alike. In doubt maximin resets, which is never terrible; on the ball it is always in "
          "doubt,\n"
          "resets for ever, and is worth 0 from low. With a belief it knows after a reset that it is low, and gambles, "
          "for\n"
          "Q*(low, gamble) = 2/3 > Q*(low, reset) = 1/3. But Q* counts on collecting when the coin says high, and the "
          "agent\n"
          "does not see how it fell: in doubt again it resets, which costs 1 when high. Knowing more now, it trusts a "
          "Q*\n"
          "that knows more later than it will; this loses 1/6 from either state. (F bounds the loss against V* all the "
          "same.)\n"
          "Smallest: 2 x 3 is the least shape with two states. With 2 x 2, balls of one state make no difference, and "
          "if\n"
          "the two look alike and maximin plays a in doubt, the belief departs from a in one state only, where the "
          "other\n"
          "action is better for Q*, and then, by policy improvement, for the value of always playing a too: it never\n"
          "loses, whatever the numbers. Among 2 x 3 no model of the search's family with less |R| and moves does it.\n"
          "With 3 x 2 there are some without chance: search sharper-belief --seed 1.",
      .model = model,
      .check = check,
      .searched = searched,
  };
}

}  // namespace maximin
