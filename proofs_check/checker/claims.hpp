#pragma once

#include "instances.hpp"
#include "sections.hpp"

namespace maximin::checker {

/// Shows every claim its instances. The functions are called as the sections of the certificate are verified.
class Claims {
 public:
  Claims(std::vector<ClaimCheck>& checks, const Model& model, const Constants& constants, bool paper,
         const Table& q_star, const std::vector<Pair>& pairs, std::size_t rounds);

  void of_round(const Round& round);
  void of_limit(const Limit* limit, const Table& last);
  void of_test_time(const Table& back_of_robust);
  void of_belief_game(const BeliefGame* game);

 private:
  ClaimCheck* find(ClaimId id);
  /// Those of them that are decided.
  std::vector<ClaimCheck*> find(std::initializer_list<ClaimId> ids);
  void expect_undetermined(std::initializer_list<ClaimId> ids, const char* why);
  Table lipschitz_sides(const Rational& factor) const;
  void of_phase(std::size_t j, const Limit& limit);
  Rational finite_n(const Rational& delta, std::size_t n) const;
  Rational limit_of_finite_n(const Rational& delta) const;

  std::vector<ClaimCheck>& checks_;
  const Model& m_;
  const Constants& c_;
  const Table& q_star_;
  const std::vector<Pair>& pairs_;
  std::vector<Table> gaps_, images_;  // by pair: Q* - back(robust), and back(s -> Q*(s,c(s)))
  std::size_t rounds_;
  Rational g_, rest_;              // and 1 - g
  Table right_print_, right_rep_;  // of lemma-1 and of its iterates, by (s,t)
  Rational delta_print_, delta_sound_, delta_rep_, delta_tv_, start_;
};

}  // namespace maximin::checker
