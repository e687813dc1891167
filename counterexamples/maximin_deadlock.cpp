#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/counterexamples/exact_text.hpp>
#include <maximin/counterexamples/gallery.hpp>
#include <maximin/models/make_perturbation.hpp>
#include <maximin/tabular/belief_update.hpp>
#include <maximin/tabular/policy_iteration.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/policies.hpp>

namespace maximin {
namespace {

Model<Rational> model() {
  enum : State { far, near, goal, states };
  enum : Action { step, enter, actions };
  FiniteMdpBuilder<Rational> b(states, actions, Rational(1, 2));
  b.transition(far, step, near, 1).transition(near, step, far, 1).transition(goal, step, goal, 1);
  b.transition(far, enter, near, 1).transition(near, enter, goal, 1).transition(goal, enter, goal, 1);
  b.reward(far, enter, -3).reward(near, enter, 8);
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::points;
  model.geometry.norm = Norm::l1;
  model.geometry.eps = Rational(1);
  model.geometry.points.resize(states, 1);
  model.geometry.points << Rational(0), Rational(1), Rational(3);
  model.name = "maximin-deadlock";
  model.state_names = {"far", "near", "goal"};
  model.action_names = {"step", "enter"};
  return model;
}

/// What an agent of Q* that nobody attacks does for ever: it comes back to a state with the same belief.
struct Walk {
  std::vector<State> states;    ///< up to and with the first that comes again
  std::size_t returns_to = 0;   ///< index of that one's first visit
  std::vector<Rational> gains;  ///< by step
  bool arrives = false;         ///< what it repeats is to stay in one state that no action leaves

  /// The discounted sum of what it gains for ever.
  Rational value(const Rational& discount) const {
    Rational sum(0), cycle(0), weight(1), start(1);
    for (std::size_t i = 0; i < gains.size(); ++i, weight *= discount) {
      if (i == returns_to) start = weight;
      (i < returns_to ? sum : cycle) += weight * gains[i];
    }
    return sum + cycle / (1 - weight / start);
  }
};

enum class Memory { none, exact_belief };

bool no_action_leaves(const FiniteMdp<Rational>& mdp, State s) {
  for (Action a = 0; a < mdp.actions(); ++a) {
    if (mdp.successors(s, a).front().target != s) return false;
  }
  return true;
}

void require_determinism(const FiniteMdp<Rational>& mdp) {
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      if (mdp.successors(s, a).size() != 1)
        throw InputError("maximin-deadlock: a transition is random, expected each action to have one successor");
    }
  }
}

/// The walk from `start` when every observation is the truth.
template <class Agg>
Walk walk(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const QTable<Rational>& q, Memory memory,
          State start, const Agg& aggregate) {
  BeliefFilter<Rational> filter(mdp, balls);
  std::vector<std::pair<State, Belief>> seen;
  std::vector<Rational> scratch;
  Walk result;
  std::pair<State, Belief> at{start, filter.reset(start)};
  for (;;) {
    const auto before = std::find(seen.begin(), seen.end(), at);
    result.states.push_back(at.first);
    if (before != seen.end()) {
      result.returns_to = static_cast<std::size_t>(before - seen.begin());
      result.arrives = no_action_leaves(mdp, at.first);
      return result;
    }
    seen.push_back(at);
    const Action a = belief_action(q, std::span<const State>(at.second), scratch, aggregate);
    result.gains.push_back(mdp.reward(at.first, a));
    at.first = mdp.successors(at.first, a).front().target;
    at.second = memory == Memory::none ? filter.reset(at.first) : filter.update(a, at.first);
  }
}

std::string walk_text(const Model<Rational>& model, const Walk& w) {
  std::string text;
  for (const State s : w.states) text += (text.empty() ? "" : ", ") + model.state_name(s);
  return text + (w.arrives ? ", where it stays" : ", and so for ever");
}

/// Both agents from every state that an action leaves.
struct Comparison {
  bool maximin_never_arrives = true;
  bool mean_always_arrives = true;
  bool mean_is_never_worse = true;
  State widest = -1;          ///< from where the mean gains most over maximin
  Rational minimum, average;  ///< values from there
  std::vector<std::string> evidence;

  bool refuted() const {
    return widest >= 0 && maximin_never_arrives && mean_always_arrives && mean_is_never_worse && minimum < average;
  }
};

Comparison compare(const Model<Rational>& model, Memory memory) {
  const auto& mdp = model.mdp;
  const auto balls = make_perturbation(model);
  const QTable<Rational> q = policy_iteration(mdp).q;
  Comparison c;
  for (State s = 0; s < mdp.states(); ++s) {
    if (no_action_leaves(mdp, s)) continue;
    const Walk minimum = walk(mdp, balls, q, memory, s, MinAggregator{}),
               average = walk(mdp, balls, q, memory, s, MeanAggregator{});
    const Rational low = minimum.value(mdp.discount()), high = average.value(mdp.discount());
    c.maximin_never_arrives = c.maximin_never_arrives && !minimum.arrives;
    c.mean_always_arrives = c.mean_always_arrives && average.arrives;
    c.mean_is_never_worse = c.mean_is_never_worse && low <= high;
    if (c.widest < 0 || high - low > c.average - c.minimum) {
      c.widest = s;
      c.minimum = low;
      c.average = high;
    }
    c.evidence.push_back(fmt::format("maximin: {}; worth {}", walk_text(model, minimum), exact_text(low)));
    c.evidence.push_back(fmt::format("mean: {}; worth {}", walk_text(model, average), exact_text(high)));
  }
  return c;
}

Counterexample::Finding check(const Model<Rational>& model) {
  require_determinism(model.mdp);
  Comparison ball = compare(model, Memory::none);
  const Comparison belief = compare(model, Memory::exact_belief);
  const std::string from = ball.widest < 0 ? "any state" : model.state_name(ball.widest);
  ball.evidence.push_back(
      fmt::format("the same with the exact belief in the place of the ball: {}", belief.refuted() ? "yes" : "no"));
  return {{fmt::format("without attack, from {}, the mean over the ball is worth", from), ball.average},
          {fmt::format("without attack, from {}, maximin is worth", from), ball.minimum},
          ball.refuted() && belief.refuted(),
          std::move(ball.evidence)};
}

}  // namespace

Counterexample maximin_deadlock() {
  return {
      .name = "maximin-deadlock",
      .title = "Maximin of a clean Q* wanders for ever, even with no attack",
      .claim =
          "When nobody attacks, maximin of Q* over the belief reaches the goal, or at least does no worse than the "
          "mean.",
      .explanation =
          "far and near look alike. Entering is right when near (8) and costs 3 when far; stepping changes sides for\n"
          "nothing. The worst of stepping is Q*(near, step) = 2, of entering Q*(far, enter) = 1: maximin steps, near "
          "to far\n"
          "to near, for ever, worth 0. Q* counts on entering next time, and next time the same doubt prevails: Q* is "
          "not\n"
          "the value of what maximin does. The exact belief does not help, for stepping maps {far, near} to itself. "
          "The\n"
          "means are 3 and 9/2: the mean enters, and arrives at the latest in the second step. Pessimism must be "
          "trained\n"
          "in, or the aggregator softened.",
      .model = model,
      .check = check,
  };
}

}  // namespace maximin
