#include <maximin/models/files/prism_explicit.hpp>

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/choice_table.hpp>
#include <maximin/models/files/internal/prism_companions.hpp>
#include <maximin/models/files/internal/text_lines.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;

/// The next line that is neither empty nor a comment.
bool next_entry(TextLines& lines) {
  while (lines.next_filled()) {
    if (trimmed(lines.line()).front() != '#') return true;
  }
  return false;
}

/// Reads a .tra file into a ChoiceTable.
template <class Scalar>
class TransitionsReader {
 public:
  TransitionsReader(std::string_view text, std::string_view file, const ReadOptions& options)
      : source_(file), text_(text), lines_(source_, text), options_(options), table_(source_, options) {
    source_.require_text(text);
  }

  Model<Scalar> read(const PrismCompanions& companions) {
    read_header();
    while (next_entry(lines_)) read_line();
    finish();
    std::vector<std::string> notes;
    table_.resolve_intervals(notes);
    std::vector<Scalar> state_rewards;
    if (companions.state_rewards) state_rewards = read_state_rewards<Scalar>(*companions.state_rewards, states_);
    if (companions.transition_rewards) read_transition_rewards(*companions.transition_rewards);
    if (!companions.state_rewards && !companions.transition_rewards) {
      notes.emplace_back("rewards: no .srew or .trew file, all rewards are 0");
    }
    const Scalar discount = choose_discount<Scalar>(source_, options_, std::nullopt, 0, notes);
    Model<Scalar> model = table_.flatten(state_rewards, discount, std::move(notes));
    if (companions.labels) model.start = read_initial_states<Scalar>(*companions.labels, states_);
    if (companions.states) model.state_names = read_state_names(*companions.states, states_);
    return model;
  }

 private:
  void read_header() {
    if (!next_entry(lines_)) lines_.fail("no sizes, expected a line 'states choices transitions'");
    const std::vector<std::string_view>& words = lines_.words();
    if (words.size() == 1 && (words[0] == "mdp" || words[0] == "dtmc")) {
      chain_ = words[0] == "dtmc";
      states_ = states_of_storm_dialect();
      return;
    }
    if (words.size() < 2 || words.size() > 4) {
      lines_.fail(fmt::format("{} numbers, expected 'states choices transitions'", words.size()));
    }
    const auto size = [&](std::size_t i, std::string_view name) {
      return read_count(source_, lines_.number(), name, words[i]);
    };
    states_ = size(0, "number of states");
    chain_ = words.size() == 2;
    if (!chain_) declared_choices_ = size(1, "number of choices");
    declared_transitions_ = size(chain_ ? 1 : 2, "number of transitions");
    observed_ = words.size() == 4;
    // A line holds at least one state's choice in either form: larger counts cannot be true.
    const auto filled = static_cast<std::uint64_t>(std::count(text_.begin(), text_.end(), '\n')) + 1;
    if (states_ < 1 || states_ > filled) {
      lines_.fail(
          fmt::format("{} states in a file of {} lines, expected at least 1 and a line for each", states_, filled));
    }
    header_line_ = lines_.number();
  }

  /// Storm writes no sizes: the states are those that lines begin with.
  std::uint64_t states_of_storm_dialect() const {
    std::uint64_t states = 0, filled = 0;
    TextLines lines(source_, text_);
    next_entry(lines);
    while (next_entry(lines)) {
      states = std::max(states, read_count(source_, lines.number(), "state", lines.words().front()));
      if (states > ++filled)
        lines.fail(fmt::format("state {}: states must come in order, expected at most {}", states, filled));
    }
    return states + 1;
  }

  void read_line() {
    const std::vector<std::string_view>& words = lines_.words();
    if (words[0] == "-") return;  // POMDP: the initial observation
    begin_state(read_index(source_, lines_.number(), "state", words[0], states_));
    if (words.size() > 1 && words[1].find(':') != std::string_view::npos) {
      read_row_form(words);
    } else {
      read_entry_form(words);
    }
  }

  void begin_state(std::uint32_t s) {
    if (static_cast<std::size_t>(s) + 1 == table_.states()) return;
    if (s != table_.states()) {
      lines_.fail(fmt::format("state {} after {}, expected states in order without a gap", s,
                              table_.states() == 0 ? "none" : std::to_string(table_.states() - 1)));
    }
    table_.begin_state();
    row_label_.clear();
  }

