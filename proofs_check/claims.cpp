#include <maximin/proofs_check/claims.hpp>

#include <algorithm>

namespace maximin {

const std::array<Claim, claim_count>& claims() {
  static const std::array<Claim, claim_count> table{{
      {ClaimId::lemma_1, "lemma-1", "Q of a policy pair is Lipschitz", "paper, Lemma 1, equation 3",
       "|Q(s,a)-Q(t,a)| <= L |x_s-x_t|,  L = l_r + |S| l_p R_max/(1-g),  Q of pi_n under attack", false},
      {ClaimId::lemma_1_iterates, "lemma-1-iterates", "Q_n is Lipschitz", "used by the paper's proof of Lemma 2",
       "|Q_n(s,a)-Q_n(t,a)| <= (l_r + g |S| l_p R_max/(1-g)) |x_s-x_t|", false},
      {ClaimId::lemma_2, "lemma-2", "one pessimistic backup", "paper, Lemma 2, equation 4",
       "|T*Q_n - Q_{n+1}| <= Delta = 2 eps g (l_r + |S| l_p R_max/(1-g))", false},
      {ClaimId::lemma_3, "lemma-3", "a fixed pair contracts", "paper, Lemma 3",
       "|T^{pi o omega}Q_n - T^{pi o omega}Q*| <= g |Q_n - Q*|", false},
      {ClaimId::theorem_1, "theorem-1", "Theorem 1", "paper, Theorem 1",
       "limsup |Q* - Q^{pi_n o omega_n}| <= (1+g)/(1-g)^2 Delta", true},
      {ClaimId::a_optimal_attacker, "A", "Theorem 1, optimal attacker", "strengthening A",
       "limsup |Q* - Q^{pi_n, best attack}| <= (1+g)/(1-g)^2 Delta,  |R| <= R_max", true},
      {ClaimId::b_one_sided, "B", "without the factor 1+g", "strengthening B",
       "limsup |Q* - Q^{pi_n, best attack}| <= Delta/(1-g)^2,  |R| <= R_max", true},
      {ClaimId::c_finite_n, "C", "at every n", "strengthening C",
       "|Q* - Q^{pi_n, best attack}| <= [g(g^n(d_0+u_0) + D(1-g^n)/(1-g)) + D]/(1-g),  D = 2 eps g (l_r + g |S| l_p "
       "R_max/(1-g))",
       true},
      {ClaimId::d_total_variation, "D", "total variation, at every n", "strengthenings B, C and D",
       "as C, with D = 2 eps g (l_r + g K span(R)/(1-g))", true},
      {ClaimId::e_test_time, "E", "pessimism at test time", "strengthening E",
       "|Q* - Q^{pi*, best attack}| <= 2 eps g L*/(1-g),  pi* maximin for Q*", true},
      {ClaimId::f_belief, "F", "maximin over the belief", "strengthening F", "V*(s) - V^{belief}(s) <= rho L*/(1-g)",
       true},
  }};
  return table;
}

std::optional<ClaimId> find_claim(std::string_view name) {
  const auto& all = claims();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Claim& c) { return c.name == name; });
  if (found == all.end()) return std::nullopt;
  return found->id;
}

}  // namespace maximin
