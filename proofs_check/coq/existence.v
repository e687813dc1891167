(** * The fixed points that the claims speak of exist, over any ordered field: nothing in claims.v is vacuous

    Q^{pi o om} solves linear equations, (1 - gamma P) V = r, with only one solution as T^{pi o om} is a contraction. Q* and
    Q^{pi,rob} are values of the best of finitely many policies, which a policy improvement cannot improve. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** The same model with other rewards. *)
Definition with_reward (R : realFieldType) (S A : finType) (M : mdp R S A) (r : S -> A -> R) : mdp R S A :=
  Mdp r (state_0 M) (action_0 M) (@prob_ge0 _ _ _ M) (prob_sum M) (discount_ge0 M) (discount_lt1 M).

Section FixedRule.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (c : S -> A).
Local Notation g := (discount M).

Let T : 'M[R]_#|S| := \matrix_(i, j) (g * prob M (enum_val j) (c (enum_val j)) (enum_val i)).
Let r : 'rV[R]_#|S| := \row_j reward M (enum_val j) (c (enum_val j)).

Fact mul_T (v : 'rV[R]_#|S|) s :
  (v *m T) 0 (enum_rank s) = g * \sum_s' prob M s (c s) s' * v 0 (enum_rank s').
Proof.
rewrite mxE mulr_sumr (reindex _ (onW_bij _ (@enum_rank_bij S))) /=.
by apply: eq_bigr => s' _; rewrite mxE !enum_rankK mulrC mulrA.
Qed.

Fact unit_T : 1%:M - T \in unitmx.
Proof.
rewrite -row_free_unit -kermx_eq0; apply/eqP/row_matrixP => i; rewrite row0.
have : row i (kermx (1%:M - T)) *m (1%:M - T) = 0 by rewrite -row_mul mulmx_ker row0.
move: (row i _) => v; rewrite mulmxBr mulmx1 => /subr0_eq vT.
pose V (s : S) : R := v 0 (enum_rank s); pose M0 := with_reward M (fun _ _ => 0).
have V_eq s : V s = backup M0 V s (c s) by rewrite {1}/V vT mul_T /backup add0r.
have zero := @fixed_point_unique _ _ _ M0 _ (backup M0 V) (fun _ _ => 0) (shrinks_T_pair M0 c id).
apply/rowP => j; rewrite mxE -(enum_valK j) -/(V _) V_eq zero // => s a.
  by congr (_ + _ * _); apply: eq_bigr => s' _; rewrite {1}V_eq.
by rewrite /T_pair /backup /= big1 ?mulr0 ?addr0 // => s' _; rewrite mulr0.
Qed.

(** The state values of always acting by c. *)
Definition rule_values s : R := (r *m invmx (1%:M - T)) 0 (enum_rank s).

Lemma rule_values_eq s : rule_values s = backup M rule_values s (c s).
Proof.
pose v := r *m invmx (1%:M - T); rewrite /backup.
have <- : (v *m (1%:M - T)) 0 (enum_rank s) = reward M s (c s) by rewrite mulmxKV ?unit_T // mxE enum_rankK.
have <- : (v *m T) 0 (enum_rank s) = g * \sum_s' prob M s (c s) s' * rule_values s' by rewrite mul_T.
have diff (y z : 'rV[R]_#|S|) j : (y - z) 0 j = y 0 j - z 0 j by rewrite !mxE.
by rewrite mulmxBr mulmx1 diff subrK.
Qed.
End FixedRule.

Section Existence.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S) (pi : S -> A).
Local Notation g := (discount M).

Theorem exists_pair om : exists Q, fixed_point (T_pair M pi om) Q.
Proof.
exists (backup M (rule_values M (fun s => pi (om s)))) => s a.
by congr (_ + _ * _); apply: eq_bigr => s' _; rewrite rule_values_eq.
Qed.
End Existence.

(** The least that rules allowed in each state can come to: no rule is better than the best of them. *)
Lemma exists_least (R : realFieldType) (S A : finType) (M : mdp R S A) (c : S -> A) (allowed : S -> {set A}) :
  (forall s, c s \in allowed s) -> exists Q, fixed_point (fun Q => backup M (fun s => min[a in allowed s] Q s a)) Q.
Proof.
move=> c_in; pose ok (f : {ffun S -> A}) := [forall s, f s \in allowed s].
have ok_c : ok [ffun s => c s] by apply/forallP => s; rewrite ffunE.
pose total (f : {ffun S -> A}) := \sum_s rule_values M f s.
case: (@arg_minP _ _ _ _ ok total ok_c) => f /forallP f_in f_min.
pose V := rule_values M f; pose Q := backup M V; exists Q.
pose f' := [ffun s => [arg min_(a < f s in allowed s) Q s a]%O].
have f'_in s : f' s \in allowed s by rewrite ffunE; case: arg_minP.
have f'_min s : Q s (f' s) = min[a in allowed s] Q s a.
  apply/eqP; rewrite eq_le minimum_le ?f'_in // andbT; apply: le_minimum (f'_in s) _ => a.
  by rewrite ffunE; case: arg_minP => // a' _; apply.
