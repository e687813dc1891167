#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <maximin/models/files/internal/model_assembly.hpp>
#include <maximin/models/model.hpp>

namespace maximin::internal {

/// A probability as model checkers write it: a number, or an interval of numbers.
template <class Scalar>
struct Interval {
  Scalar low;
  Scalar high;
};

/// Reads "0.5" or "[0.4,0.6]".
template <class Scalar>
Interval<Scalar> read_interval(const Source& source, std::size_t at, std::string_view name, std::string_view token) {
  if (token.size() < 2 || token.front() != '[' || token.back() != ']') {
    const auto value = read_number<Scalar>(source, at, name, token);
    return {value, value};
  }
  const std::size_t comma = token.find(',');
  if (comma == std::string_view::npos) {
    source.fail(at, fmt::format("{} {}: expected a number or an interval such as [0.4,0.6]", name, in_quotes(token)));
  }
  const auto trim = [](std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    return text;
  };
  return {read_number<Scalar>(source, at, name, trim(token.substr(1, comma - 1))),
          read_number<Scalar>(source, at, name, trim(token.substr(comma + 1, token.size() - comma - 2)))};
}

/// A model as model checkers see it: each state has choices of its own, perhaps labelled, and branches under them.
///
/// `flatten` turns choices into actions that every state has. With labels, the actions are the labels of all states
/// together; an unlabelled choice takes the first label that its state lacks. Without, choice k is action k. An action
/// that a state lacks acts there as the state's first choice: it adds nothing to choose from, so V* is unchanged.
template <class Scalar>
class ChoiceTable {
 public:
  struct Choice {
    std::size_t at;     ///< place in the file
    std::size_t label;  ///< index into labels(), or no_label
    std::size_t begin;  ///< first branch
    Scalar reward;      ///< R of this choice, without the state's
  };
  struct Branch {
    State target;
    Interval<Scalar> probability;
    std::size_t at;
  };
  static constexpr std::size_t no_label = static_cast<std::size_t>(-1);

  ChoiceTable(const Source& source, const ReadOptions& options) : source_(source), options_(options) {}

  /// Begins the next state; the choices that follow are its.
  void begin_state() { state_begin_.push_back(choices_.size()); }
  /// Begins the next choice of the state. An empty label is none.
  void begin_choice(std::string_view label, std::size_t at) {
    choices_.push_back({at, intern(label, at), branches_.size(), Scalar(0)});
  }
  /// Adds a branch to the choice.
  void branch(State target, Interval<Scalar> probability, std::size_t at) {
    if (branches_.size() >= options_.limits.transitions) {
      source_.fail(at, fmt::format("more than {} transitions, expected fewer", options_.limits.transitions));
    }
    branches_.push_back({target, std::move(probability), at});
  }

  std::size_t states() const { return state_begin_.size(); }
  std::size_t choices() const { return choices_.size(); }
  /// First choice of a state; `s` may be states(), for the end.
  std::size_t first_choice(std::size_t s) const { return s < state_begin_.size() ? state_begin_[s] : choices_.size(); }
  std::size_t first_branch(std::size_t c) const { return c < choices_.size() ? choices_[c].begin : branches_.size(); }
  Choice& choice(std::size_t c) { return choices_[c]; }
  const Branch& branch_at(std::size_t b) const { return branches_[b]; }

  /// Makes every interval the number that stands for it, or fails, as the options say.
  void resolve_intervals(std::vector<std::string>& notes) {
    std::size_t resolved = 0;
    for (std::size_t c = 0; c < choices(); ++c) {
      bool proper = false;
      for (std::size_t b = first_branch(c); b < first_branch(c + 1); ++b) {
        proper = proper || branches_[b].probability.low != branches_[b].probability.high;
      }
      if (!proper) continue;
      if (options_.intervals == IntervalRows::refuse) {
        source_.fail(choices_[c].at,
                     "probabilities are intervals, expected numbers; --intervals nominal takes from every row the "
                     "member lo + t (hi - lo) that sums to 1");
      }
      resolve_row(c);
      ++resolved;
    }
    if (resolved > 0) {
      notes.push_back(
          fmt::format("intervals: {} rows were resolved to the member lo + t (hi - lo) that sums to 1", resolved));
    }
  }

