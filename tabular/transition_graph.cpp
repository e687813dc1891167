#include <maximin/tabular/transition_graph.hpp>

#include <utility>

#include <boost/graph/breadth_first_search.hpp>
#include <boost/graph/compressed_sparse_row_graph.hpp>
#include <boost/graph/strong_components.hpp>

namespace maximin {
namespace {

using Graph = boost::compressed_sparse_row_graph<boost::directedS>;
using Vertex = boost::graph_traits<Graph>::vertex_descriptor;

Vertex vertex(State s) {
  return static_cast<Vertex>(s);
}

Graph to_boost(const Adjacency& adjacency) {
  std::vector<std::pair<Vertex, Vertex>> arcs;
  for (std::size_t s = 0; s < adjacency.size(); ++s) {
    for (const State t : adjacency[s]) arcs.emplace_back(s, vertex(t));
  }
  return Graph(boost::edges_are_unsorted_multi_pass, arcs.begin(), arcs.end(), adjacency.size());
}

/// Writes into `hops` the number of arcs from the root at which the search discovers each vertex.
class HopRecorder : public boost::default_bfs_visitor {
 public:
  explicit HopRecorder(std::vector<State>& hops) : hops_(&hops) {}

  void tree_edge(const boost::graph_traits<Graph>::edge_descriptor& arc, const Graph& graph) const {
    (*hops_)[target(arc, graph)] = (*hops_)[source(arc, graph)] + 1;
  }

 private:
  std::vector<State>* hops_;
};

void search(const Graph& graph, State source, std::vector<State>& hops) {
  hops.assign(num_vertices(graph), -1);
  hops[vertex(source)] = 0;
  boost::breadth_first_search(graph, vertex(source), boost::visitor(HopRecorder(hops)));
}

/// The arcs and one more vertex with an arc to each start, so that one search serves all starts.
Adjacency with_super_source(const Adjacency& graph, std::span<const State> starts) {
  Adjacency extended = graph;
  extended.emplace_back(starts.begin(), starts.end());
  return extended;
}

}  // namespace

Adjacency undirected(const Adjacency& graph) {
  Adjacency both = graph;
  for (std::size_t s = 0; s < graph.size(); ++s) {
    for (const State t : graph[s]) both[static_cast<std::size_t>(t)].push_back(static_cast<State>(s));
  }
  for (auto& heads : both) internal::sort_unique(heads);
  return both;
}

std::vector<State> hops_from(const Adjacency& graph, State source) {
  std::vector<State> hops;
  search(to_boost(graph), source, hops);
  return hops;
}

void for_each_hops(const Adjacency& graph, const std::function<void(State, std::span<const State>)>& row) {
  const Graph boosted = to_boost(graph);
  std::vector<State> hops;
  for (State s = 0; s < static_cast<State>(graph.size()); ++s) {
    search(boosted, s, hops);
    row(s, hops);
  }
}

std::vector<State> reachable_states(const Adjacency& graph, std::span<const State> starts) {
  const auto n = static_cast<State>(graph.size());
  for (const State s : starts) {
    if (s < 0 || s >= n) {
      throw InputError("start: state " + std::to_string(s) + " does not exist, expected 0 to " + std::to_string(n - 1));
    }
  }
  const std::vector<State> hops = hops_from(with_super_source(graph, starts), n);
  std::vector<State> reached;
  for (State s = 0; s < n; ++s) {
    if (hops[vertex(s)] >= 0) reached.push_back(s);
  }
  return reached;
}

StrongComponents strong_components(const Adjacency& graph) {
  StrongComponents result;
  result.component.resize(graph.size());
  const Graph boosted = to_boost(graph);
  // Tarjan's algorithm completes a component only after all that it leads to: its numbers are the solving order.
  const auto count = boost::strong_components(
      boosted, boost::make_iterator_property_map(result.component.begin(), get(boost::vertex_index, boosted)));
  result.members.resize(static_cast<std::size_t>(count));
  for (std::size_t s = 0; s < graph.size(); ++s) {
    result.members[static_cast<std::size_t>(result.component[s])].push_back(static_cast<State>(s));
  }
  return result;
}

}  // namespace maximin
