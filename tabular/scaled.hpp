#pragma once

#include <cstddef>
#include <vector>

#include <maximin/theory/finite_mdp.hpp>
#include <maximin/theory/rational.hpp>
#include <maximin/theory/types.hpp>

/// Exact arithmetic in bulk. A rational sum spends nearly all its time on common divisors; tables of integers over one
/// denominator need none until somebody asks for an entry.
namespace maximin {

/// x as an integer over `common`, a multiple of its denominator.
Integer over(const Rational& x, const Integer& common);

/// Values v(s) = numerators[s] / denominator, denominator > 0, not in lowest terms.
struct ScaledValues {
  std::vector<Integer> numerators;
  Integer denominator{1};

  ScaledValues() = default;
  /// The same values over their least common denominator.
  explicit ScaledValues(const Values<Rational>& v);

  Rational operator[](State s) const { return Rational(numerators[static_cast<std::size_t>(s)], denominator); }
  Values<Rational> rational() const;
};

/// A function of (state, action) over one denominator > 0, |S| x |A|, not in lowest terms.
struct ScaledTable {
  QTable<Integer> numerators;
  Integer denominator{1};

  Rational operator()(State s, Action a) const { return Rational(numerators(s, a), denominator); }
  QTable<Rational> rational() const;
};

/// s -> q(s, action[s]).
ScaledValues taken(const ScaledTable& q, const Policy& action);

/// x - y, over their denominator where they share it.
ScaledTable difference(const ScaledTable& x, const ScaledTable& y);

/// max |x - y|.
Rational distance(const ScaledTable& x, const ScaledTable& y);

/// A model in integers: probabilities over one denominator D_P, rewards over another, gamma = a/b.
class ScaledMdp {
 public:
  explicit ScaledMdp(const FiniteMdp<Rational>& mdp);

  State states() const { return states_; }
  Action actions() const { return actions_; }

  /// R + gamma P v, exactly. Its denominator is that of v, made a multiple of the rewards', times b D_P: from
  /// round to round it grows by the bits of b D_P.
  ScaledTable backup(const ScaledValues& v) const;

 private:
  struct Entry {
    State target;
    Integer weight;  ///< gamma's numerator times the probability's
  };

  State states_;
  Action actions_;
  std::vector<Integer> rewards_;  // over reward_denominator_
  Integer reward_denominator_{1};
  Integer growth_{1};                   // b D_P
  std::vector<std::size_t> row_begin_;  // |S||A| + 1 offsets
  std::vector<Entry> entries_;
};

}  // namespace maximin
