#include <fmt/format.h>

#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/files/internal/number.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using internal::json_string;
using internal::number_text;

/// A number as JSON: fractions go in quotes.
template <class Scalar>
std::string json_number(const Scalar& value) {
  std::string text = number_text(value);
  if (text == "-0") return "-0.0";  // an integer -0 is read as 0
  return text.find('/') == std::string::npos ? text : '"' + text + '"';
}

/// "[x, y, ...]", each element written by `text(element)`.
template <class Range, class Text>
std::string json_list(const Range& range, Text text) {
  std::string out = "[";
  for (const auto& element : range) {
    if (out.size() > 1) out += ", ";
    out += text(element);
  }
  return out + "]";
}

std::string json_strings(const std::vector<std::string>& strings) {
  return json_list(strings, [](const std::string& s) { return json_string(s); });
}

template <class Table>
std::string json_rows(const Table& table) {
  std::string out = "[\n";
  for (Eigen::Index s = 0; s < table.rows(); ++s) {
    out += s == 0 ? "    [" : ",\n    [";
    for (Eigen::Index i = 0; i < table.cols(); ++i) {
      if (i > 0) out += ", ";
      out += json_number(table(s, i));
    }
    out += "]";
  }
  return out + "\n  ]";
}

template <class Scalar>
void write_geometry(const Geometry<Scalar>& geometry, std::ostream& out) {
  using Kind = typename Geometry<Scalar>::Kind;
  switch (geometry.kind) {
    case Kind::none:
      break;
    case Kind::points:
      out << ",\n  \"norm\": " << json_string(norm_name(geometry.norm))
          << ",\n  \"points\": " << json_rows(geometry.points);
      break;
    case Kind::distances:
      out << ",\n  \"distances\": " << json_rows(geometry.distances);
      break;
    case Kind::neighbourhoods:
      out << ",\n  \"neighbourhoods\": " << json_list(geometry.neighbourhoods, [](const std::vector<State>& list) {
        return json_list(list, [](State s) { return std::to_string(s); });
      });
      break;
    case Kind::hops:
      out << ",\n  \"metric\": \"hops\"";
      break;
    case Kind::discrete:
      out << ",\n  \"metric\": \"discrete\"";
      break;
  }
  if (geometry.eps) out << ",\n  \"eps\": " << json_number(*geometry.eps);
}

template <class Scalar>
void write_transitions(const FiniteMdp<Scalar>& mdp, std::ostream& out) {
  out << ",\n  \"transitions\": [";
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      out << (s == 0 && a == 0 ? "\n    " : ",\n    ");
      bool first = true;
      for (const auto& next : mdp.successors(s, a)) {
        if (!first) out << ", ";
        first = false;
        out << '[' << s << ", " << a << ", " << next.target << ", " << json_number(next.probability) << ']';
      }
    }
  }
  out << "\n  ]";
}

}  // namespace

template <class Scalar>
void write_maximin_json(const Model<Scalar>& model, std::ostream& out) {
  const FiniteMdp<Scalar>& mdp = model.mdp;
  out << "{\n  \"format\": \"maximin-mdp\",\n  \"version\": 1";
  if (!model.name.empty()) out << ",\n  \"name\": " << json_string(model.name);
  if (!model.notes.empty()) out << ",\n  \"notes\": " << json_strings(model.notes);
  out << ",\n  \"states\": " << mdp.states() << ",\n  \"actions\": " << mdp.actions()
      << ",\n  \"discount\": " << json_number(mdp.discount());
  if (!model.state_names.empty()) out << ",\n  \"state_names\": " << json_strings(model.state_names);
  if (!model.action_names.empty()) out << ",\n  \"action_names\": " << json_strings(model.action_names);
  if (!model.start.empty()) {
    out << ",\n  \"start\": " << json_list(model.start, [](const Scalar& p) { return json_number(p); });
  }
  write_geometry(model.geometry, out);
  out << ",\n  \"rewards\": " << json_rows(mdp.rewards());
  write_transitions(mdp, out);
  out << "\n}\n";
}

template void write_maximin_json(const Model<double>&, std::ostream&);
template void write_maximin_json(const Model<Rational>&, std::ostream&);

}  // namespace maximin
