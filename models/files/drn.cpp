#include <maximin/models/files/drn.hpp>

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/choice_table.hpp>
#include <maximin/models/files/internal/text_lines.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;

/// Takes a bracketed group, nested ones included, off the front of `text`; fails when it does not close.
std::string_view take_brackets(std::string_view& text, char open, char close, const TextLines& lines) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == open) ++depth;
    if (text[i] == close && --depth == 0) {
      const std::string_view group = text.substr(0, i + 1);
      text = trimmed(text.substr(i + 1));
      return group;
    }
  }
  lines.fail(fmt::format("{} is never closed, expected '{}'", in_quotes(text), close));
}

/// Takes a word off the front of `text`.
std::string_view take_word(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of(" \t\r"), text.size());
  const std::string_view word = text.substr(0, end);
  text = trimmed(text.substr(end));
  return word;
}

template <class Scalar>
class DrnReader {
 public:
  DrnReader(std::string_view text, std::string_view file, const ReadOptions& options)
      : source_(file), text_(text), lines_(source_, text), options_(options), table_(source_, options) {
    source_.require_text(text);
  }

  Model<Scalar> read() {
    read_header();
    choose_rewards();
    while (next_entry()) read_model_line(trimmed(lines_.line()));
    if (table_.states() != states_) {
      lines_.fail(fmt::format("the file ends after {} states, expected {}", table_.states(), states_));
    }
    if (declared_choices_ && *declared_choices_ != table_.choices()) {
      source_.fail(choices_line_, fmt::format("{} choices announced but {} found, expected the same number",
                                              *declared_choices_, table_.choices()));
    }
    const Scalar discount = choose_discount<Scalar>(source_, options_, std::nullopt, 0, notes_);
    Model<Scalar> model = table_.flatten(state_rewards_, discount, std::move(notes_));
    if (!initial_.empty()) {
      model.start.assign(states_, Scalar(0));
      for (const std::size_t s : initial_) {
        model.start[s] = Scalar(Scalar(1) / Scalar(static_cast<long>(initial_.size())));
      }
    }
    return model;
  }

 private:
  bool next_entry() {
    while (lines_.next_filled()) {
      if (!trimmed(lines_.line()).starts_with("//")) return true;
    }
    return false;
  }

  void read_header() {
    while (next_entry()) {
      std::string_view line = trimmed(lines_.line());
      if (line.front() == '$') {
        read_placeholder(line);
        continue;
      }
      const std::string_view key = take_word(line);
      if (key == "@model") return require_sizes();
      read_header_line(key, line);
    }
    lines_.fail("the file ends before the model, expected '@model'");
  }

  void read_header_line(std::string_view key, std::string_view rest) {
    if (key == "@type:") {
      if (rest != "MDP" && rest != "DTMC" && rest != "POMDP") {
        lines_.fail(fmt::format("type {}: expected MDP, POMDP or DTMC", in_quotes(rest)));
      }
      typed_ = true;
    } else if (key == "@value_type:") {
      if (rest == "parametric") lines_.fail("value_type parametric: expected numbers without parameters");
    } else if (key == "@parameters") {
      if (!following_line().empty()) lines_.fail(fmt::format("parameters {}: expected none", in_quotes(lines_.line())));
    } else if (key == "@reward_models") {
      following_line();
      const auto& words = lines_.words();
      reward_models_.assign(words.begin(), words.end());
    } else if (key == "@nr_states") {
      following_line();
      sizes_line_ = lines_.number();
      states_ = read_count(source_, lines_.number(), "number of states", trimmed(lines_.line()));
    } else if (key == "@nr_choices") {
      following_line();
      choices_line_ = lines_.number();
      declared_choices_ = read_count(source_, lines_.number(), "number of choices", trimmed(lines_.line()));
    } else if (key != "@placeholders") {
      lines_.fail(
          fmt::format("{}: unknown, expected one of @type:, @value_type:, @parameters, @placeholders, "
                      "@reward_models, @nr_states, @nr_choices, @model",
                      in_quotes(key)));
    }
  }

  std::string_view following_line() {
    if (!lines_.next()) lines_.fail("the file ends in its header, expected '@model'");
    return trimmed(lines_.line());
  }