pose V' := rule_values M f'.
have le_V s : Q s (f' s) <= V s by rewrite f'_min [leRHS]rule_values_eq minimum_le ?f_in.
have le_Q s a : backup M V' s a <= Q s a.
  rewrite -[leRHS]addr0 -(mul0r (1 - discount M)^-1).
  apply: above_fixed (shrinks_T_pair M f' id) _ _ s a => s a.
    by congr (_ + _ * _); apply: eq_bigr => s' _; rewrite [V' s']rule_values_eq.
  by rewrite addr0 -[leRHS]addr0 -(mulr0 (discount M)); apply: backup_le => s'; rewrite addr0 le_V.
have le_V' s : V' s <= Q s (f' s) by rewrite [V' s]rule_values_eq le_Q.
have eq_V s : V s = Q s (f' s).
  have f'_ok : ok f' by apply/forallP.
  have := f_min f' f'_ok; rewrite -subr_le0 -sumrB => sum_le.
  have diff_ge0 s' : 0 <= V s' - V' s' by rewrite subr_ge0 (le_trans (le_V' s')).
  have /eqP : \sum_s' (V s' - V' s') = 0 by apply/eqP; rewrite eq_le sum_le sumr_ge0.
  rewrite psumr_eq0 => [/allP/(_ s (mem_index_enum s))|s' _]; last exact: diff_ge0.
  by rewrite /= subr_eq0 => /eqP VV'; apply/eqP; rewrite eq_le le_V {1}VV' le_V'.
by move=> s a; congr (_ + _ * _); apply: eq_bigr => s' _; rewrite eq_V f'_min.
Qed.

Section Optima.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).

Theorem exists_rob pi : exists Q, fixed_point (T_rob M B pi) Q.
Proof.
have [s|Q fixQ] := @exists_least _ _ _ M pi (fun s => pi @: ball B s); first by rewrite imset_f ?ball_centre.
exists Q => s a; rewrite {1}fixQ; congr (_ + _ * _); apply: eq_bigr => s' _; congr (_ * _).
have in_image : pi s' \in pi @: ball B s' by rewrite imset_f ?ball_centre.
apply/eqP; rewrite eq_le; apply/andP; split.
  by apply: le_minimum (ball_centre B s') _ => t st; apply: minimum_le; rewrite imset_f.
by apply: le_minimum in_image _ => _ /imsetP[t st ->]; apply: (minimum_le (fun t => Q s' (pi t))).
Qed.

(** Q* is the negative of the least value of -R. *)
Theorem exists_star : exists Q, fixed_point (T_star M) Q.
Proof.
pose M' := with_reward M (fun s a => - reward M s a).
have [s|Q fixQ] := @exists_least _ _ _ M' (fun=> action_0 M) (fun=> [set: A]); first by rewrite inE.
exists (fun s a => - Q s a) => s a; rewrite fixQ /backup opprD opprK -mulrN -sumrN.
congr (_ + _ * _); apply: eq_bigr => s' _; rewrite -mulrN; congr (_ * _).
by congr (- _); apply: (eq_minimum (in_setT (action_0 M))) => a'; rewrite opprK.
Qed.

(** Pessimistic Q-iteration can be run from any Q_0. *)
Theorem exists_iteration Q0 :
  exists Q pi om, pessimistic_iteration M B Q pi om /\ forall s a, Q 0%N s a = Q0 s a.
Proof.
pose pi_of (Q : S -> A -> R) t := [arg max_(a > action_0 M) min[m in ball B t] Q m a]%O.
pose om_of (Q : S -> A -> R) s := [arg min_(t < s in ball B s) Q s (pi_of Q t)]%O.
pose Q n := iter n (fun Q => T_pair M (pi_of Q) (om_of Q) Q) Q0.
exists Q, (fun n => pi_of (Q n)), (fun n => om_of (Q n)); split=> // n; split=> //.
  by move=> t a; rewrite /pi_of; case: arg_maxP => // a' _; apply.
split=> [s|s t st]; rewrite /om_of; case: arg_minP; rewrite ?ball_centre //.
by move=> t' _; apply.
Qed.
End Optima.
