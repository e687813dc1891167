#include <gtest/gtest.h>

#include <limits>
#include <sstream>

#include <maximin/tabular/graphviz.hpp>
#include <maximin/tabular/transition_graph.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/random.hpp>

namespace maximin {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// 0 -> {1 or 2}, 1 <-> 2, 2 -> 3, 3 stays; 4 stays, out of reach of everything.
FiniteMdp<double> two_islands() {
  FiniteMdpBuilder<double> b(5, 2, 0.9);
  b.transition(0, 0, 1, 0.25).transition(0, 0, 2, 0.75).transition(0, 1, 1, 1);
  b.transition(1, 0, 2, 1).transition(1, 1, 2, 1);
  b.transition(2, 0, 1, 1).transition(2, 1, 3, 1);
  b.transition(3, 0, 3, 1).transition(3, 1, 3, 1);
  b.transition(4, 0, 4, 1).transition(4, 1, 4, 1);
  b.reward(2, 1, 1.5);
  return std::move(b).build();
}

/// A random graph of n states with about `arcs` arcs per state.
Adjacency random_graph(State n, int arcs, Stream& rng) {
  Adjacency graph(static_cast<std::size_t>(n));
  for (auto& heads : graph) {
    for (int k = rng.below(2 * arcs + 1); k > 0; --k) heads.push_back(rng.below(n));
    internal::sort_unique(heads);
  }
  return graph;
}

/// reaches[s][t] by Warshall's closure, zero arcs included: the definition, slowly.
std::vector<std::vector<bool>> closure(const Adjacency& graph) {
  const std::size_t n = graph.size();
  std::vector<std::vector<bool>> reach(n, std::vector<bool>(n));
  for (std::size_t s = 0; s < n; ++s) {
    reach[s][s] = true;
    for (const State t : graph[s]) reach[s][static_cast<std::size_t>(t)] = true;
  }
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t s = 0; s < n; ++s) {
      for (std::size_t t = 0; t < n; ++t) reach[s][t] = reach[s][t] || (reach[s][k] && reach[k][t]);
    }
  }
  return reach;
}

std::string drawing(const FiniteMdp<double>& mdp, const GraphvizOptions& options) {
  std::ostringstream out;
  write_graphviz(out, mdp, options);
  return out.str();
}

TEST(TransitionGraph, ArcsOfAllActionsAndOfAPolicy) {
  const auto mdp = two_islands();
  EXPECT_EQ(transition_graph(mdp), (Adjacency{{1, 2}, {2}, {1, 3}, {3}, {4}}));
  EXPECT_EQ(transition_graph(mdp, Policy{1, 0, 0, 0, 0}), (Adjacency{{1}, {2}, {1}, {3}, {4}}));
}

TEST(TransitionGraph, ReachableStates) {
  const auto graph = transition_graph(two_islands());
  EXPECT_EQ(reachable_states(graph, std::vector<State>{1}), (std::vector<State>{1, 2, 3}));
  EXPECT_EQ(reachable_states(graph, std::vector<State>{4, 3}), (std::vector<State>{3, 4}));
  EXPECT_EQ(reachable_states(graph, std::vector<State>{}), (std::vector<State>{}));
  EXPECT_THROW(reachable_states(graph, std::vector<State>{5}), InputError);
  EXPECT_THROW(reachable_states(graph, std::vector<State>{-1}), InputError);
}

TEST(TransitionGraph, ComponentsComeSuccessorsFirst) {
  const auto found = strong_components(transition_graph(two_islands()));
  EXPECT_EQ(found.count(), 4);
  EXPECT_EQ(found.members[static_cast<std::size_t>(found.component[1])], (std::vector<State>{1, 2}));
  EXPECT_LT(found.component[3], found.component[2]);
  EXPECT_LT(found.component[1], found.component[0]);
}

TEST(TransitionGraph, RandomGraphsAgreeWithTheClosure) {
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Stream rng(11, trial);
    const auto graph = random_graph(rng.integer(1, 25), 1, rng);
    const auto reach = closure(graph);
    const auto found = strong_components(graph);
    std::size_t members = 0;
    for (const auto& component : found.members) members += component.size();
    EXPECT_EQ(members, graph.size());
    for (std::size_t s = 0; s < graph.size(); ++s) {
      const auto reached = reachable_states(graph, std::vector<State>{static_cast<State>(s)});
      for (std::size_t t = 0; t < graph.size(); ++t) {
        EXPECT_EQ(std::binary_search(reached.begin(), reached.end(), static_cast<State>(t)), reach[s][t]);
        EXPECT_EQ(found.component[s] == found.component[t], reach[s][t] && reach[t][s]);
        if (reach[s][t]) {
          EXPECT_LE(found.component[t], found.component[s]) << "successors must come first";
        }
      }
    }
  }
}

