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
  /// Reads an entry; `rounds` is how many rounds and phases can be named. By bounds nothing is ever violated.
  ClaimCheck(const Node& node, const Model& model, std::size_t rounds, bool bounds);

  ClaimId id() const { return id_; }
  const std::string& path() const { return path_; }
  const Place& place() const { return at_; }
  bool undetermined() const { return verdict_ == undetermined_; }
  bool wants_violations() const { return verdict_ == violated_; }
  ClaimVerdict verdict() const;

  /// One instance: left <= right is claimed. `proves`: where it is violated, the claim is.
  void see(const Place& place, const Rational& left, const Rational& right, bool proves = true);

  /// For every s and a, left(s,a) <= right. Of a table `added`, what is in left(s,a) and only bounds it: an instance
  /// proves a violation where that is 0.
  void see_each(std::size_t n, const Table& left, const Rational& right, bool proves = true,
                const Table* added = nullptr);

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
std::vector<ClaimCheck> read_claims(const Node& node, const Model& model, std::size_t rounds, bool bounds);

/// The names of the claims that have no entry.
std::vector<std::string> left_out(const std::vector<ClaimCheck>& claims, bool bounds);

}  // namespace maximin::checker
