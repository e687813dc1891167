#pragma once

#include <optional>
#include <utility>
#include <vector>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/proofs_check/certificate/exact_geometry.hpp>
#include <maximin/tabular/scaled.hpp>

namespace maximin {

/// An instance of a claim: both sides, and where it stands.
struct Instance {
  Rational left, right;
  long n = -1;
  std::vector<State> states = {};
  Action action = -1;
  bool decisive = true;  ///< whether left > right would refute the claim, and not only leave it open

  Rational slack() const { return right - left; }
};

/// Keeps the instance of least right - left, the first of several, and so among the decisive ones.
class Tightest {
 public:
  void observe(Instance instance) {
    if (instance.decisive) keep(decisive_, instance);
    keep(tightest_, std::move(instance));
  }

  /// Something that the claim speaks of was not decided: then nothing is said of it, even where it is violated
  /// elsewhere.
  void undecided() { undecided_ = true; }

  /// Takes in what the other has seen.
  void join(const Tightest& other);

  /// `exact`: whether right sides are the claim's own and not rounded down.
  CertifiedClaim verdict(ClaimId id, bool exact) const;

 private:
  static void keep(std::optional<Instance>& kept, Instance instance) {
    if (!kept || instance.slack() < kept->slack()) kept = std::move(instance);
  }

  std::optional<Instance> tightest_, decisive_;
  bool undecided_ = false;
};

/// Where x is largest, as the left side of an instance at n.
Instance largest_entry(const ScaledTable& x, long n, const Rational& right);

/// Where x - y is largest, as the left side of an instance at n.
Instance largest_difference(const ScaledTable& x, const ScaledTable& y, long n, const Rational& right);

/// The Lipschitz property of a table, |q(s,a) - q(t,a)| + c TV(s,t,a) <= right(s,t), TV the total variation between the
/// rows of s and t: finds its tightest instance in table after table.
class LipschitzCheck {
 public:
  /// `right`: the right side for each pair at finite distance, |S| x |S|.
  LipschitzCheck(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry, const QTable<Rational>& right);

  /// The tightest instance; 0 <= 0 at no place where no two states are at finite distance. `decisive` only where
  /// nothing is added.
  Instance tightest(const ScaledTable& q, const Rational& c, long n) const;

 private:
  struct Pair {
    State s, t;
    Integer right;                 ///< over right_denominator_
    std::vector<Integer> spreads;  ///< TV(s,t,a) by action, over spread_denominator_
  };
  std::vector<Pair> pairs_;
  Integer right_denominator_{1}, spread_denominator_{1};
};

}  // namespace maximin