  /// i p:j p:j ... [action]: a choice per line.
  void read_row_form(const std::vector<std::string_view>& words) {
    std::size_t end = 1;
    while (end < words.size() && words[end].find(':') != std::string_view::npos) ++end;
    if (end + 1 < words.size()) lines_.fail("more than one word after the probabilities, expected one action name");
    table_.begin_choice(end < words.size() ? words[end] : std::string_view(), lines_.number());
    for (std::size_t i = 1; i < end; ++i) {
      const std::size_t colon = words[i].find(':');
      add_branch(words[i].substr(0, colon), words[i].substr(colon + 1));
    }
  }

  /// i [k] j p [observation] [action]: a transition per line.
  void read_entry_form(const std::vector<std::string_view>& words) {
    const std::size_t target = chain_ ? 1 : 2;
    const std::size_t label = target + 2 + (observed_ ? 1 : 0);
    if (words.size() < label || words.size() > label + 1) {
      lines_.fail(fmt::format("{} words, expected '{}'", words.size(),
                              chain_      ? "state target probability"
                              : observed_ ? "state choice target probability observation [action]"
                                          : "state choice target probability [action]"));
    }
    const std::string_view name = words.size() > label ? words[label] : std::string_view();
    const std::size_t first = table_.first_choice(table_.states() - 1);
    const std::size_t so_far = table_.choices() - first;
    const std::uint64_t k = chain_ ? 0 : read_index(source_, lines_.number(), "choice", words[1], so_far + 1);
    if (k == so_far) {
      table_.begin_choice(name, lines_.number());
      row_label_ = name;
    } else if (k + 1 != so_far) {
      lines_.fail(fmt::format("choice {} after choice {}, expected choices in order", k, so_far - 1));
    } else if (name != row_label_) {
      lines_.fail(fmt::format("action {} in a choice of action {}, expected one action name per choice",
                              in_quotes(name), in_quotes(row_label_)));
    }
    add_branch(words[target + 1], words[target]);
  }

  void add_branch(std::string_view probability, std::string_view target) {
    const auto t = static_cast<State>(read_index(source_, lines_.number(), "state", target, states_));
    table_.branch(t, read_interval<Scalar>(source_, lines_.number(), "probability", probability), lines_.number());
    ++transitions_;
  }

  void finish() const {
    if (table_.states() < states_) {
      source_.fail(lines_.number(),
                   fmt::format("the file ends after {} states, expected {}", table_.states(), states_));
    }
    if (declared_choices_ && *declared_choices_ != table_.choices()) {
      source_.fail(header_line_, fmt::format("{} choices announced but {} found, expected the same number",
                                             *declared_choices_, table_.choices()));
    }
    if (declared_transitions_ && *declared_transitions_ != transitions_) {
      source_.fail(header_line_, fmt::format("{} transitions announced but {} found, expected the same number",
                                             *declared_transitions_, transitions_));
    }
  }

  /// i [k] j r: rewards of transitions, averaged over the choice; what is not listed is 0.
  void read_transition_rewards(const NamedText& file) {
    const TextSource source(file.file);
    source.require_text(file.text);
    TextLines lines(source, file.text);
    if (!next_entry(lines)) lines.fail("no sizes, expected a line 'states choices transitions'");
    if (read_count(source, lines.number(), "number of states", lines.words().front()) != states_) {
      lines.fail(fmt::format("{} states, expected {} as in the .tra file", lines.words().front(), states_));
    }
    std::vector<TransitionReward> rewards;
    while (next_entry(lines)) {
      const std::vector<std::string_view>& words = lines.words();
      const std::size_t target = chain_ ? 1 : 2;
      if (words.size() != target + 2) {
        lines.fail(fmt::format("{} words, expected 'state {}target reward'", words.size(), chain_ ? "" : "choice "));
      }
      const std::size_t s = read_index(source, lines.number(), "state", words[0], states_);
      const std::size_t first = table_.first_choice(s);
      const std::size_t count = table_.first_choice(s + 1) - first;
      const std::size_t k = chain_ ? 0 : read_index(source, lines.number(), "choice", words[1], count);
      const auto t = static_cast<State>(read_index(source, lines.number(), "state", words[target], states_));
      rewards.push_back(
          {first + k, t, read_number<Scalar>(source, lines.number(), "reward", words[target + 1]), lines.number()});
    }
    std::stable_sort(rewards.begin(), rewards.end(), [](const TransitionReward& x, const TransitionReward& y) {
      return std::tie(x.choice, x.target) < std::tie(y.choice, y.target);
    });
    for (std::size_t i = 1; i < rewards.size(); ++i) {
      if (rewards[i].choice != rewards[i - 1].choice || rewards[i].target != rewards[i - 1].target) continue;
      source.fail(rewards[i].at, fmt::format("the reward to state {} is given twice, expected each transition once",
                                             rewards[i].target));
    }
    for (Rewards next = rewards.cbegin(); next != rewards.cend();) next = average_rewards(source, next, rewards.end());
  }

