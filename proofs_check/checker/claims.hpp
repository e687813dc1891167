#pragma once

#include "lipschitz.hpp"
#include "sections.hpp"

namespace maximin::checker {

/// Shows every claim its instances. The functions are called as the sections of the certificate are verified.
class Claims {
 public:
  Claims(std::vector<ClaimCheck>& checks, const Model& model, const Constants& constants, bool paper,
         const Optimal& optimal, std::size_t rounds);

  /// Of an exact certificate, before its rounds.
  void of_pairs(const std::vector<Pair>& pairs);
  void of_round(const Round& round);
  void of_limit(const Limit& limit, const Table& q_n);
  /// A round by bounds, or a phase of boxes.
  void of_box(const Box& box);
  void of_no_limit();
  void of_test_time(const Table& back_of_values);
  void of_belief_game(const BeliefGame* game);
  /// When all were seen: refuses the entries that are not borne out.
  void verify();

 private:
  ClaimCheck* find(ClaimId id);
  /// Those of them that are decided.
  std::vector<ClaimCheck*> find(std::initializer_list<ClaimId> ids);
  void expect_undetermined(std::initializer_list<ClaimId> ids, const char* why);
  void of_phase(std::size_t j, const Limit& limit);
  void see_finite_n(std::size_t n, const Table& gap, bool proves);
  void see_limit(std::size_t n, const Table& gap, bool proves);
  void see_theorem_1(std::size_t n, const Table& gap, bool proves);
  Table where_misled(const Table& values) const;

  std::vector<ClaimCheck>& checks_;
  const Model& m_;
  const Constants& c_;
  const Optimal& optimal_;
  const std::vector<Pair>* pairs_ = nullptr;
  std::vector<Table> gaps_, images_;  // by pair: Q* - back(robust), and back(s -> Q*(s,c(s)))
  std::size_t rounds_;
  Rational g_, rest_;                                 // and 1 - g
  std::optional<LipschitzCheck> lemma_1_, iterates_;  // where they are decided
  Rational delta_print_, delta_sound_, delta_rep_, delta_tv_, start_;
};

}  // namespace maximin::checker
