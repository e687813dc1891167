#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include <maximin/models/files/cassandra.hpp>
#include <maximin/models/files/internal/cassandra_tokens.hpp>
#include <maximin/models/files/internal/number.hpp>

namespace maximin {

namespace {

using internal::number_text;

/// Whether the grammar has room for the name.
bool writable(const std::string& name) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const auto inside = [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
  return !name.empty() && letter(name.front()) && std::all_of(name.begin(), name.end(), inside) &&
         !internal::is_reserved_in_cassandra(name);
}

/// The names, or their number where there are none that can be written.
std::string names_or_count(const std::vector<std::string>& names, std::int32_t count) {
  if (names.empty() || !std::all_of(names.begin(), names.end(), writable)) return std::to_string(count);
  return fmt::format("{}", fmt::join(names, " "));
}

}  // namespace

template <class Scalar>
void write_cassandra(const Model<Scalar>& model, std::ostream& out) {
  const FiniteMdp<Scalar>& mdp = model.mdp;
  out << "discount: " << number_text(mdp.discount()) << "\nvalues: reward\n"
      << "states: " << names_or_count(model.state_names, mdp.states()) << '\n'
      << "actions: " << names_or_count(model.action_names, mdp.actions()) << '\n';
  if (!model.start.empty()) {
    out << "start:";
    for (const Scalar& p : model.start) out << ' ' << number_text(p);
    out << '\n';
  }
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      out << '\n';
      for (const auto& next : mdp.successors(s, a)) {
        out << "T: " << a << " : " << s << " : " << next.target << ' ' << number_text(next.probability) << '\n';
      }
      if (mdp.reward(s, a) != Scalar(0)) {
        out << "R: " << a << " : " << s << " : * : * " << number_text(mdp.reward(s, a)) << '\n';
      }
    }
  }
}

template void write_cassandra(const Model<double>&, std::ostream&);

}  // namespace maximin
