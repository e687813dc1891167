#pragma once

#include <array>
#include <optional>
#include <string_view>

namespace maximin {

/// The claims that are checked, in the order they are reported.
enum class ClaimId {
  lemma_1,           ///< Q^{pi_n o omega_n} is Lipschitz
  lemma_1_iterates,  ///< every Q_n is Lipschitz: what the proof of Lemma 2 uses
  lemma_2,           ///< |T*Q_n - Q_{n+1}| <= Delta
  lemma_3,           ///< T^{pi o omega} of a fixed pair is a contraction
  theorem_1,         ///< limsup |Q* - Q^{pi_n o omega_n}| <= (1+gamma)/(1-gamma)^2 Delta
  a_optimal_attacker,
  b_one_sided,
  c_finite_n,
  d_total_variation,
  e_test_time,
  f_belief,
};

inline constexpr std::size_t claim_count = 11;

/// One claim, for people and for tables.
struct Claim {
  ClaimId id;
  std::string_view name;       ///< on command lines and in files
  std::string_view title;      ///< a few words
  std::string_view reference;  ///< where it is stated
  std::string_view statement;  ///< the inequality
  bool is_bound;  ///< a bound on what pessimism costs, that can be vacuous; otherwise a step of the argument
};

/// All claims, indexed by ClaimId.
const std::array<Claim, claim_count>& claims();

inline const Claim& claim(ClaimId id) {
  return claims()[static_cast<std::size_t>(id)];
}

/// The claim of that name, if there is one.
std::optional<ClaimId> find_claim(std::string_view name);

/// Which R_max the claims of the paper are read with.
enum class Reading {
  paper,      ///< as printed, R <= R_max (Assumption 2): R_max = max(0, max R)
  corrected,  ///< |R| <= R_max, what the proof needs: R_max = max |R|
};

}  // namespace maximin