  /// The model; `state_rewards` is empty or has one per state and adds to each of its actions.
  Model<Scalar> flatten(const std::vector<Scalar>& state_rewards, Scalar discount, std::vector<std::string> notes) {
    for (std::size_t s = 0; s < states(); ++s) {
      if (first_choice(s) == first_choice(s + 1)) {
        source_.fail(0, fmt::format("state {}: no choices, expected at least one", s));
      }
    }
    resolve_intervals(notes);
    std::vector<std::string> names;
    const std::vector<std::size_t> action_of = assign_actions(names);
    const std::size_t actions = std::max<std::size_t>(names.size(), 1);
    require_size(source_, 0, states(), actions, options_.limits);
    const std::vector<std::size_t> choice_of = fill_actions(action_of, actions, notes);
    ModelAssembly<Scalar> assembly(source_, options_.limits, static_cast<State>(states()), static_cast<Action>(actions),
                                   Scalar(Scalar(1) / Scalar(1'000'000'000)));
    for (std::size_t row = 0; row < choice_of.size(); ++row) {
      const auto s = static_cast<State>(row / actions);
      const auto a = static_cast<Action>(row % actions);
      const std::size_t c = choice_of[row];
      for (std::size_t b = first_branch(c); b < first_branch(c + 1); ++b) {
        assembly.transition(s, a, branches_[b].target, branches_[b].probability.low, branches_[b].at);
      }
      Scalar reward = choices_[c].reward;
      if (!state_rewards.empty()) reward += state_rewards[static_cast<std::size_t>(s)];
      assembly.reward(s, a, std::move(reward));
    }
    Model<Scalar> model{std::move(assembly).build(std::move(discount), 0, notes), {}, {}, {}, {}, {}, {}};
    if (!numbered(names)) model.action_names = std::move(names);
    model.notes = std::move(notes);
    return model;
  }

 private:
  std::size_t intern(std::string_view label, std::size_t at) {
    if (label.empty()) return no_label;
    const auto found = label_index_.find(label);
    if (found != label_index_.end()) return found->second;
    if (!is_name(label))
      source_.fail(at, fmt::format("{}: expected a name without control characters", in_quotes(label)));
    labels_.emplace_back(label);
    label_index_.emplace(labels_.back(), labels_.size() - 1);
    return labels_.size() - 1;
  }

  /// Whether the names are "0", "1", ... and so say nothing.
  static bool numbered(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] != std::to_string(i)) return false;
    }
    return true;
  }

  /// Labels that are exactly the numbers 0 to n-1 are actions in that order, wherever they appear first.
  void sort_numeric_labels(std::vector<std::size_t>& action_of_label, std::vector<std::string>& names) const {
    std::vector<std::size_t> place(labels_.size());
    for (std::size_t i = 0; i < labels_.size(); ++i) {
      const auto value = parse_count(labels_[i]);
      if (!value || *value >= labels_.size() || std::to_string(*value) != labels_[i]) return;
      place[i] = *value;
    }
    action_of_label = place;
    for (std::size_t i = 0; i < labels_.size(); ++i) names[place[i]] = labels_[i];
  }

