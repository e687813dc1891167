#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <maximin/theory/error.hpp>
#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/types.hpp>

/// The transition graph of a model: an arc s -> s' wherever P(s'|s,a) > 0 for some action. Numbers are gone, shape is
/// left, and questions of shape are answered here by Boost.Graph.
namespace maximin {

/// The arcs of a directed graph on the states: adjacency[s] holds the heads of the arcs out of s, ascending, each once.
using Adjacency = std::vector<std::vector<State>>;

namespace internal {

inline void sort_unique(std::vector<State>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace internal

/// s -> s' where P(s'|s,a) > 0 for some action a: where the agent can go. Loops s -> s included.
template <class Scalar>
Adjacency transition_graph(const FiniteMdp<Scalar>& mdp) {
  Adjacency graph(static_cast<std::size_t>(mdp.states()));
  for (State s = 0; s < mdp.states(); ++s) {
    auto& heads = graph[static_cast<std::size_t>(s)];
    for (Action a = 0; a < mdp.actions(); ++a) {
      for (const auto& next : mdp.successors(s, a)) heads.push_back(next.target);
    }
    internal::sort_unique(heads);
  }
  return graph;
}

/// s -> s' where P(s'|s,action[s]) > 0: where an agent goes that does action[s] in the true state s (pi o omega, if it
/// is attacked).
template <class Scalar>
Adjacency transition_graph(const FiniteMdp<Scalar>& mdp, const Policy& action) {
  Adjacency graph(static_cast<std::size_t>(mdp.states()));
  for (State s = 0; s < mdp.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    for (const auto& next : mdp.successors(s, action[i])) graph[i].push_back(next.target);
  }
  return graph;
}

/// The graph with every arc made to run both ways.
Adjacency undirected(const Adjacency& graph);

/// The states that some start reaches by zero or more arcs, ascending. Throws InputError on a start that is no state.
std::vector<State> reachable_states(const Adjacency& graph, std::span<const State> starts);

/// The strongly connected components of a graph, numbered in solving order: every arc leads to the same or to an
/// earlier component, so that the values a component depends on are known when its turn comes.
struct StrongComponents {
  std::vector<State> component;             ///< of each state
  std::vector<std::vector<State>> members;  ///< of each component, ascending

  State count() const { return static_cast<State>(members.size()); }
};

/// Tarjan's algorithm, O(states + arcs).
StrongComponents strong_components(const Adjacency& graph);

/// Number of arcs on the shortest path from `source` to each state, -1 where none leads.
std::vector<State> hops_from(const Adjacency& graph, State source);

/// Calls row(source, hops) with hops = hops_from(graph, source) for every source in turn.
void for_each_hops(const Adjacency& graph, const std::function<void(State, std::span<const State>)>& row);

/// The largest model that `hop_distances` takes: its answer is a |S| x |S| matrix.
inline constexpr State max_hop_states = 10'000;

/// Hops between states in the transition graph with arcs made to run both ways, |S| x |S|: a metric, for
/// `Metric::from_shortest_paths`. Infinity where no path leads; for a scalar without infinity, |S|, which no path
/// attains. Throws InputError above `max_hop_states` states.
template <class Scalar>
QTable<Scalar> hop_distances(const FiniteMdp<Scalar>& mdp) {
  const State n = mdp.states();
  if (n > max_hop_states) {
    throw InputError("hop distances: " + std::to_string(n) + " states, expected at most " +
                     std::to_string(max_hop_states) + "; give points and a norm instead");
  }
  const Scalar unreachable =
      std::numeric_limits<Scalar>::has_infinity ? Scalar(std::numeric_limits<Scalar>::infinity()) : Scalar(n);
  QTable<Scalar> distances(n, n);
  for_each_hops(undirected(transition_graph(mdp)), [&](State s, std::span<const State> hops) {
    for (State t = 0; t < n; ++t) {
      const State h = hops[static_cast<std::size_t>(t)];
      distances(s, t) = h < 0 ? unreachable : Scalar(h);
    }
  });
  return distances;
}

}  // namespace maximin
