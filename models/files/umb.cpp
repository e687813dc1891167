#include <maximin/models/files/umb.hpp>

#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/choice_table.hpp>
#include <maximin/models/files/internal/gzip.hpp>
#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/files/internal/ustar.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;

/// An array of little-endian numbers: an entry of the archive.
class UmbArray {
 public:
  UmbArray() = default;
  UmbArray(std::string_view bytes, std::size_t width) : bytes_(bytes), width_(width) {}

  std::size_t size() const { return bytes_.size() / width_; }

  std::uint64_t integer(std::size_t i) const {
    std::uint64_t value = 0;
    for (std::size_t k = width_; k-- > 0;) {
      value = (value << 8) | static_cast<unsigned char>(bytes_[i * width_ + k]);
    }
    return value;
  }
  double real(std::size_t i) const { return std::bit_cast<double>(integer(i)); }

 private:
  std::string_view bytes_;
  std::size_t width_ = 1;
};

/// The value of a double: exact for every scalar.
template <class Scalar>
Scalar exactly(double value) {
  return Scalar(value);
}

template <class Scalar>
class UmbReader {
 public:
  UmbReader(std::string_view bytes, std::string_view file, const ReadOptions& options)
      : source_(file),
        options_(options),
        entries_(tar_entries(source_, bytes)),
        index_(entry("index.json"), std::string(file) + ": index.json"),
        system_(index_.root().object("an index").member("transition-system", "the sizes of the model")) {}

  Model<Scalar> read() {
    read_sizes();
    ChoiceTable<Scalar> table(source_, options_);
    fill(table);
    std::vector<std::string> notes;
    table.resolve_intervals(notes);
    const std::vector<Scalar> state_rewards = read_rewards(table, notes);
    const Scalar discount = choose_discount<Scalar>(source_, options_, std::nullopt, 0, notes);
    Model<Scalar> model = table.flatten(state_rewards, discount, std::move(notes));
    model.start = read_start();
    return model;
  }

 private:
  [[noreturn]] void fail(std::string_view path, std::string_view message) const {
    source_.fail(0, fmt::format("{}: {}", path, message));
  }

  std::string_view entry(std::string_view path) const {
    const auto found = entries_.find(path);
    if (found == entries_.end()) source_.fail(0, fmt::format("no entry '{}', expected one in the archive", path));
    return found->second;
  }

  /// An array that must have exactly `size` numbers of `width` bytes.
  UmbArray array(std::string_view path, std::uint64_t size, std::size_t width) const {
    const std::string_view bytes = entry(path);
    if (bytes.size() % width != 0 || bytes.size() / width != size) {
      fail(path, fmt::format("{} bytes, expected {} numbers of {} bytes", bytes.size(), size, width));
    }
    return {bytes, width};
  }