  void read_placeholder(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) lines_.fail("no colon, expected '$name : value'");
    placeholders_[std::string(trimmed(line.substr(0, colon)))] = std::string(trimmed(line.substr(colon + 1)));
  }

  void require_sizes() const {
    if (!typed_) lines_.fail("no '@type:' in the header, expected '@type: MDP'");
    if (!sizes_line_) lines_.fail("no '@nr_states' in the header, expected the number of states");
    // Every state has a line of its own, so larger counts cannot be true.
    const auto filled = static_cast<std::uint64_t>(std::count(text_.begin(), text_.end(), '\n')) + 1;
    if (states_ < 1 || states_ > filled) {
      source_.fail(*sizes_line_, fmt::format("{} states in a file of {} lines, expected at least 1 and a line for each",
                                             states_, filled));
    }
  }

  void choose_rewards() {
    if (options_.reward_model.empty()) {
      if (reward_models_.size() > 1) {
        notes_.push_back(fmt::format("rewards: reward models {}; the first taken, choose one with --reward-model",
                                     fmt::join(reward_models_, ", ")));
      }
      return;
    }
    const auto found = std::find(reward_models_.begin(), reward_models_.end(), options_.reward_model);
    if (found == reward_models_.end()) {
      source_.fail(0, fmt::format("no reward model {}, expected one of: {}", in_quotes(options_.reward_model),
                                  fmt::join(reward_models_, ", ")));
    }
    chosen_ = static_cast<std::size_t>(found - reward_models_.begin());
  }

  void read_model_line(std::string_view line) {
    std::string_view rest = line;
    const std::string_view word = take_word(rest);
    if (word == "state") {
      read_state(rest);
    } else if (word == "action") {
      if (table_.states() == 0) lines_.fail("an action before the first state, expected 'state 0'");
      read_action(rest);
    } else {
      read_branch(line);
    }
  }

  /// state ID [!rate] [{observation}] [[rewards]] label label ...
  void read_state(std::string_view rest) {
    const std::uint32_t s = read_index(source_, lines_.number(), "state", take_word(rest), states_);
    if (s != table_.states()) lines_.fail(fmt::format("state {}: out of order, expected {}", s, table_.states()));
    table_.begin_state();
    if (!rest.empty() && rest.front() == '!') take_word(rest);
    if (!rest.empty() && rest.front() == '{') take_brackets(rest, '{', '}', lines_);
    state_rewards_.push_back(take_reward(rest));
    while (!rest.empty()) {
      if (take_word(rest) == "init") {
        initial_.push_back(s);
        break;
      }
    }
  }

  /// action NAME [[rewards]]
  void read_action(std::string_view rest) {
    std::string_view name = take_word(rest);
    if (name == "__NOLABEL__") name = {};
    table_.begin_choice(name, lines_.number());
    table_.choice(table_.choices() - 1).reward = take_reward(rest);
    if (!rest.empty()) lines_.fail(fmt::format("{} after the action, expected nothing more", in_quotes(rest)));
  }

  /// TARGET : VALUE
  void read_branch(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) {
      lines_.fail(fmt::format("{}: expected 'state', 'action' or 'target : probability'", in_quotes(line)));
    }
    if (table_.states() == 0) lines_.fail("a transition before the first state, expected 'state 0'");
    const bool in_action = table_.choices() > table_.first_choice(table_.states() - 1);
    if (!in_action) table_.begin_choice({}, lines_.number());
    const std::uint32_t target = read_index(source_, lines_.number(), "state", trimmed(line.substr(0, colon)), states_);
    table_.branch(static_cast<State>(target), value(trimmed(line.substr(colon + 1)), "probability"), lines_.number());
  }

  Interval<Scalar> value(std::string_view token, std::string_view name) const {
    if (!token.empty() && token.front() == '$') {
      const auto found = placeholders_.find(token);
      if (found == placeholders_.end()) {
        lines_.fail(fmt::format("{} is not defined, expected one of the @placeholders", in_quotes(token)));
      }
      token = found->second;
    }
    return read_interval<Scalar>(source_, lines_.number(), name, token);
  }

  /// [r1, r2, ...] at the front of `rest`: the reward of the chosen model, 0 where there is no bracket.
  Scalar take_reward(std::string_view& rest) const {
    if (rest.empty() || rest.front() != '[') return Scalar(0);
    std::string_view group = take_brackets(rest, '[', ']', lines_);
    group = trimmed(group.substr(1, group.size() - 2));
    Scalar reward(0);
    std::size_t count = 0;
    while (!group.empty()) {
      const std::string_view token = take_reward_token(group);
      if (count == chosen_) reward = midpoint(value(token, "reward"));
      ++count;
    }
    const std::size_t wanted = std::max<std::size_t>(reward_models_.size(), 1);
    if (count != wanted) lines_.fail(fmt::format("{} rewards, expected {}, one per reward model", count, wanted));
    return reward;
  }

  std::string_view take_reward_token(std::string_view& group) const {
    std::string_view token;
    if (group.front() == '[') {
      token = take_brackets(group, '[', ']', lines_);
    } else {
      const std::size_t comma = std::min(group.find(','), group.size());
      token = trimmed(group.substr(0, comma));
      group.remove_prefix(comma);
    }
    if (!group.empty() && group.front() != ',') lines_.fail("rewards without commas between, expected [r1, r2]");
    if (!group.empty()) {
      group = trimmed(group.substr(1));
      if (group.empty()) lines_.fail("a comma without a reward after it, expected [r1, r2]");
    }
    return token;
  }

  Scalar midpoint(const Interval<Scalar>& interval) const {
    if (interval.low == interval.high) return interval.low;
    if (options_.intervals == IntervalRows::refuse) {
      lines_.fail("the reward is an interval, expected a number; --intervals nominal takes its midpoint");
    }
    return Scalar((interval.low + interval.high) / Scalar(2));
  }

  TextSource source_;
  std::string_view text_;
  TextLines lines_;
  const ReadOptions& options_;
  ChoiceTable<Scalar> table_;
  std::vector<std::string> notes_;
  bool typed_ = false;
  std::uint64_t states_ = 0;
  std::optional<std::size_t> sizes_line_;
  std::optional<std::uint64_t> declared_choices_;
  std::size_t choices_line_ = 0;
  std::vector<std::string> reward_models_;
  std::size_t chosen_ = 0;
  std::map<std::string, std::string, std::less<>> placeholders_;
  std::vector<Scalar> state_rewards_;
  std::vector<std::size_t> initial_;
};

