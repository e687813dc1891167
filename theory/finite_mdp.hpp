#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// A possible successor of a (state, action) pair and its probability.
template <class Scalar>
struct Successor {
  State target;        ///< s'
  Scalar probability;  ///< P(s'|s,a) > 0

  friend bool operator==(const Successor&, const Successor&) = default;
};

/// A finite Markov decision process <S, A, P, R, gamma> (paper, section 2.1) with every action available in every
/// state.
///
/// Transitions are compressed rows, one per (state, action), with targets ascending and probabilities positive; a dense
/// model just has full rows. The model knows nothing of balls: what perturbs it is a `Perturbation`.
///
/// Immutable, and valid by construction: made by `FiniteMdpBuilder`.
template <class Scalar>
class FiniteMdp {
 public:
  using scalar_type = Scalar;
  using Row = std::span<const Successor<Scalar>>;

  /// |S| >= 1.
  State states() const { return static_cast<State>(rewards_.rows()); }
  /// |A| >= 1.
  Action actions() const { return static_cast<Action>(rewards_.cols()); }
  /// gamma, 0 <= gamma < 1.
  const Scalar& discount() const { return discount_; }
  /// R(s,a).
  const Scalar& reward(State s, Action a) const { return rewards_(s, a); }
  /// R, |S| x |A|.
  const QTable<Scalar>& rewards() const { return rewards_; }

  /// P(.|s,a): the successors of (s,a), targets ascending, probabilities positive and summing to 1
  /// (exactly for an exact scalar, to rounding otherwise).
  Row successors(State s, Action a) const {
    const auto row = static_cast<std::size_t>(s) * static_cast<std::size_t>(actions()) + static_cast<std::size_t>(a);
    return Row(transitions_).subspan(row_begin_[row], row_begin_[row + 1] - row_begin_[row]);
  }

  /// Sum over s' of P(s'|s,a) v(s'), added in order of s'.
  template <class V>
  Scalar expectation(State s, Action a, const V& v) const {
    Scalar sum(0);
    for (const auto& next : successors(s, a)) sum += next.probability * v[next.target];
    return sum;
  }

  /// Number of stored transitions, all rows together.
  std::size_t transition_count() const { return transitions_.size(); }

  friend bool operator==(const FiniteMdp& x, const FiniteMdp& y) {
    return x.discount_ == y.discount_ && x.rewards_.rows() == y.rewards_.rows() &&
           x.rewards_.cols() == y.rewards_.cols() && x.rewards_ == y.rewards_ && x.row_begin_ == y.row_begin_ &&
           x.transitions_ == y.transitions_;
  }

 private:
  template <class>
  friend class FiniteMdpBuilder;
  FiniteMdp() = default;

  Scalar discount_{};
  QTable<Scalar> rewards_;
  std::vector<std::size_t> row_begin_;  // |S||A| + 1 offsets into transitions_
  std::vector<Successor<Scalar>> transitions_;
};

/// Collects rewards and transitions in any order, then checks and compresses them.
///
///     FiniteMdpBuilder<double> b(2, 1, 0.5);     // states, actions, discount
///     b.reward(0, 0, 1.0);                       // default 0
///     b.transition(0, 0, 1, 1.0);
///     b.transition(1, 0, 1, 1.0);
///     FiniteMdp<double> mdp = std::move(b).build();
template <class Scalar>
class FiniteMdpBuilder {
 public:
  /// Throws InputError unless states >= 1, actions >= 1 and 0 <= discount < 1.
  FiniteMdpBuilder(State states, Action actions, Scalar discount) : states_(states), actions_(actions) {
    if (states < 1) throw InputError("states: " + std::to_string(states) + ", expected at least 1");
    if (actions < 1) throw InputError("actions: " + std::to_string(actions) + ", expected at least 1");
    if (!(discount >= Scalar(0) && discount < Scalar(1))) {
      throw InputError("discount: outside the range, expected 0 <= discount < 1");
    }
    mdp_.discount_ = std::move(discount);
    mdp_.rewards_ = QTable<Scalar>::Constant(states, actions, Scalar(0));
  }

  /// Sets R(s,a); the last value set counts. Throws InputError on an index out of range or a value that is not finite.
  FiniteMdpBuilder& reward(State s, Action a, Scalar value) {
    check_index(s, a, "reward");
    if (!finite(value)) throw InputError("reward" + at(s, a) + ": not finite, expected a finite number");
    mdp_.rewards_(s, a) = std::move(value);
    return *this;
  }

