#pragma once

#include <iosfwd>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// What a drawing shows besides states and arrows. Every list may be empty.
struct GraphvizOptions {
  std::string title;
  std::vector<std::string> state_names;   ///< one per state; else the index
  std::vector<std::string> action_names;  ///< one per action; else "a" and the index
  std::vector<double> values;             ///< one per state, written under its name
  Policy policy;                          ///< by true state: its actions are drawn bold
  std::vector<State> highlighted;         ///< states filled with colour, e.g. a belief
  bool rewards = true;                    ///< write R(s,a) at the action where it is not zero
};

namespace internal {

/// One (s,a) as it is drawn.
struct DrawnAction {
  struct Arrow {
    State target;
    std::string probability;
  };
  State state;
  Action action;
  std::string reward;  ///< empty: not shown
  std::vector<Arrow> arrows;
};

/// The shortest decimal that shows x to 6 digits.
std::string drawn_number(double x);

template <class Scalar>
std::string drawn_number(const Scalar& x) {
  std::ostringstream text;
  text << x;
  return text.str();
}

void write_graphviz(std::ostream& out, State states, Action actions, const std::vector<DrawnAction>& drawn,
                    const GraphvizOptions& options);

}  // namespace internal

/// The model as a Graphviz digraph, for `dot -Tsvg`. States are nodes. An action with one successor is an arrow
/// labelled with its name (actions that do the same thing share one); an action that draws its successor is a small
/// node of its own with an arrow per successor, labelled with the probability. Names may hold any character. Throws
/// InputError when a list in `options` is of the wrong length.
template <class Scalar>
void write_graphviz(std::ostream& out, const FiniteMdp<Scalar>& mdp, const GraphvizOptions& options = {}) {
  std::vector<internal::DrawnAction> drawn;
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      internal::DrawnAction d{s, a, {}, {}};
      if (options.rewards && mdp.reward(s, a) != Scalar(0)) d.reward = internal::drawn_number(mdp.reward(s, a));
      for (const auto& next : mdp.successors(s, a)) {
        d.arrows.push_back({next.target, internal::drawn_number(next.probability)});
      }
      drawn.push_back(std::move(d));
    }
  }
  internal::write_graphviz(out, mdp.states(), mdp.actions(), drawn, options);
}

}  // namespace maximin