TEST(TransitionGraph, ALongChainDoesNotExhaustTheStack) {
  constexpr State n = 300'000;
  Adjacency chain(n);
  for (State s = 0; s + 1 < n; ++s) chain[static_cast<std::size_t>(s)] = {s + 1};
  const auto found = strong_components(chain);
  EXPECT_EQ(found.count(), n);
  EXPECT_EQ(found.component[n - 1], 0);
  EXPECT_EQ(hops_from(chain, 0)[n - 1], n - 1);
}

TEST(HopDistances, AreUndirectedAndInfiniteBetweenIslands) {
  const auto d = hop_distances(two_islands());
  QTable<double> expected(5, 5);
  expected << 0, 1, 1, 2, infinity,  //
      1, 0, 1, 2, infinity,          //
      1, 1, 0, 1, infinity,          //
      2, 2, 1, 0, infinity,          //
      infinity, infinity, infinity, infinity, 0;
  EXPECT_EQ(d, expected);
  // The checking constructor accepts what the trusting one is given, and the balls are those of the metric.
  EXPECT_NO_THROW(Metric<double>::from_distances(d));
  const Perturbation<double> perturbation(Metric<double>::from_shortest_paths(d), 1);
  EXPECT_EQ(std::vector<State>(perturbation.ball(3).begin(), perturbation.ball(3).end()), (std::vector<State>{2, 3}));
}

TEST(HopDistances, RefuseAModelTooLargeForAMatrix) {
  FiniteMdpBuilder<double> b(max_hop_states + 1, 1, 0.5);
  for (State s = 0; s <= max_hop_states; ++s) b.transition(s, 0, s, 1);
  const auto mdp = std::move(b).build();
  EXPECT_THROW(hop_distances(mdp), InputError);
}

TEST(Graphviz, DrawsStatesActionsAndProbabilities) {
  const std::string dot = drawing(two_islands(), {});
  EXPECT_NE(dot.find("digraph"), std::string::npos);
  EXPECT_NE(dot.find("5 [shape=box, height=0.2, width=0.2, fontsize=10, label=\"a0\"]"), std::string::npos) << dot;
  EXPECT_NE(dot.find("label=\"0.25\""), std::string::npos) << dot;
  EXPECT_NE(dot.find("2->3  [fontsize=10, label=\"a1: 1.5\"]"), std::string::npos) << dot;
  EXPECT_NE(dot.find("1->2  [fontsize=10, label=\"a0\\na1\"]"), std::string::npos) << "one arrow for both\n" << dot;
}

TEST(Graphviz, MarksThePolicyAndEscapesNames) {
  GraphvizOptions options;
  options.title = "two \"islands\"";
  options.state_names = {"a\"b", "c\\d", "e\nf", "g", "h"};
  options.values = {0, 0.5, -1, 2, 3};
  options.policy = {0, 0, 1, 0, 0};
  options.highlighted = {3};
  const std::string dot = drawing(two_islands(), options);
  EXPECT_NE(dot.find("label=\"two \\\"islands\\\"\""), std::string::npos) << dot;
  EXPECT_NE(dot.find("label=\"a\\\"b\\n0\""), std::string::npos) << dot;
  EXPECT_NE(dot.find("label=\"c\\\\d\\n0.5\""), std::string::npos) << dot;
  EXPECT_NE(dot.find("label=\"e\\nf\\n-1\""), std::string::npos) << dot;
  EXPECT_NE(dot.find("label=\"a1: 1.5\", style=bold"), std::string::npos) << dot;
  EXPECT_EQ(dot.find("label=\"a0: 1.5\""), std::string::npos);
  EXPECT_NE(dot.find("label=\"g\\n2\", style=filled"), std::string::npos) << dot;
}

TEST(Graphviz, RefusesListsOfTheWrongLength) {
  GraphvizOptions options;
  options.values = {1, 2};
  EXPECT_THROW(drawing(two_islands(), options), InputError);
}

}  // namespace
}  // namespace maximin
