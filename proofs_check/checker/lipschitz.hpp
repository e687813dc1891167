#pragma once

#include "instances.hpp"

namespace maximin::checker {

/// Shows lemma-1, or that of the iterates, its instances: for every s < t at a finite distance and every a,
/// |X(s,a) - X(t,a)| + slack sum_s' |P(s'|s,a) - P(s'|t,a)| is at most r(s,t) + factor p(s,t).
class LipschitzCheck {
 public:
  LipschitzCheck(ClaimCheck& claim, const Model& model, const Rational& l_r, const Rational& l_p,
                 const Rational& factor);

  /// Instances named by n. One proves a violation where `proves` and nothing is added.
  void see(std::size_t n, const Table& x, const Rational& slack, bool proves);

  /// Looks at the pairs for all tables that were seen, of which so many wait as fit into the model's most_bits.
  void look();

 private:
  struct Waiting {
    std::size_t n;
    Table x;
    Integer of_x, of_row, bottom;  // a left side is x.top * of_x + RowDifference::sum * of_row, over bottom
    Rational spread;               // no left side is larger
    Integer below;                 // a gap below it, over bottom * right_bottom_, is less than least_
  };

  Rational right(std::size_t s, std::size_t t, const Rational& near, const std::vector<RowDifference>& rows) const;
  void look_at(std::size_t s, std::size_t t, const Integer& length);
  bool find_left(const Waiting& table, std::size_t s, std::size_t t, std::size_t a, const RowDifference& row,
                 Integer& left) const;
  void learn(const Rational& least);

  ClaimCheck& claim_;
  const Model& m_;
  Rational l_r_, l_p_, factor_;
  Integer right_bottom_;
  std::vector<Waiting> waiting_;
  std::size_t waiting_bits_ = 0;
  std::optional<Rational> least_;    // right - left, of all that was looked at
  std::optional<Integer> farthest_;  // beyond that length no pair can have less
};

}  // namespace maximin::checker