  /// The action of every choice; fills the actions' names.
  std::vector<std::size_t> assign_actions(std::vector<std::string>& names) const {
    names = labels_;
    std::vector<std::size_t> action_of_label(labels_.size());
    for (std::size_t i = 0; i < labels_.size(); ++i) action_of_label[i] = i;
    sort_numeric_labels(action_of_label, names);
    std::vector<std::size_t> action_of(choices_.size(), no_label);
    std::vector<std::size_t> taken_by(labels_.size(), no_label);  // the last state that has the action
    for (std::size_t s = 0; s < states(); ++s) {
      for (std::size_t c = first_choice(s); c < first_choice(s + 1); ++c) {
        if (choices_[c].label == no_label) continue;
        const std::size_t a = action_of_label[choices_[c].label];
        if (taken_by[a] == s) continue;  // a second choice of that label finds another action below
        taken_by[a] = s;
        action_of[c] = a;
      }
      std::size_t free = 0;
      for (std::size_t c = first_choice(s); c < first_choice(s + 1); ++c) {
        if (action_of[c] != no_label) continue;
        while (free < taken_by.size() && taken_by[free] == s) ++free;
        if (free == taken_by.size()) {
          names.push_back(fresh_name(names.size()));
          taken_by.push_back(s);
        }
        taken_by[free] = s;
        action_of[c] = free;
      }
    }
    return action_of;
  }

  /// The number of the action, made distinct from every label.
  std::string fresh_name(std::size_t number) const {
    std::string name = std::to_string(number);
    while (label_index_.count(name) > 0) name += "'";
    return name;
  }

  /// The choice behind every (state, action), state by state; what a state lacks is its first choice.
  std::vector<std::size_t> fill_actions(const std::vector<std::size_t>& action_of, std::size_t actions,
                                        std::vector<std::string>& notes) const {
    std::vector<std::size_t> choice_of(states() * actions, no_label);
    for (std::size_t s = 0; s < states(); ++s) {
      for (std::size_t c = first_choice(s); c < first_choice(s + 1); ++c) choice_of[s * actions + action_of[c]] = c;
    }
    std::size_t padded = 0, stored = 0;
    for (std::size_t row = 0; row < choice_of.size(); ++row) {
      if (choice_of[row] == no_label) {
        choice_of[row] = first_choice(row / actions);
        ++padded;
      }
      stored += first_branch(choice_of[row] + 1) - first_branch(choice_of[row]);
    }
    if (stored > options_.limits.transitions) {
      source_.fail(0, fmt::format("{} transitions once every state has every action, expected at most {}", stored,
                                  options_.limits.transitions));
    }
    if (padded > 0) {
      notes.push_back(
          fmt::format("actions: {} (state, action) pairs that the file lacks act as the state's first "
                      "choice, which leaves V* unchanged",
                      padded));
    }
    return choice_of;
  }

  void resolve_row(std::size_t c) {
    Scalar low(0), high(0);
    for (std::size_t b = first_branch(c); b < first_branch(c + 1); ++b) {
      const auto& p = branches_[b].probability;
      if (!(p.low >= Scalar(0) && p.low <= p.high && p.high <= Scalar(1))) {
        source_.fail(branches_[b].at,
                     fmt::format("interval [{},{}]: expected 0 <= lo <= hi <= 1",
                                 number_text(static_cast<double>(p.low)), number_text(static_cast<double>(p.high))));
      }
      low += p.low;
      high += p.high;
    }
    const Scalar rounding = FiniteMdpBuilder<Scalar>::row_tolerance();
    if (!(low <= Scalar(1) + rounding && high >= Scalar(1) - rounding)) {
      source_.fail(choices_[c].at,
                   fmt::format("intervals sum to [{},{}], expected 1 to lie between",
                               number_text(static_cast<double>(low)), number_text(static_cast<double>(high))));
    }
    const Scalar t = std::clamp(Scalar((Scalar(1) - low) / (high - low)), Scalar(0), Scalar(1));
    for (std::size_t b = first_branch(c); b < first_branch(c + 1); ++b) {
      auto& p = branches_[b].probability;
      p.low += t * (p.high - p.low);
      p.high = p.low;
    }
  }

  const Source& source_;
  const ReadOptions& options_;
  std::vector<std::size_t> state_begin_;
  std::vector<Choice> choices_;
  std::vector<Branch> branches_;
  std::vector<std::string> labels_;
  std::map<std::string, std::size_t, std::less<>> label_index_;
};

}  // namespace maximin::internal