  /// Row offsets: `rows` + 1 ascending numbers from 0 to `total`; an array that is not there is the identity.
  std::vector<std::uint64_t> offsets(std::string_view path, std::uint64_t rows, std::uint64_t total) const {
    std::vector<std::uint64_t> begin;
    if (entries_.find(path) == entries_.end()) {
      if (rows != total) fail(path, fmt::format("missing, expected it unless {} equals {}", rows, total));
      if (rows > options_.limits.transitions) fail(path, "missing for a model this large, expected it");
      for (std::uint64_t i = 0; i <= rows; ++i) begin.push_back(i);
      return begin;
    }
    const UmbArray numbers = array(path, rows + 1, 8);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      begin.push_back(numbers.integer(i));
      if (i == 0 ? begin[0] != 0 : begin[i] < begin[i - 1]) fail(path, "not ascending from 0, expected row offsets");
    }
    if (begin.back() != total) fail(path, fmt::format("ends at {}, expected {}", begin.back(), total));
    return begin;
  }

  std::uint64_t size(std::string_view name) const { return system_.member(name, "a count").count(name); }

  void read_sizes() {
    const JsonValue root = index_.root();
    const JsonValue version = root.member("format-version", "1");
    if (version.count("format-version") != 1) version.fail(fmt::format("version {}, expected 1", version.text()));
    const JsonValue time = system_.member("time", "\"discrete\"");
    if (time.string("\"discrete\"") != "discrete") {
      time.fail(fmt::format("time {}, expected \"discrete\"", in_quotes(time.text())));
    }
    const JsonValue players = system_.member("#players", "0 or 1");
    if (players.count("number of players") > 1)
      players.fail(fmt::format("{} players, expected 0 or 1", players.text()));
    states_ = size("#states");
    choices_ = size("#choices");
    branches_ = size("#branches");
    require_size(source_, 0, states_, 1, options_.limits);
    if (choices_ > options_.limits.pairs || branches_ > options_.limits.transitions) {
      system_.fail(fmt::format("{} choices and {} branches are too many, expected at most {} and {}", choices_,
                               branches_, options_.limits.pairs, options_.limits.transitions));
    }
    const JsonValue type = system_.member("branch-probability-type", "double or double-interval")
                               .object("a type")
                               .member("type", "double or double-interval");
    intervals_ = type.string("a type") == "double-interval";
    if (!intervals_ && type.text() != "double") {
      type.fail(fmt::format("probabilities of type {}, expected double or double-interval", in_quotes(type.text())));
    }
  }

  Scalar real(std::string_view path, const UmbArray& numbers, std::size_t i) const {
    const double value = numbers.real(i);
    if (!std::isfinite(value)) fail(path, fmt::format("number {} is not finite, expected finite numbers", i));
    return exactly<Scalar>(value);
  }

  void fill(ChoiceTable<Scalar>& table) const {
    const std::vector<std::uint64_t> choice_begin = offsets("state-to-choices.bin", states_, choices_);
    const std::vector<std::uint64_t> branch_begin = offsets("choice-to-branches.bin", choices_, branches_);
    const UmbArray targets = array("branch-to-target.bin", branches_, 8);
    constexpr std::string_view path = "branch-to-probability.bin";
    const UmbArray probabilities = array(path, intervals_ ? 2 * branches_ : branches_, 8);
    const std::vector<std::string> names = read_action_names();
    for (std::size_t s = 0; s < states_; ++s) {
      table.begin_state();
      for (std::uint64_t c = choice_begin[s]; c < choice_begin[s + 1]; ++c) {
        table.begin_choice(names.empty() ? std::string_view() : std::string_view(names[c]), 0);
        for (std::uint64_t b = branch_begin[c]; b < branch_begin[c + 1]; ++b) {
          if (targets.integer(b) >= states_) {
            fail("branch-to-target.bin",
                 fmt::format("branch {} leads to state {}, expected 0 to {}", b, targets.integer(b), states_ - 1));
          }
          const std::size_t low = intervals_ ? 2 * b : b, high = intervals_ ? 2 * b + 1 : b;
          table.branch(static_cast<State>(targets.integer(b)),
                       {real(path, probabilities, low), real(path, probabilities, high)}, 0);
        }
      }
    }
  }

  /// The action name of every choice; empty where the file has no actions.
  std::vector<std::string> read_action_names() const {
    const auto declared = system_.find("#choice-actions");
    const std::uint64_t actions = declared ? declared->count("number of actions") : 0;
    constexpr std::string_view values_path = "actions/choices/values.bin";
    if (actions > options_.limits.pairs) {  // a count near 2^64 would wrap where offsets add one to it
      declared->fail(fmt::format("{} actions are too many, expected at most {}", actions, options_.limits.pairs));
    }
    if (actions == 0 || entries_.find(values_path) == entries_.end()) return {};
    const UmbArray values = array(values_path, choices_, 4);
    const std::vector<std::string> strings = read_strings("actions/choices/", actions);
    std::vector<std::string> names;
    for (std::size_t c = 0; c < choices_; ++c) {
      const std::uint64_t a = values.integer(c);
      if (a >= actions) {
        fail(values_path, fmt::format("choice {} has action {}, expected 0 to {}", c, a, actions - 1));
      }
      names.push_back(strings.empty() ? std::to_string(a) : strings[a]);
    }
    return names;
  }

  /// The names of actions; the empty name stays empty: such a choice counts as unlabelled.
  std::vector<std::string> read_strings(const std::string& folder, std::uint64_t count) const {
    const std::string path = folder + "strings.bin";
    if (entries_.find(path) == entries_.end()) return {};
    const std::string_view text = entry(path);
    const std::vector<std::uint64_t> begin = offsets(folder + "string-mapping.bin", count, text.size());
    std::vector<std::string> strings;
    for (std::size_t i = 0; i < count; ++i) {
      const std::string_view name = text.substr(begin[i], begin[i + 1] - begin[i]);
      if (!name.empty() && !is_name(name)) fail(path, fmt::format("{}: expected a name in UTF-8", in_quotes(name)));
      strings.emplace_back(name);
    }
    return strings;
  }

  /// Rewards of the chosen model: those of choices and branches go into the table, those of states are returned.
  std::vector<Scalar> read_rewards(ChoiceTable<Scalar>& table, std::vector<std::string>& notes) const {
    const std::optional<JsonValue> chosen = choose_rewards(notes);
    if (!chosen) return {};
    const JsonValue type = chosen->object("rewards").member("type", "the type of the rewards").object("a type");
    const std::string_view kind = type.member("type", "double").string("a type");
    if (kind != "double" && kind != "double-interval") {
      type.fail(fmt::format("rewards of type {}, expected double or double-interval", in_quotes(kind)));
    }
    const bool intervals = kind == "double-interval";
    std::vector<Scalar> of_states;
    for (const JsonValue where : chosen->member("applies-to", "a list").array("states, choices or branches")) {
      const std::string_view what = where.string("states, choices or branches");
      const std::string path = fmt::format("annotations/rewards/{}/{}/values.bin", chosen->key(), what);
      if (what == "states") {
        of_states = reward_values(path, states_, intervals);
      } else if (what == "choices") {
        const std::vector<Scalar> values = reward_values(path, choices_, intervals);
        for (std::size_t c = 0; c < choices_; ++c) table.choice(c).reward += values[c];
      } else if (what == "branches") {
        add_branch_rewards(table, reward_values(path, branches_, intervals));
      } else {
        where.fail(fmt::format("rewards on {}, expected states, choices or branches", in_quotes(what)));
      }
    }
    return of_states;
  }

  void add_branch_rewards(ChoiceTable<Scalar>& table, const std::vector<Scalar>& values) const {
    for (std::size_t c = 0; c < choices_; ++c) {
      WeightedMean<Scalar> mean;
      for (std::size_t b = table.first_branch(c); b < table.first_branch(c + 1); ++b) {
        mean.add(table.branch_at(b).probability.low, values[b]);
      }
      table.choice(c).reward += mean.value();
    }
  }

  std::vector<Scalar> reward_values(const std::string& path, std::uint64_t count, bool intervals) const {
    const UmbArray numbers = array(path, intervals ? 2 * count : count, 8);
    std::vector<Scalar> values;
    for (std::size_t i = 0; i < count; ++i) {
      const Scalar low = real(path, numbers, intervals ? 2 * i : i);
      const Scalar high = real(path, numbers, intervals ? 2 * i + 1 : i);
      if (low != high && options_.intervals == IntervalRows::refuse) {
        fail(path, "a reward is an interval, expected numbers; --intervals nominal takes its midpoint");
      }
      values.push_back(low == high ? low : Scalar((low + high) / Scalar(2)));
    }
    return values;
  }

  /// The reward model to read: a member of annotations.rewards.
  std::optional<JsonValue> choose_rewards(std::vector<std::string>& notes) const {
    const auto annotations = index_.root().find("annotations");
    const auto rewards = annotations ? annotations->object("annotations").find("rewards") : std::nullopt;
    const std::size_t count = rewards ? rewards->object("reward models").size() : 0;
    if (!options_.reward_model.empty()) {
      if (const auto found = find_rewards(rewards)) return found;
      source_.fail(0, fmt::format("no reward model {}, expected one of the {} in the file",
                                  in_quotes(options_.reward_model), count));
    }
    if (count == 0) {
      notes.emplace_back("rewards: the file has none, all rewards are 0");
      return std::nullopt;
    }
    if (count > 1) {
      notes.push_back(fmt::format("rewards: {} reward models, the first taken; choose one with --reward-model", count));
    }
    return *rewards->begin();
  }

  std::optional<JsonValue> find_rewards(const std::optional<JsonValue>& rewards) const {
    if (!rewards) return std::nullopt;
    for (const JsonValue model : *rewards) {
      const auto alias = model.object("rewards").find("alias");
      if (model.key() == options_.reward_model || (alias && alias->text() == options_.reward_model)) return model;
    }
    return std::nullopt;
  }

  /// Uniform over the initial states.
  std::vector<Scalar> read_start() const {
    constexpr std::string_view path = "state-is-initial.bin";
    if (entries_.find(path) == entries_.end()) return {};
    const UmbArray bits = array(path, (states_ + 63) / 64, 8);
    std::vector<std::size_t> initial;
    for (std::size_t s = 0; s < states_; ++s) {
      if ((bits.integer(s / 64) >> (s % 64) & 1U) != 0) initial.push_back(s);
    }
    if (initial.empty()) return {};
    std::vector<Scalar> start(states_, Scalar(0));
    for (const std::size_t s : initial) start[s] = Scalar(Scalar(1) / Scalar(static_cast<long>(initial.size())));
    return start;
  }

  TextSource source_;
  const ReadOptions& options_;
  std::map<std::string, std::string_view, std::less<>> entries_;
  JsonDocument index_;
  JsonValue system_;
  std::uint64_t states_ = 0, choices_ = 0, branches_ = 0;
  bool intervals_ = false;
};

}  // namespace

template <class Scalar>
Model<Scalar> read_umb(std::string_view bytes, std::string_view file_name, const ReadOptions& options) {
  if (!is_gzip(bytes)) return UmbReader<Scalar>(bytes, file_name, options).read();
  const std::string unpacked = gunzip(TextSource(file_name), bytes, options.limits.bytes);
  return UmbReader<Scalar>(unpacked, file_name, options).read();
}

template Model<double> read_umb(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_umb(std::string_view, std::string_view, const ReadOptions&);

}  // namespace maximin
