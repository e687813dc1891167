#include <maximin/models/files/gymnasium_json.hpp>

#include <array>
#include <map>
#include <utility>

#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/files/internal/model_assembly.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace internal {

namespace {

constexpr std::array<std::string_view, 5> known_members = {"name", "nS", "nA", "initial_distribution", "P"};
constexpr std::string_view entry_form = "[probability, next state, reward, terminated]";

template <class Scalar>
class GymnasiumReader {
 public:
  GymnasiumReader(const JsonDocument& document, const ReadOptions& options)
      : document_(document), options_(options), root_(document.root().object("a gymnasium table")) {}

  Model<Scalar> read() {
    root_.require_known_members(known_members);
    read_sizes();
    const JsonValue table = indexed(root_.member("P", "P[state][action], lists of " + std::string(entry_form)),
                                    "one member per state", states_);
    if (ends_somewhere_) ++states_;
    ModelAssembly<Scalar> assembly(document_, options_.limits, to_state(states_), to_state(actions_),
                                   Scalar(1) / Scalar(1'000'000'000));
    std::size_t s = 0;
    for (const JsonValue actions : table) {
      std::size_t a = 0;
      for (const JsonValue row : indexed(actions, "one member per action", actions_)) {
        read_row(row, to_state(s), to_state(a++), assembly);
      }
      ++s;
    }
    if (ends_somewhere_) add_terminal(assembly, table.at());
    std::vector<std::string> notes;
    const Scalar discount = choose_discount<Scalar>(document_, options_, std::nullopt, 0, notes);
    Model<Scalar> model{std::move(assembly).build(discount, table.at(), notes), {}, {}, {}, {}, {}, {}};
    if (const auto name = root_.find("name")) model.name = name->string("a name");
    if (ends_somewhere_) {
      for (std::size_t i = 0; i + 1 < states_; ++i) model.state_names.push_back(std::to_string(i));
      model.state_names.emplace_back("terminal");
      notes.push_back(
          fmt::format("terminated: entries that end the episode lead to the added state {}, 'terminal', "
                      "which absorbs at reward 0",
                      states_ - 1));
    }
    model.start = read_start();
    model.notes = std::move(notes);
    return model;
  }

 private:
  static State to_state(std::size_t i) { return static_cast<State>(i); }

  /// The rows must back the counts before anything is allocated for them.
  void read_sizes() {
    const JsonValue states = root_.member("nS", "the number of states");
    states_ = states.count("number of states");
    actions_ = root_.member("nA", "the number of actions").count("number of actions");
    require_size(document_, states.at(), states_, actions_, options_.limits);
    const JsonValue table = indexed(root_.member("P", "P[state][action], lists of " + std::string(entry_form)),
                                    "one member per state", states_);
    for (const JsonValue actions : table) {
      for (const JsonValue row : indexed(actions, "one member per action", actions_)) {
        for (const JsonValue entry : row.array("a list of " + std::string(entry_form))) {
          if (terminated(entry)) ends_somewhere_ = true;
        }
      }
    }
  }

  /// An array of `size` elements, or an object whose members are named "0", "1", ... in order.
  JsonValue indexed(const JsonValue& value, std::string_view name, std::size_t size) const {
    if (value.kind() != JsonValue::Kind::object) return value.array(name, size);
    if (value.size() != size) value.fail(fmt::format("length {}, expected {}: {}", value.size(), size, name));
    std::size_t i = 0;
    for (const JsonValue member : value) {
      if (member.key() != std::to_string(i)) member.fail(fmt::format("out of order, expected the name \"{}\"", i));
      ++i;
    }
    return value;
  }

  static bool terminated(const JsonValue& entry) {
    auto field = entry.array(entry_form, 4).begin();
    for (int i = 0; i < 3; ++i) ++field;
    return (*field).boolean("whether the episode ends");
  }

  void read_row(const JsonValue& row, State s, Action a, ModelAssembly<Scalar>& assembly) const {
    std::map<State, Scalar> merged;
    WeightedMean<Scalar> reward;
    for (const JsonValue entry : row) {
      auto field = entry.begin();
      const auto p = (*field).template number<Scalar>("probability");
      if (!(p >= Scalar(0))) entry.fail(fmt::format("probability {}: negative, expected 0 to 1", (*field).text()));
      ++field;
      const std::size_t original = states_ - (ends_somewhere_ ? 1 : 0);
      auto target = static_cast<State>((*field).index("state", original));
      ++field;
      reward.add(p, (*field).template number<Scalar>("reward"));
      if (terminated(entry)) target = to_state(states_ - 1);
      const auto [place, fresh] = merged.try_emplace(target, p);
      if (!fresh) place->second += p;
    }
    for (const auto& [target, p] : merged) assembly.transition(s, a, target, p, row.at());
    assembly.reward(s, a, reward.value());
  }

  void add_terminal(ModelAssembly<Scalar>& assembly, std::size_t at) const {
    const State terminal = to_state(states_ - 1);
    for (std::size_t a = 0; a < actions_; ++a) assembly.transition(terminal, to_state(a), terminal, Scalar(1), at);
  }

  std::vector<Scalar> read_start() const {
    const auto list = root_.find("initial_distribution");
    if (!list) return {};
    std::vector<Scalar> start;
    const std::size_t original = states_ - (ends_somewhere_ ? 1 : 0);
    Scalar sum(0);
    for (const JsonValue p : list->array("one probability per state", original)) {
      start.push_back(p.template number<Scalar>("probability"));
      if (start.back() < Scalar(0))
        p.fail(fmt::format("probability {}: negative, expected 0 to 1", in_quotes(p.text())));
      sum += start.back();
    }
    if (const auto defect = defect_of(sum)) {
      // Dumped as floats: 1/300 three hundred times is 1 only to rounding.
      if (!(*defect <= Scalar(Scalar(1) / Scalar(1'000'000'000)))) list->fail(wrong_sum(document_, sum));
      for (Scalar& p : start) p = Scalar(p / sum);
    }
    start.resize(states_, Scalar(0));
    return start;
  }

  const JsonDocument& document_;
  const ReadOptions& options_;
  JsonValue root_;
  std::size_t states_ = 0;
  std::size_t actions_ = 0;
  bool ends_somewhere_ = false;
};

}  // namespace

template <class Scalar>
Model<Scalar> read_gymnasium_json(const JsonDocument& document, const ReadOptions& options) {
  return GymnasiumReader<Scalar>(document, options).read();
}

template Model<double> read_gymnasium_json(const JsonDocument&, const ReadOptions&);
template Model<Rational> read_gymnasium_json(const JsonDocument&, const ReadOptions&);

}  // namespace internal

template <class Scalar>
Model<Scalar> read_gymnasium_json(std::string_view text, std::string_view file_name, const ReadOptions& options) {
  const internal::JsonDocument document(text, file_name);
  return internal::read_gymnasium_json<Scalar>(document, options);
}

template Model<double> read_gymnasium_json(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_gymnasium_json(std::string_view, std::string_view, const ReadOptions&);

}  // namespace maximin
