#include <maximin/models/files/maximin_json.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/files/internal/model_assembly.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace internal {

namespace {

constexpr std::array<std::string_view, 18> known_members = {
    "format",  "version",     "name",        "states",         "actions", "discount",
    "rewards", "transitions", "state_names", "action_names",   "start",   "points",
    "norm",    "distances",   "metric",      "neighbourhoods", "eps",     "notes",
};

/// How far probabilities may miss 1 and still be scaled, with a note.
template <class Scalar>
Scalar json_slack() {
  return Scalar(Scalar(1) / Scalar(1'000'000'000));
}

/// Reads one document; the methods follow the order of docs/model-format.md.
template <class Scalar>
class MaximinJsonReader {
 public:
  MaximinJsonReader(const JsonDocument& document, const ReadOptions& options)
      : document_(document), options_(options), root_(document.root().object("a model")) {}

  Model<Scalar> read() {
    root_.require_known_members(known_members);
    check_header();
    read_sizes();
    std::vector<std::string> notes = read_notes();
    const Scalar discount = read_discount(notes);
    ModelAssembly<Scalar> assembly(document_, options_.limits, states_, actions_, json_slack<Scalar>());
    const std::size_t at = read_transitions(assembly);
    read_rewards(assembly);
    Model<Scalar> model{std::move(assembly).build(discount, at, notes), {}, {}, {}, {}, {}, {}};
    if (const auto name = root_.find("name")) model.name = name->string("a name");
    model.state_names = read_names("state_names", static_cast<std::size_t>(states_));
    model.action_names = read_names("action_names", static_cast<std::size_t>(actions_));
    model.start = read_start(model.state_names, notes);
    model.geometry = read_geometry(notes);
    model.notes = std::move(notes);
    return model;
  }

 private:
  void check_header() const {
    const JsonValue format = root_.member("format", "\"maximin-mdp\"");
    if (format.string("\"maximin-mdp\"") != "maximin-mdp") {
      format.fail(fmt::format("format {}, expected \"maximin-mdp\"", in_quotes(format.text())));
    }
    const JsonValue version = root_.member("version", "1");
    if (version.count("version") != 1) version.fail(fmt::format("version {}, expected 1", version.text()));
  }

  void read_sizes() {
    const JsonValue states = root_.member("states", "the number of states");
    const JsonValue actions = root_.member("actions", "the number of actions");
    const std::uint64_t s = states.count("number of states"), a = actions.count("number of actions");
    if (a < 1) actions.fail("0 actions, expected at least 1");
    require_size(document_, states.at(), s, a, options_.limits);
    // Every (state, action) needs a transition, so a count that the file cannot back is refused before it is believed.
    const JsonValue transitions = root_.member("transitions", "a list of [state, action, next state, probability]")
                                      .array("a list of [state, action, next state, probability]");
    if (transitions.size() < s * a) {
      transitions.fail(
          fmt::format("{} transitions for {} states and {} actions, expected at least one for each of the "
                      "{} pairs",
                      transitions.size(), s, a, s * a));
    }
    if (transitions.size() > options_.limits.transitions) {
      transitions.fail(
          fmt::format("{} transitions, expected at most {}", transitions.size(), options_.limits.transitions));
    }
    states_ = static_cast<State>(s);
    actions_ = static_cast<Action>(a);
  }

  std::vector<std::string> read_notes() const {
    std::vector<std::string> notes;
    if (const auto list = root_.find("notes")) {
      for (const JsonValue note : list->array("a list of strings")) notes.emplace_back(note.string("a note"));
    }
    return notes;
  }

  Scalar read_discount(std::vector<std::string>& notes) const {
    const auto value = root_.find("discount");
    if (!value && !options_.discount) root_.member("discount", "a number from 0 up to but not including 1");
    std::optional<Scalar> in_file;
    if (value) in_file = value->template number<Scalar>("discount");
    return choose_discount(document_, options_, in_file, value ? value->at() : 0, notes);
  }

  std::size_t read_transitions(ModelAssembly<Scalar>& assembly) const {
    const JsonValue list = root_.member("transitions", "");
    for (const JsonValue entry : list) {
      auto field = entry.array("[state, action, next state, probability]", 4).begin();
      const auto s = static_cast<State>((*field).index("state", static_cast<std::size_t>(states_)));
      ++field;
      const auto a = static_cast<Action>((*field).index("action", static_cast<std::size_t>(actions_)));
      ++field;
      const auto target = static_cast<State>((*field).index("state", static_cast<std::size_t>(states_)));
      ++field;
      assembly.transition(s, a, target, (*field).template number<Scalar>("probability"), entry.at());
    }
    return list.at();
  }

  void read_rewards(ModelAssembly<Scalar>& assembly) const {
    const JsonValue rows = root_.member("rewards", "one row per state, one number per action");
    rows.array("one row per state", static_cast<std::size_t>(states_));
    State s = 0;
    for (const JsonValue row : rows) {
      row.array("one reward per action", static_cast<std::size_t>(actions_));
      Action a = 0;
      for (const JsonValue value : row) assembly.reward(s, a++, value.template number<Scalar>("reward"));
      ++s;
    }
  }

  std::vector<std::string> read_names(std::string_view member, std::size_t count) const {
    std::vector<std::string> names;
    const auto list = root_.find(member);
    if (!list) return names;
    std::set<std::string_view> seen;
    for (const JsonValue name : list->array("one name each", count)) {
      const std::string_view text = name.string("a name");
      if (!is_name(text))
        name.fail(fmt::format("{}: empty or with control characters, expected a name", in_quotes(text)));
      if (!seen.insert(text).second) name.fail(fmt::format("{} given twice, expected distinct names", in_quotes(text)));
      names.emplace_back(text);
    }
    return names;
  }

  std::vector<Scalar> read_start(const std::vector<std::string>& names, std::vector<std::string>& notes) const {
    const auto value = root_.find("start");
    if (!value) return {};
    const auto count = static_cast<std::size_t>(states_);
    std::vector<Scalar> start(count, Scalar(0));
    if (value->kind() == JsonValue::Kind::number) {
      start[value->index("state", count)] = Scalar(1);
      return start;
    }
    if (value->kind() == JsonValue::Kind::string) {
      const auto found = std::find(names.begin(), names.end(), value->text());
      if (found == names.end())
        value->fail(fmt::format("no state is named {}", in_quotes(value->text())) + ", expected one of state_names");
      start[static_cast<std::size_t>(found - names.begin())] = Scalar(1);
      return start;
    }
    Scalar sum(0);
    std::size_t s = 0;
    for (const JsonValue p : value->array("a state, or one probability per state", count)) {
      start[s] = p.template number<Scalar>("probability");
      if (start[s] < Scalar(0)) p.fail(fmt::format("probability {}: negative, expected 0 to 1", in_quotes(p.text())));
      sum += start[s++];
    }
    if (const auto defect = defect_of(sum)) {
      if (!(*defect <= json_slack<Scalar>())) value->fail(wrong_sum(document_, sum));
      for (Scalar& p : start) p = Scalar(p / sum);
      notes.push_back("start: summed to 1 only nearly; scaled to sum to 1");
    }
    return start;
  }

  Geometry<Scalar> read_geometry(std::vector<std::string>& notes) const {
    using Kind = typename Geometry<Scalar>::Kind;
    Geometry<Scalar> geometry;
    std::optional<JsonValue> chosen;
    for (const std::string_view member : {"points", "distances", "neighbourhoods", "metric"}) {
      const auto value = root_.find(member);
      if (!value) continue;
      if (chosen) {
        value->fail(fmt::format("given as well as '{}', expected only one of points, distances, neighbourhoods, metric",
                                chosen->key()));
      }
      chosen = value;
    }
    const auto norm = root_.find("norm");
    if (norm && !(chosen && chosen->key() == "points")) norm->fail("given without 'points', expected both or neither");
    if (chosen && chosen->key() == "points") {
      geometry.kind = Kind::points;
      geometry.points = read_points(*chosen);
      if (norm) {
        geometry.norm = read_norm(*norm);
      } else {
        notes.push_back("norm: the file gives none, l2 assumed");
      }
    } else if (chosen && chosen->key() == "distances") {
      geometry.kind = Kind::distances;
      geometry.distances = read_distances(*chosen);
    } else if (chosen && chosen->key() == "neighbourhoods") {
      geometry.kind = Kind::neighbourhoods;
      geometry.neighbourhoods = read_neighbourhoods(*chosen);
    } else if (chosen) {
      const std::string_view text = chosen->string("\"hops\" or \"discrete\"");
      if (text != "hops" && text != "discrete") {
        chosen->fail(fmt::format("metric {}, expected \"hops\" or \"discrete\"", in_quotes(text)));
      }
      geometry.kind = text == "hops" ? Kind::hops : Kind::discrete;
    }
    geometry.eps = read_eps(geometry.kind == Kind::neighbourhoods);
    return geometry;
  }

  std::optional<Scalar> read_eps(bool balls_given) const {
    const auto value = root_.find("eps");
    if (!value) return std::nullopt;
    const Scalar eps = value->template number<Scalar>("eps");
    if (eps < Scalar(0)) value->fail(fmt::format("eps {}: negative, expected eps >= 0", in_quotes(value->text())));
    if (balls_given && eps != Scalar(1)) {
      value->fail(fmt::format("eps {} with 'neighbourhoods', expected 1 or none: the lists are the balls",
                              in_quotes(value->text())));
    }
    return eps;
  }

  static Norm read_norm(const JsonValue& value) {
    const std::string_view text = value.string("\"l1\", \"l2\" or \"linf\"");
    if (text == "l1") return Norm::l1;
    if (text == "l2") return Norm::l2;
    if (text != "linf") value.fail(fmt::format("norm {}, expected \"l1\", \"l2\" or \"linf\"", in_quotes(text)));
    return Norm::linf;
  }

  typename Metric<Scalar>::Points read_points(const JsonValue& rows) const {
    rows.array("one point per state", static_cast<std::size_t>(states_));
    const std::size_t dimension = (*rows.begin()).array("a point").size();
    if (dimension == 0) (*rows.begin()).fail("no coordinates, expected at least one");
    for (const JsonValue row : rows) row.array("one coordinate per dimension", dimension);
    typename Metric<Scalar>::Points points(states_, static_cast<Eigen::Index>(dimension));
    fill(rows, "coordinate", points);
    return points;
  }

  QTable<Scalar> read_distances(const JsonValue& rows) const {
    rows.array("one row per state", static_cast<std::size_t>(states_));
    for (const JsonValue row : rows) row.array("one distance per state", static_cast<std::size_t>(states_));
    QTable<Scalar> distances(states_, states_);
    fill(rows, "distance", distances);
    told_at_root([&] { Metric<Scalar>::from_distances(distances); });
    return distances;
  }

  /// Rows are known to be as wide as the table: widths are checked before it is allocated, so that the file backs it.
  template <class Table>
  static void fill(const JsonValue& rows, std::string_view what, Table& table) {
    Eigen::Index s = 0;
    for (const JsonValue row : rows) {
      Eigen::Index i = 0;
      for (const JsonValue value : row) table(s, i++) = value.template number<Scalar>(what);
      ++s;
    }
  }

  std::vector<std::vector<State>> read_neighbourhoods(const JsonValue& rows) const {
    std::vector<std::vector<State>> lists;
    for (const JsonValue row : rows.array("one list per state", static_cast<std::size_t>(states_))) {
      auto& list = lists.emplace_back();
      for (const JsonValue t : row.array("the states of a ball")) {
        list.push_back(static_cast<State>(t.index("state", static_cast<std::size_t>(states_))));
      }
    }
    told_at_root([&] { Perturbation<Scalar>::from_neighbourhoods(lists); });
    return lists;
  }

  /// Messages of theory/ begin with the name of the member and its indices: just what a path needs.
  template <class Check>
  void told_at_root(Check check) const {
    try {
      check();
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: $.{}", document_.file(), error.what()));
    }
  }

  const JsonDocument& document_;
  const ReadOptions& options_;
  JsonValue root_;
  State states_ = 0;
  Action actions_ = 0;
};

}  // namespace

template <class Scalar>
Model<Scalar> read_maximin_json(const JsonDocument& document, const ReadOptions& options) {
  return MaximinJsonReader<Scalar>(document, options).read();
}

template Model<double> read_maximin_json(const JsonDocument&, const ReadOptions&);
template Model<Rational> read_maximin_json(const JsonDocument&, const ReadOptions&);

}  // namespace internal

template <class Scalar>
Model<Scalar> read_maximin_json(std::string_view text, std::string_view file_name, const ReadOptions& options) {
  const internal::JsonDocument document(text, file_name);
  return internal::read_maximin_json<Scalar>(document, options);
}

template Model<double> read_maximin_json(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_maximin_json(std::string_view, std::string_view, const ReadOptions&);

}  // namespace maximin