  struct TransitionReward {
    std::size_t choice;
    State target;
    Scalar reward;
    std::size_t at;
  };
  using Rewards = typename std::vector<TransitionReward>::const_iterator;

  /// Gives the choice at `next` the mean of its transitions' rewards; returns where the next choice's begin.
  Rewards average_rewards(const Source& source, Rewards next, Rewards end) {
    const std::size_t choice = next->choice;
    std::vector<std::size_t> branches;
    for (std::size_t b = table_.first_branch(choice); b < table_.first_branch(choice + 1); ++b) branches.push_back(b);
    const auto target = [&](std::size_t b) { return table_.branch_at(b).target; };
    std::sort(branches.begin(), branches.end(), [&](auto x, auto y) { return target(x) < target(y); });
    WeightedMean<Scalar> mean;
    for (const std::size_t b : branches) {
      const bool listed = next != end && next->choice == choice && next->target == target(b);
      mean.add(table_.branch_at(b).probability.low, listed ? next->reward : Scalar(0));
      if (listed) ++next;
    }
    if (next != end && next->choice == choice) {
      source.fail(next->at, fmt::format("the choice has no transition to state {}, expected a transition of the .tra "
                                        "file",
                                        next->target));
    }
    table_.choice(choice).reward = mean.value();
    return next;
  }

  TextSource source_;
  std::string_view text_;
  TextLines lines_;
  const ReadOptions& options_;
  ChoiceTable<Scalar> table_;
  std::uint64_t states_ = 0;
  std::optional<std::uint64_t> declared_choices_, declared_transitions_;
  std::uint64_t transitions_ = 0;
  std::size_t header_line_ = 0;
  bool chain_ = false;     // a DTMC: one choice per state, without a number
  bool observed_ = false;  // a POMDP: a column with the target's observation
  std::string row_label_;
};

}  // namespace

template <class Scalar>
Model<Scalar> read_prism_explicit(std::string_view text, std::string_view file_name, const ReadOptions& options,
                                  const PrismCompanions& companions) {
  return TransitionsReader<Scalar>(text, file_name, options).read(companions);
}

template <class Scalar>
Model<Scalar> load_prism_explicit(const std::filesystem::path& tra, const ReadOptions& options) {
  return read_prism_explicit_at<Scalar>(unpacked_file_bytes(tra, options.limits.bytes), tra, options);
}

template <class Scalar>
Model<Scalar> read_prism_explicit_at(std::string_view text, const std::filesystem::path& tra,
                                     const ReadOptions& options) {
  std::vector<std::string> notes;
  const PrismCompanions companions = find_prism_companions(tra, options, notes);
  Model<Scalar> model = read_prism_explicit<Scalar>(text, tra.string(), options, companions);
  model.notes.insert(model.notes.begin(), notes.begin(), notes.end());
  return model;
}

template Model<double> read_prism_explicit(std::string_view, std::string_view, const ReadOptions&,
                                           const PrismCompanions&);
template Model<Rational> read_prism_explicit(std::string_view, std::string_view, const ReadOptions&,
                                             const PrismCompanions&);
template Model<double> read_prism_explicit_at(std::string_view, const std::filesystem::path&, const ReadOptions&);
template Model<Rational> read_prism_explicit_at(std::string_view, const std::filesystem::path&, const ReadOptions&);
template Model<double> load_prism_explicit(const std::filesystem::path&, const ReadOptions&);
template Model<Rational> load_prism_explicit(const std::filesystem::path&, const ReadOptions&);

}  // namespace maximin