  /// Adds P(target|s,a) = probability. Zero probabilities are dropped. Throws InputError on an index out of range,
  /// a negative or non-finite probability.
  FiniteMdpBuilder& transition(State s, Action a, State target, Scalar probability) {
    check_index(s, a, "transition");
    if (target < 0 || target >= states_) {
      throw InputError("transition" + at(s, a) + ": target " + std::to_string(target) +
                       " is not a state, expected 0 to " + std::to_string(states_ - 1));
    }
    if (!finite(probability) || probability < Scalar(0)) {
      throw InputError("transition" + at(s, a) + " -> " + std::to_string(target) +
                       ": probability is negative or not finite, expected a number from 0 to 1");
    }
    if (probability > Scalar(0)) entries_.push_back({s, a, {target, std::move(probability)}});
    return *this;
  }

  /// Checks that no (s,a,s') was given twice and that every row sums to 1: exactly for an exact scalar, otherwise to
  /// `row_tolerance()`. Throws InputError naming the first (s,a) at fault.
  FiniteMdp<Scalar> build() && {
    const auto before = [](const Entry& x, const Entry& y) {
      return std::tie(x.state, x.action, x.successor.target) < std::tie(y.state, y.action, y.successor.target);
    };
    // Most come in order, and sorting would double the memory that a model of millions of transitions takes.
    if (!std::is_sorted(entries_.begin(), entries_.end(), before)) {
      std::stable_sort(entries_.begin(), entries_.end(), before);
    }
    mdp_.row_begin_.reserve(static_cast<std::size_t>(states_) * static_cast<std::size_t>(actions_) + 1);
    mdp_.transitions_.reserve(entries_.size());
    mdp_.row_begin_.push_back(0);
    auto entry = entries_.begin();
    for (State s = 0; s < states_; ++s) {
      for (Action a = 0; a < actions_; ++a) {
        for (; entry != entries_.end() && entry->state == s && entry->action == a; ++entry) append(s, a, *entry);
        check_row(s, a);
        mdp_.row_begin_.push_back(mdp_.transitions_.size());
      }
    }
    entries_.clear();
    return std::move(mdp_);
  }

  /// How far a row may sum from 1 for an inexact scalar: rounding, no more. A file whose rows are further off must be
  /// repaired, and the repair reported, by whoever reads it.
  static Scalar row_tolerance() { return Scalar(4096) * unit_roundoff<Scalar>(); }

 private:
  struct Entry {
    State state;
    Action action;
    Successor<Scalar> successor;
  };

  static std::string at(State s, Action a) {
    return " (state " + std::to_string(s) + ", action " + std::to_string(a) + ")";
  }

  static bool finite(const Scalar& value) {
    if constexpr (is_exact_v<Scalar>) {
      return true;
    } else {
      return std::isfinite(value);
    }
  }

  void check_index(State s, Action a, const char* what) const {
    if (s >= 0 && s < states_ && a >= 0 && a < actions_) return;
    throw InputError(std::string(what) + at(s, a) + ": no such pair, expected states 0 to " +
                     std::to_string(states_ - 1) + " and actions 0 to " + std::to_string(actions_ - 1));
  }

  void append(State s, Action a, const Entry& entry) {
    const bool row_started = mdp_.transitions_.size() > mdp_.row_begin_.back();
    if (row_started && mdp_.transitions_.back().target == entry.successor.target) {
      throw InputError("transition" + at(s, a) + " -> " + std::to_string(entry.successor.target) +
                       ": given twice, expected each (state, action, target) once");
    }
    mdp_.transitions_.push_back(entry.successor);
  }

  void check_row(State s, Action a) const {
    if (mdp_.transitions_.size() == mdp_.row_begin_.back()) {
      throw InputError("transition" + at(s, a) + ": no transitions, expected probabilities that sum to 1");
    }
    Scalar sum(0);
    for (std::size_t i = mdp_.row_begin_.back(); i < mdp_.transitions_.size(); ++i)
      sum += mdp_.transitions_[i].probability;
    const Scalar excess = sum > Scalar(1) ? Scalar(sum - Scalar(1)) : Scalar(Scalar(1) - sum);
    if (!(excess <= row_tolerance())) {
      throw InputError("transition" + at(s, a) + ": probabilities sum to " + std::to_string(static_cast<double>(sum)) +
                       ", expected 1");
    }
  }

  State states_;
  Action actions_;
  std::vector<Entry> entries_;
  FiniteMdp<Scalar> mdp_;
};

}  // namespace maximin
