#pragma once

#include <optional>
#include <string>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/perturbation.hpp>

namespace maximin {

/// How far apart states are, as a file or a command line says it.
template <class Scalar>
struct Geometry {
  enum class Kind {
    none,            ///< nothing said
    points,          ///< `points` under `norm`
    distances,       ///< `distances`
    neighbourhoods,  ///< `neighbourhoods`: the balls themselves; eps is 1
    hops,            ///< undirected hops in the transition graph
    discrete,        ///< distance 1 between distinct states
  };
  Kind kind = Kind::none;
  typename Metric<Scalar>::Points points;  ///< |S| x d
  Norm norm = Norm::l2;
  QTable<Scalar> distances;  ///< |S| x |S|
  std::vector<std::vector<State>> neighbourhoods;
  std::optional<Scalar> eps;  ///< radius of the balls, if said
};

/// A model with what goes with it: names, start distribution, geometry, and what had to be assumed to read it.
template <class Scalar>
struct Model {
  FiniteMdp<Scalar> mdp;
  Geometry<Scalar> geometry = {};
  std::string name = {};                       ///< for people; may be empty
  std::vector<std::string> state_names = {};   ///< one per state, or empty
  std::vector<std::string> action_names = {};  ///< one per action, or empty
  std::vector<Scalar> start = {};              ///< Pr(s_0), or empty: uniform
  std::vector<std::string> notes = {};  ///< what the reader assumed or repaired, one line each, for the user to see

  /// The name of a state, or its index.
  std::string state_name(State s) const {
    return state_names.empty() ? std::to_string(s) : state_names[static_cast<std::size_t>(s)];
  }
  /// The name of an action, or its index.
  std::string action_name(Action a) const {
    return action_names.empty() ? std::to_string(a) : action_names[static_cast<std::size_t>(a)];
  }
};

}  // namespace maximin