/// Whether DRN can hold the name: one word that the reader will not take for something else.
bool writable(const std::string& name) {
  return name != "__NOLABEL__" && name.find_first_of(" \t\r\n[]") == std::string::npos;
}

}  // namespace

template <class Scalar>
Model<Scalar> read_drn(std::string_view text, std::string_view file_name, const ReadOptions& options) {
  return DrnReader<Scalar>(text, file_name, options).read();
}

template <class Scalar>
void write_drn(const Model<Scalar>& model, std::ostream& out) {
  const FiniteMdp<Scalar>& mdp = model.mdp;
  const bool named =
      !model.action_names.empty() && std::all_of(model.action_names.begin(), model.action_names.end(), writable);
  out << "@type: MDP\n@parameters\n\n@reward_models\nreward\n@nr_states\n"
      << mdp.states() << "\n@nr_choices\n"
      << static_cast<std::int64_t>(mdp.states()) * mdp.actions() << "\n@model\n";
  for (State s = 0; s < mdp.states(); ++s) {
    const bool initial = !model.start.empty() && model.start[static_cast<std::size_t>(s)] > Scalar(0);
    out << "state " << s << (initial ? " init\n" : "\n");
    for (Action a = 0; a < mdp.actions(); ++a) {
      out << "\taction " << (named ? model.action_name(a) : std::to_string(a)) << " [" << number_text(mdp.reward(s, a))
          << "]\n";
      for (const auto& next : mdp.successors(s, a)) {
        out << "\t\t" << next.target << " : " << number_text(next.probability) << '\n';
      }
    }
  }
}

template Model<double> read_drn(std::string_view, std::string_view, const ReadOptions&);
template Model<Rational> read_drn(std::string_view, std::string_view, const ReadOptions&);
template void write_drn(const Model<double>&, std::ostream&);

}  // namespace maximin
