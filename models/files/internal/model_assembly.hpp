#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <maximin/models/files/internal/number.hpp>
#include <maximin/models/files/internal/source.hpp>
#include <maximin/models/files/read_options.hpp>
#include <maximin/theory/finite_mdp.hpp>

namespace maximin::internal {

/// Fails unless states and actions are at least one and |S||A| is within the limits. Call it before allocating.
inline void require_size(const Source& source, std::size_t at, std::uint64_t states, std::uint64_t actions,
                         const ReadLimits& limits) {
  if (states < 1) source.fail(at, "0 states, expected at least 1");
  if (actions < 1) source.fail(at, "0 actions, expected at least 1");
  if (states > limits.pairs || actions > limits.pairs || states * actions > limits.pairs) {
    source.fail(at, fmt::format("{} states and {} actions are too many, expected at most {} (state, action) pairs",
                                states, actions, limits.pairs));
  }
}

/// sum of weight * value over the terms, or the value itself where all terms agree on it: a reward that does not depend
/// on the successor is kept to the last bit.
template <class Scalar>
class WeightedMean {
 public:
  void add(const Scalar& weight, const Scalar& value) {
    if (!first_) first_ = value;
    if (value != *first_) all_equal_ = false;
    sum_ += weight * value;
  }
  Scalar value() const { return first_ && all_equal_ ? *first_ : sum_; }

 private:
  std::optional<Scalar> first_;
  bool all_equal_ = true;
  Scalar sum_{0};
};

/// How far a sum of probabilities is from 1, when that is more than rounding; nothing when it is not.
template <class Scalar>
std::optional<Scalar> defect_of(const Scalar& sum) {
  const Scalar defect = sum > Scalar(1) ? Scalar(sum - Scalar(1)) : Scalar(Scalar(1) - sum);
  if (defect <= FiniteMdpBuilder<Scalar>::row_tolerance()) return std::nullopt;
  return defect;
}

/// What is said of a sum that is not 1.
template <class Scalar>
std::string wrong_sum(const Source& source, const Scalar& sum) {
  return fmt::format("probabilities sum to {}, expected 1{}", number_text(static_cast<double>(sum)),
                     source.hint_on_sums());
}

/// The discount to use: the one asked for, else the one in the file, else the default with a note.
template <class Scalar>
Scalar choose_discount(const Source& source, const ReadOptions& options, const std::optional<Scalar>& in_file,
                       std::size_t at, std::vector<std::string>& notes) {
  const auto exact = [](double value) {
    Scalar out(0);
    parse_number(fmt::format("{}", value), out);
    return out;
  };
  if (options.discount) {
    const double asked = *options.discount;
    if (!(asked >= 0 && asked < 1)) {
      throw InputError(fmt::format("discount {}: outside the range, expected 0 <= discount < 1", asked));
    }
    if (in_file && *in_file != exact(asked)) {
      notes.push_back(fmt::format("discount: {} as asked for, instead of {} in the file", asked,
                                  number_text(static_cast<double>(*in_file))));
    }
    return exact(asked);
  }
  if (!in_file) {
    notes.push_back(fmt::format("discount: the file gives none, {} assumed; choose one with --discount",
                                ReadOptions::default_discount));
    return exact(ReadOptions::default_discount);
  }
  if (!(*in_file >= Scalar(0) && *in_file < Scalar(1))) {
    source.fail(at, fmt::format("discount {}: outside the range, expected 0 <= discount < 1; choose one with "
                                "--discount, e.g. --discount {}",
                                number_text(static_cast<double>(*in_file)), ReadOptions::default_discount));
  }
  return *in_file;
}

/// Collects what a reader finds and makes a FiniteMdp of it, with every error told at its place in the file.
template <class Scalar>
class ModelAssembly {
 public:
  /// `slack`: rows that miss 1 by at most this are scaled, and a note says so; rows further off are an error.
  ModelAssembly(const Source& source, const ReadLimits& limits, State states, Action actions, Scalar slack)
      : source_(source), limits_(limits), states_(states), actions_(actions), slack_(std::move(slack)) {
    rewards_ = QTable<Scalar>::Constant(states, actions, Scalar(0));
  }

