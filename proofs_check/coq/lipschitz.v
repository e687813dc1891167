(** * Lipschitz constants of values: every backup of values of span c is Lipschitz with l_r + gamma K c *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators.
From Maximin Require bounds.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Lipschitz.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Variables (l_r k span : R).
Hypotheses (Rlip : lipschitz B l_r (reward M)) (Plip : lipschitz_tv M B k) (Rspan : has_span span (reward M)).
Implicit Types (V : S -> R) (Q : S -> A -> R).
Local Notation g := (discount M).
Local Notation L_tv := (bounds.lipschitz_of_q_tv g l_r k span).

(** A number between lo and hi is at most half of hi - lo away from the middle. *)
Fact from_middle (lo hi v c : R) : lo <= v -> v <= hi -> hi - lo <= c -> `|v - (hi + lo) / 2| <= c / 2.
Proof.
move=> lo_v v_hi; rewrite ler_subl_addr => hi_c; rewrite ler_distl -mulrBl -mulrDl.
rewrite ler_pdivr_mulr ?ltr0n // ler_pdivl_mulr ?ltr0n // mulr_natr mulr2n ler_subl_addr.
apply/andP; split; first by rewrite -addrA addrC ler_add // (le_trans hi_c) // addrC ler_add2r.
by rewrite -addrA ler_add // (le_trans v_hi) // addrC.
Qed.

(** The means of V under two rows of total variation tv differ by at most tv times the span of V: P - P' sums to zero, so
    V may be centred, and is then nowhere larger than half its span. *)
Lemma mean_tv V c s t a : (forall s1 s2, V s1 - V s2 <= c) ->
  `|\sum_s' prob M s a s' * V s' - \sum_s' prob M t a s' * V s'|
    <= (\sum_s' `|prob M s a s' - prob M t a s'|) / 2 * c.
Proof.
move=> Vc; have [s1 top] := maximum_attained V s.
have [s2 _ bottom] := @minimum_attained R S setT V s (in_setT s).
pose mid := (maximum V + minimum setT V) / 2.
have -> : \sum_s' prob M s a s' * V s' - \sum_s' prob M t a s' * V s' =
    \sum_s' (prob M s a s' - prob M t a s') * (V s' - mid).
  under [RHS]eq_bigr do rewrite mulrBr; rewrite sumrB -mulr_suml sumrB !prob_sum subrr mul0r subr0 -sumrB.
  by apply: eq_bigr => s' _; rewrite mulrBl.
apply: le_trans (ler_norm_sum _ _ _) _; rewrite -mulrA mulr_suml; apply: ler_sum => s' _.
rewrite normrM ler_wpmul2l // [_ * c]mulrC from_middle ?maximum_ge ?minimum_le ?inE //.
by rewrite top bottom.
Qed.

(** Whatever the values V, as long as their span is at most c. *)
Lemma backup_lipschitz V c : (forall s1 s2, V s1 - V s2 <= c) -> lipschitz B (l_r + g * k * c) (backup M V).
Proof.
move=> Vc; have c_ge0 : 0 <= c by rewrite -(subrr (V (state_0 M))).
case: Rlip Plip => [lr_ge0 Rl] [k_ge0 Pl]; split; first by rewrite addr_ge0 // !mulr_ge0 ?discount_ge0.
move=> s t a; rewrite /backup opprD addrACA -mulrBr mulrDl.
apply: le_trans (ler_norm_add _ _) _; rewrite ler_add // normrM ger0_norm ?discount_ge0 //.
rewrite -!mulrA ler_wpmul2l ?discount_ge0 //. apply: le_trans (mean_tv s t a Vc) _.
by rewrite [c * _]mulrC mulrA ler_wpmul2r.
Qed.

Lemma backup_span V c : (forall s1 s2, V s1 - V s2 <= c) -> has_span (span + g * c) (backup M V).
Proof.
move=> Vc s a s' a'; rewrite /backup opprD addrACA -mulrBr ler_add // ler_wpmul2l ?discount_ge0 //.
have [s2 _ bottom] := @minimum_attained R S setT V s (in_setT s).
have le_min : \sum_s1 prob M s a s1 * V s1 <= \sum_s1 prob M s a s1 * V s2 + c.
  by apply: mean_le => s1; rewrite -ler_subl_addl.
rewrite ler_subl_addr addrC (le_trans le_min) //.
rewrite ler_add2r -mulr_suml prob_sum mul1r -[leLHS]mul1r -(prob_sum M s' a') mulr_suml.
by apply: ler_sum => s1 _; rewrite ler_wpmul2l ?prob_ge0 // -bottom minimum_le ?inE.
Qed.

(** V is read off Q: every value is one of Q's. So are max_a Q(.,a), Q(., pi(om(.))) and min_{t in B(.)} Q(., pi(t)). *)
Definition read_off Q V := forall s, exists a, V s = Q s a.

Lemma greedy_read_off Q : read_off Q (greedy_values Q).
Proof. by move=> s; apply: maximum_attained (action_0 M). Qed.

Lemma pair_read_off Q pi om : read_off Q (pair_values pi om Q).
Proof. by move=> s; exists (pi (om s)). Qed.

Lemma attacked_read_off Q pi : read_off Q (attacked_values B pi Q).
Proof.
move=> s; have [t _ min_t] := minimum_attained (fun t => Q s (pi t)) (ball_centre B s).
by exists (pi t).
Qed.

Lemma read_off_span Q V c : read_off Q V -> has_span c Q -> forall s1 s2, V s1 - V s2 <= c.
Proof. by move=> QV Qc s1 s2; have [[a ->] [a' ->]] := (QV s1, QV s2). Qed.

Lemma span_ge0 : 0 <= span.
Proof. by rewrite -(subrr (reward M (state_0 M) (action_0 M))). Qed.

(** span(R) + g span(R)/(1-g) = span(R)/(1-g) *)
Lemma span_step : span + g * (span / (1 - g)) = span / (1 - g).
Proof.
have /lt0r_neq0 := discount_rest M; move: (1 - g) (subrK g 1) => h g_h h0.
by apply: (mulIf h0); rewrite mulrDl mulrA !divfK // [g * _]mulrC -mulrDr g_h mulr1.
Qed.

(** A table that is the backup of values read off itself has the span of a discounted sum of rewards. *)
Lemma fixed_span Q V : read_off Q V -> (forall s a, Q s a = backup M V s a) -> has_span (span / (1 - g)) Q.
Proof.
move=> QV fixQ; pose spread (x : (S * A) * (S * A)) := Q x.1.1 x.1.2 - Q x.2.1 x.2.2.
have Qc : has_span (maximum spread) Q.
  by move=> s a s' a'; apply: (@maximum_ge _ _ spread ((s, a), (s', a'))).
suff le_span : maximum spread <= span / (1 - g) by move=> s a s' a'; apply: le_trans le_span.
rewrite ler_pdivl_mulr ?discount_rest // mulrBr mulr1 ler_subl_addr mulrC.
have [[[s a] [s' a']] top] := maximum_attained spread ((state_0 M, action_0 M), (state_0 M, action_0 M)).
by rewrite {1}top /spread /= !fixQ; apply: backup_span; apply: read_off_span QV Qc.
Qed.

Lemma fixed_lipschitz Q V : read_off Q V -> (forall s a, Q s a = backup M V s a) -> lipschitz B L_tv Q.
Proof.
move=> QV fixQ; have [L_ge0 Ll] := backup_lipschitz (read_off_span QV (fixed_span QV fixQ)).
by rewrite /bounds.lipschitz_of_q_tv -mulrA; split=> // s t a; rewrite !fixQ; apply: Ll.
Qed.

(** Every iterate: the span stays below span(R)/(1-g) if it starts there. *)
Lemma iterates_span (Q : nat -> S -> A -> R) pi om :
  pessimistic_iteration M B Q pi om -> has_span (span / (1 - g)) (Q 0%N) -> forall n, has_span (span / (1 - g)) (Q n).
Proof.
move=> iterQ Q0 n; elim: n => // n Qn s a s' a'; have [_ _ step] := iterQ n.
by rewrite !step -span_step; apply: backup_span; apply: read_off_span (pair_read_off (Q n) (pi n) (om n)) Qn.
Qed.

Lemma iterates_lipschitz (Q : nat -> S -> A -> R) pi om :
  pessimistic_iteration M B Q pi om -> has_span (span / (1 - g)) (Q 0%N) -> lipschitz B L_tv (Q 0%N) ->
  forall n, lipschitz B L_tv (Q n).
Proof.
move=> iterQ Q0_span Q0_lip [//|n]; have [_ _ step] := iterQ n.
have Vc := read_off_span (pair_read_off (Q n) (pi n) (om n)) (iterates_span iterQ Q0_span n).
have [L_ge0 Ll] := backup_lipschitz Vc; rewrite /bounds.lipschitz_of_q_tv -mulrA.
by split=> // s t a; rewrite !step; apply: Ll.
Qed.

(** Q_0 = 0 is such a start. *)
Lemma zero_span Q : (forall s a, Q s a = 0) -> has_span (span / (1 - g)) Q.
Proof. by move=> Q0 s a s' a'; rewrite !Q0 subrr divr_ge0 ?span_ge0 // ltW ?discount_rest. Qed.

Lemma zero_lipschitz Q : (forall s a, Q s a = 0) -> lipschitz B L_tv Q.
Proof.
move=> Q0; case: Rlip Plip => [lr_ge0 Rl] [k_ge0 Pl].
have rest_ge0 : 0 <= g * (span / (1 - g)) by rewrite mulr_ge0 ?discount_ge0 ?divr_ge0 ?span_ge0 // ltW ?discount_rest.
have -> : L_tv = l_r + g * (span / (1 - g)) * k.
  by rewrite /bounds.lipschitz_of_q_tv -!mulrA; congr (_ + g * _); rewrite mulrC -mulrA.
split=> [|s t a]; first by rewrite addr_ge0 // mulr_ge0.
rewrite !Q0 subrr normr0 mulrDl -[_ * k * _]mulrA addr_ge0 //; first exact: le_trans (Rl s t a).
by rewrite mulr_ge0 //; apply: le_trans (Pl s t a); rewrite divr_ge0 ?ler0n ?sumr_ge0.
Qed.

Lemma iterates_from_zero (Q : nat -> S -> A -> R) pi om :
  pessimistic_iteration M B Q pi om -> (forall s a, Q 0%N s a = 0) -> forall n, lipschitz B L_tv (Q n).
Proof. by move=> iterQ Q0; apply: iterates_lipschitz iterQ (zero_span Q0) (zero_lipschitz Q0). Qed.

End Lipschitz.

(** ** The paper's constants are an instance: |S| l_p / 2 bounds total variation, 2 R_max the span of R *)
Section PaperConstants.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Implicit Types g l_r l_p r_max : R.

Lemma tv_of_kernel l_p : lipschitz_kernel M B l_p -> lipschitz_tv M B (l_p * #|S|%:R / 2).
Proof.
case=> lp_ge0 Pl; split=> [|s t a]; first by rewrite !mulr_ge0 ?invr_ge0 ?ler0n.
rewrite [leRHS]mulrAC ler_wpmul2r ?invr_ge0 ?ler0n // mulrAC mulr_natr -sumr_const.
exact: ler_sum.
Qed.

Lemma span_of_bound r_max (Q : S -> A -> R) : bounded r_max Q -> has_span (2 * r_max) Q.
Proof.
move=> Qb s a s' a'; rewrite mulrDl mul1r ler_add //; first exact: le_trans (ler_norm _) (Qb _ _).
by rewrite (le_trans (ler_norm _)) // normrN.
Qed.

Lemma lipschitz_of_q_as_tv g l_r l_p n r_max :
  bounds.lipschitz_of_q g l_r l_p n r_max = bounds.lipschitz_of_q_tv g l_r (l_p * n%:R / 2) (2 * r_max).
Proof. by congr (_ + _ / _); rewrite !mulrA divfK ?pnatr_eq0. Qed.

(** L_tv is never larger than L: the smallest K is at most |S| l_p/2, span(R) at most 2 R_max. *)
Lemma lipschitz_tv_le g l_r l_p n r_max k span : 0 <= g < 1 -> 0 <= k -> 0 <= r_max ->
  k <= l_p * n%:R / 2 -> span <= 2 * r_max ->
  bounds.lipschitz_of_q_tv g l_r k span <= bounds.lipschitz_of_q g l_r l_p n r_max.
Proof.
case/andP=> g0 g1 k0 r0 kl sr; rewrite lipschitz_of_q_as_tv ler_add2l ler_wpmul2r ?invr_ge0 ?subr_ge0 ?(ltW g1) //.
have le : k * span <= l_p * n%:R / 2 * (2 * r_max).
  by apply: le_trans (ler_wpmul2l k0 sr) _; rewrite ler_wpmul2r // mulr_ge0 ?ler0n.
by rewrite -[g * k * _]mulrA -[g * _ * (2 * _)]mulrA ler_wpmul2l.
Qed.

End PaperConstants.
