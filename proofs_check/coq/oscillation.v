(** * Sharper than theory.md: only states that the attacker can confuse matter, and no distance at all

    Put w_r = max |R(m,a) - R(m',a)| and w_p = max TV(P(.|m,a), P(.|m',a)) over all m, m' that share a ball. Then
    Delta may be gamma (w_r + gamma w_p span(R)/(1-gamma)): never more than 2 eps gamma L_tv, since w_r <= 2 eps l_r and
    w_p <= 2 eps K, and free of any constant that states far apart can spoil. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators lipschitz pessimism.
From Maximin Require bounds.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** C++: has no such function yet. *)
Definition delta_near (R : realFieldType) (g w_r w_p span : R) := g * (w_r + g * w_p * span / (1 - g)).

Section Oscillation.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Local Notation gamma := (discount M).

Variables w_r w_p span : R.
Hypothesis R_near : oscillation B w_r (reward M).
Hypothesis P_near : forall t m m' a, m \in ball B t -> m' \in ball B t ->
  (\sum_s' `|prob M m a s' - prob M m' a s'|) / 2 <= w_p.
Hypothesis R_span : has_span span (reward M).
Local Notation Delta_near := (delta_near gamma w_r w_p span).

Variables (Qstar : S -> A -> R) (Q : nat -> S -> A -> R) (pi : nat -> S -> A) (om : nat -> S -> S).
Variable Qrob : nat -> S -> A -> R.
Hypothesis Qstar_fixed : fixed_point (T_star M) Qstar.
Hypothesis iteration : pessimistic_iteration M B Q pi om.
Hypothesis start : forall s a, Q 0%N s a = 0.
Hypothesis Qrob_fixed : forall n, fixed_point (T_rob M B (pi n)) (Qrob n).

Fact near_backup V c : (forall s1 s2, V s1 - V s2 <= c) -> oscillation B (w_r + gamma * w_p * c) (backup M V).
Proof.
move=> Vc t m m' a tm tm'; have c_ge0 : 0 <= c by rewrite -(subrr (V t)).
rewrite /backup opprD addrACA -mulrBr (le_trans (ler_norm_add _ _)) // ler_add ?(R_near _ tm tm') //.
rewrite normrM ger0_norm ?discount_ge0 // -mulrA ler_wpmul2l ?discount_ge0 // (le_trans (mean_tv M m m' a Vc)) //.
by rewrite ler_wpmul2r // (P_near _ tm tm').
Qed.

(** Lemma 2 with Delta_near. *)
Theorem near_lemma_2 n s a : 0 <= T_star M (Q n) s a - Q n.+1 s a <= Delta_near.
Proof.
rewrite subr_ge0 (round_below_star iteration) ler_subl_addl.
have [max_pi br ->] := iteration n; rewrite -(T_rob_best_response _ _ _ br).
apply: oscillation_backup max_pi => {s a}; case: n {br} => [|n] t m m' a tm tm'.
  rewrite !start subrr normr0 addr_ge0 //; first exact: le_trans (R_near a tm tm').
  have wp_ge0 : 0 <= w_p by apply: le_trans (P_near a tm tm'); rewrite divr_ge0 ?ler0n ?sumr_ge0.
  by rewrite mulr_ge0 ?invr_ge0 ?(ltW (discount_rest M)) // !mulr_ge0 ?discount_ge0 // (span_ge0 R_span).
have [_ _ step] := iteration n; rewrite !step -mulrA; apply: near_backup tm tm'.
apply: read_off_span (pair_read_off (Q n) (pi n) (om n)) _.
exact (iterates_span R_span iteration (zero_span R_span start) n).
Qed.

(** C with Delta_near. *)
Theorem near_finite_n n :
  excess Qstar (Qrob n) <= bounds.finite_n gamma Delta_near (excess Qstar (Q 0%N)) (excess (Q 0%N) Qstar) n.
Proof.
apply: (finite_n_gap iteration Qstar_fixed) (Qrob_fixed n) => k s a.
by have /andP[_] := near_lemma_2 k s a; rewrite ler_subl_addl.
Qed.

(** E with the oscillation of Q* inside balls in the place of 2 eps L*. *)
Theorem near_test_time w p Qr : oscillation B w Qstar -> maximin_policy B Qstar p -> fixed_point (T_rob M B p) Qr ->
  distance Qstar Qr <= gamma * w / (1 - gamma).
Proof.
move=> Qw max_p fixr; apply: distance_le (state_0 M) (action_0 M) => s a.
rewrite ger0_norm ?subr_ge0 ?(rob_le_star fixr Qstar_fixed) // ler_subl_addl.
apply: below_fixed (shrinks_T_rob M B p) fixr _ s a => {}s {}a.
by rewrite Qstar_fixed; apply: oscillation_backup.
Qed.
End Oscillation.

(** Delta_near is never larger than Delta_tv: 2 eps l_r and 2 eps K may serve as w_r and w_p, and give just Delta_tv. *)
Theorem near_never_larger (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S) (l_r k_tv span : R) :
  lipschitz B l_r (reward M) -> lipschitz_tv M B k_tv ->
  [/\ oscillation B (2 * eps B * l_r) (reward M),
      forall t m m' a, m \in ball B t -> m' \in ball B t ->
        (\sum_s' `|prob M m a s' - prob M m' a s'|) / 2 <= 2 * eps B * k_tv &
      delta_near (discount M) (2 * eps B * l_r) (2 * eps B * k_tv) span
      = bounds.delta (eps B) (discount M) (bounds.lipschitz_of_q_tv (discount M) l_r k_tv span)].
Proof.
move=> Rl [k_ge0 Pl]; split; first exact: lipschitz_oscillation.
  move=> t m m' a tm tm'; rewrite (le_trans (Pl m m' a)) // [leRHS]mulrC ler_wpmul2l //.
  exact: ball_width tm tm'.
rewrite /bounds.delta /delta_near [RHS]mulrAC [RHS]mulrC; congr (_ * _); rewrite mulrDr; congr (_ + _).
by rewrite -!mulrA [LHS]mulrCA; congr (2 * _); rewrite [LHS]mulrCA.
Qed.
