#pragma once

#include <optional>

#include "model.hpp"

namespace maximin::checker {

/// The claims, in their order.
enum class ClaimId { lemma_1, lemma_1_iterates, lemma_2, lemma_3, theorem_1, a, b, c, d, e, f };

/// What names an instance; `none` is what it does not have.
struct Place {
  static constexpr std::size_t none = static_cast<std::size_t>(-1);
  std::size_t n = none, s = none, t = none, a = none;

  bool operator==(const Place&) const = default;
};

/// A claim of the section "claims" that is not undetermined: it is shown all instances, keeps the tightest, and then
/// says whether the entry is true. Of a violated claim only the instances that prove a violation are looked at.
class ClaimCheck {
 public:
  /// Reads an entry; `rounds` is how many rounds and phases can be named.
  ClaimCheck(const Node& node, const Model& model, std::size_t rounds);

  ClaimId id() const { return id_; }
  const std::string& path() const { return path_; }
  bool undetermined() const { return verdict_ == undetermined_; }
  ClaimVerdict verdict() const;

  /// One instance: left <= right is claimed. `proves`: where it is violated, the claim is.
  void see(const Place& place, const Rational& left, const Rational& right, bool proves = true);

  /// For every s and a, left(s,a) + more <= right.
  void see_each(std::size_t n, const Table& left, const Rational& more, const Rational& right, bool proves = true);

  /// For every s < t at a finite distance and every a, |x(s,a) - x(t,a)| + slack sum_s' |P(s'|s,a) - P(s'|t,a)| is at
  /// most right(s,t). An instance proves a violation where nothing is added.
  void see_pairs(std::size_t n, const Table& x, const Rational& slack, const Table& right);

  /// Refuses the entry where the instances that were seen do not bear it out.
  void verify() const;

 private:
  enum Verdict { holds_, violated_, undetermined_ };

  void read_place(const Node& at, std::size_t rounds);

  const Model& model_;
  std::string path_;
  ClaimId id_;
  Verdict verdict_;
  Rational left_, right_;  // as the entry has them
  Place at_;
  std::optional<Rational> least_, least_named_;  // right - left: of all instances, and of those at at_
};

/// Reads the section: entries in the order of the claims, none twice.
std::vector<ClaimCheck> read_claims(const Node& node, const Model& model, std::size_t rounds);

/// The names of the claims that have no entry.
std::vector<std::string> left_out(const std::vector<ClaimCheck>& claims);

}  // namespace maximin::checker
