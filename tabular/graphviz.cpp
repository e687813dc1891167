#include <maximin/tabular/graphviz.hpp>

#include <algorithm>
#include <map>
#include <ostream>
#include <utility>

#include <fmt/format.h>
#include <boost/graph/adjacency_list.hpp>
#include <boost/graph/graphviz.hpp>

namespace maximin::internal {
namespace {

struct Attributes {
  std::string text;  // as it stands between the brackets
};
// Bidirectional, because it then keeps a list of its edges; the iterator over those of a directed list trips g++
// warnings.
using Drawing = boost::adjacency_list<boost::vecS, boost::vecS, boost::bidirectionalS, Attributes, Attributes>;
using Node = boost::graph_traits<Drawing>::vertex_descriptor;

/// The text inside a quoted Graphviz string that shows `text` as it is.
std::string escape(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '"' || c == '\\') escaped += '\\';
    if (c == '\n') {
      escaped += "\\n";
    } else if (c != '\r') {
      escaped += c;
    }
  }
  return escaped;
}

void check_length(const char* what, std::size_t length, std::size_t expected) {
  if (length == 0 || length == expected) return;
  throw InputError(fmt::format("graphviz: {} {}, expected none or {}", length, what, expected));
}

/// Builds the drawing: nodes 0 to |S|-1 are the states, the others the actions that draw their successor.
class Artist {
 public:
  Artist(State states, Action actions, const GraphvizOptions& options)
      : options_(options), graph_(static_cast<std::size_t>(states)) {
    check_length("state names", options.state_names.size(), static_cast<std::size_t>(states));
    check_length("action names", options.action_names.size(), static_cast<std::size_t>(actions));
    check_length("values", options.values.size(), static_cast<std::size_t>(states));
    check_length("actions in the policy", options.policy.size(), static_cast<std::size_t>(states));
    for (State s = 0; s < states; ++s) draw_state(s);
  }

  void draw(const DrawnAction& d) {
    if (d.arrows.size() == 1) {
      const auto key = std::pair{d.state, d.arrows.front().target};
      auto& arrow = plain_arrows_[key];
      arrow.label += (arrow.label.empty() ? "" : "\\n") + action_label(d);
      arrow.bold = arrow.bold || chosen(d);
      return;
    }
    const std::string style = chosen(d) ? ", style=bold, color=\"#0b5394\"" : "";
    const Node node = add_vertex(Attributes{fmt::format("shape=box, height=0.2, width=0.2, fontsize=10, label=\"{}\"{}",
                                                        action_label(d), style)},
                                 graph_);
    add_edge(static_cast<Node>(d.state), node, Attributes{"arrowhead=none" + style}, graph_);
    for (const auto& arrow : d.arrows) {
      add_edge(node, static_cast<Node>(arrow.target),
               Attributes{fmt::format("fontsize=10, label=\"{}\"{}", escape(arrow.probability), style)}, graph_);
    }
  }

  void write(std::ostream& out) {
    for (const auto& [ends, arrow] : plain_arrows_) {
      add_edge(static_cast<Node>(ends.first), static_cast<Node>(ends.second),
               Attributes{fmt::format("fontsize=10, label=\"{}\"{}", arrow.label,
                                      arrow.bold ? ", style=bold, color=\"#0b5394\"" : "")},
               graph_);
    }
    const auto attributes = [this](std::ostream& o, const auto& item) { o << " [" << graph_[item].text << "]"; };
    const auto header = [this](std::ostream& o) {
      o << "rankdir=LR;\n";
      if (!options_.title.empty()) o << "label=\"" << escape(options_.title) << "\";\n";
    };
    boost::write_graphviz(out, graph_, attributes, attributes, header);
  }

 private:
  struct PlainArrow {
    std::string label;
    bool bold = false;
  };

  void draw_state(State s) {
    const auto i = static_cast<std::size_t>(s);
    std::string label = escape(options_.state_names.empty() ? std::to_string(s) : options_.state_names[i]);
    if (!options_.values.empty()) label += "\\n" + drawn_number(options_.values[i]);
    const auto& marked = options_.highlighted;
    const bool fill = std::find(marked.begin(), marked.end(), s) != marked.end();
    graph_[i].text =
        fmt::format("shape=ellipse, label=\"{}\"{}", label, fill ? ", style=filled, fillcolor=\"#cfe2f3\"" : "");
  }

  bool chosen(const DrawnAction& d) const {
    return !options_.policy.empty() && options_.policy[static_cast<std::size_t>(d.state)] == d.action;
  }

  /// Escaped, with the reward.
  std::string action_label(const DrawnAction& d) const {
    const auto& names = options_.action_names;
    std::string label =
        names.empty() ? "a" + std::to_string(d.action) : escape(names[static_cast<std::size_t>(d.action)]);
    if (!d.reward.empty()) label += ": " + escape(d.reward);
    return label;
  }

  const GraphvizOptions& options_;
  Drawing graph_;
  std::map<std::pair<State, State>, PlainArrow> plain_arrows_;
};

}  // namespace

std::string drawn_number(double x) {
  return fmt::format("{:.6g}", x);
}

void write_graphviz(std::ostream& out, State states, Action actions, const std::vector<DrawnAction>& drawn,
                    const GraphvizOptions& options) {
  Artist artist(states, actions, options);
  for (const auto& d : drawn) artist.draw(d);
  artist.write(out);
}

}  // namespace maximin::internal