  /// Adds P(target|s,a), found at that place. The indices must be in range.
  void transition(State s, Action a, State target, Scalar probability, std::size_t at) {
    if (!(probability >= Scalar(0) && probability <= Scalar(1) + slack_)) {
      source_.fail(at, fmt::format("probability {}: outside the range, expected 0 to 1",
                                   number_text(static_cast<double>(probability))));
    }
    if (entries_.size() >= limits_.transitions) {
      source_.fail(at, fmt::format("more than {} transitions, expected fewer", limits_.transitions));
    }
    entries_.push_back({s, a, target, std::move(probability), at});
  }

  void reward(State s, Action a, Scalar value) { rewards_(s, a) = std::move(value); }
  Scalar& reward(State s, Action a) { return rewards_(s, a); }

  /// `at` is where missing rows are reported.
  FiniteMdp<Scalar> build(Scalar discount, std::size_t at, std::vector<std::string>& notes) && {
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& x, const Entry& y) {
      return std::tie(x.state, x.action, x.target) < std::tie(y.state, y.action, y.target);
    });
    FiniteMdpBuilder<Scalar> builder(states_, actions_, std::move(discount));
    std::size_t next = 0;
    for (State s = 0; s < states_; ++s) {
      for (Action a = 0; a < actions_; ++a) {
        const std::size_t begin = next;
        while (next < entries_.size() && entries_[next].state == s && entries_[next].action == a) ++next;
        if (begin == next) {
          source_.fail(at, row(s, a) + ": no transitions, expected probabilities that sum to 1");
        }
        repair(begin, next);
        for (std::size_t i = begin; i < next; ++i)
          builder.transition(s, a, entries_[i].target, entries_[i].probability);
        set_reward(builder, s, a, entries_[begin].at);
      }
    }
    if (repaired_ > 0) {
      const auto defect = static_cast<double>(largest_defect_);
      notes.push_back(fmt::format("{} of {} rows {}; they were scaled to sum to 1", repaired_,
                                  static_cast<std::size_t>(states_) * static_cast<std::size_t>(actions_),
                                  defect > 0 ? fmt::format("summed to 1 only within {:.2g}", defect)
                                             : "missed a sum of 1 by less than any double shows"));
    }
    return finish(std::move(builder));
  }

 private:
  struct Entry {
    State state;
    Action action;
    State target;
    Scalar probability;
    std::size_t at;
  };

  static std::string row(State s, Action a) { return fmt::format("state {}, action {}", s, a); }

  void repair(std::size_t begin, std::size_t end) {
    Scalar sum(0);
    for (std::size_t i = begin; i < end; ++i) {
      const Entry& entry = entries_[i];
      if (i > begin && entry.target == entries_[i - 1].target) {
        source_.fail(entry.at, fmt::format("{}, target {}: given twice, expected each (state, action, target) once",
                                           row(entry.state, entry.action), entry.target));
      }
      sum += entry.probability;
    }
    const std::optional<Scalar> defect = defect_of(sum);
    if (!defect) return;
    if (!(*defect <= slack_)) {
      source_.fail(entries_[begin].at,
                   row(entries_[begin].state, entries_[begin].action) + ": " + wrong_sum(source_, sum));
    }
    for (std::size_t i = begin; i < end; ++i) entries_[i].probability = Scalar(entries_[i].probability / sum);
    ++repaired_;
    if (*defect > largest_defect_) largest_defect_ = *defect;
  }

  void set_reward(FiniteMdpBuilder<Scalar>& builder, State s, Action a, std::size_t at) const {
    try {
      builder.reward(s, a, rewards_(s, a));
    } catch (const InputError& error) {
      source_.fail(at, error.what());
    }
  }

  FiniteMdp<Scalar> finish(FiniteMdpBuilder<Scalar> builder) const {
    try {
      return std::move(builder).build();
    } catch (const InputError& error) {
      source_.fail(0, error.what());
    }
  }

  const Source& source_;
  const ReadLimits& limits_;
  State states_;
  Action actions_;
  Scalar slack_;
  QTable<Scalar> rewards_;
  std::vector<Entry> entries_;
  std::size_t repaired_ = 0;
  Scalar largest_defect_{0};
};

}  // namespace maximin::internal
