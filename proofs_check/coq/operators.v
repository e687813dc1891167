(** * The three operators: monotone contractions, comparison with their fixed points *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Operators.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Implicit Types (V : S -> R) (Q : S -> A -> R) (T : (S -> A -> R) -> S -> A -> R).
Local Notation g := (discount M).

Lemma discount_rest : 0 < 1 - g. Proof. by rewrite subr_gt0 discount_lt1. Qed.

(** The mean of V over successors exceeds that of V' by at most c if V exceeds V' by at most c. *)
Lemma mean_le V V' c s a :
  (forall s', V s' <= V' s' + c) -> \sum_s' prob M s a s' * V s' <= \sum_s' prob M s a s' * V' s' + c.
Proof.
move=> le_c; rewrite -[c in leRHS]mul1r -(prob_sum M s a) mulr_suml -big_split /=.
by apply: ler_sum => s' _; rewrite -mulrDr ler_wpmul2l // prob_ge0.
Qed.

Lemma backup_le V V' c s a : (forall s', V s' <= V' s' + c) -> backup M V s a <= backup M V' s a + g * c.
Proof.
by move=> le_c; rewrite /backup -addrA ler_add2l -mulrDr ler_wpmul2l ?discount_ge0 // mean_le.
Qed.

(** Raising Q by c raises T Q by at most g c: monotonicity (c = 0) and contraction in one. *)
Definition shrinks T :=
  forall Q Q' c, (forall s a, Q s a <= Q' s a + c) -> forall s a, T Q s a <= T Q' s a + g * c.

Lemma shrinks_T_star : shrinks (T_star M).
Proof. by move=> Q Q' c le_c s a; apply: backup_le => s'; apply: maximum_mono => // a'; apply: le_c. Qed.

Lemma shrinks_T_pair pi om : shrinks (T_pair M pi om).
Proof. by move=> Q Q' c le_c s a; apply: backup_le => s'; apply: le_c. Qed.

Lemma shrinks_T_rob pi : shrinks (T_rob M B pi).
Proof.
move=> Q Q' c le_c s a; apply: backup_le => s'.
by apply: minimum_mono (ball_centre B s') _ => t _; apply: le_c.
Qed.

Lemma shrinks_mono T Q Q' :
  shrinks T -> (forall s a, Q s a <= Q' s a) -> forall s a, T Q s a <= T Q' s a.
Proof.
by move=> shT le s a; rewrite -[leRHS]addr0 -(mulr0 g); apply: shT => s' a'; rewrite addr0.
Qed.

Lemma shrinks_contraction T Q Q' : shrinks T -> distance (T Q) (T Q') <= g * distance Q Q'.
Proof.
move=> shT; have [s0 a0] := (state_0 M, action_0 M); have le Q1 Q2 s a : T Q1 s a - T Q2 s a <= g * distance Q1 Q2.
  rewrite ler_subl_addl; apply: shT => s' a'; rewrite -ler_subl_addl.
  exact: le_trans (ler_norm _) (distance_ge Q1 Q2 s' a').
by apply: distance_le => // s a; rewrite ler_norml ler_oppl opprB le distanceC // le.
Qed.

(** A table that T raises by no more than -e, or lowers by no more than e, lies that close to the fixed point. *)
Lemma below_fixed T Q Q' e : shrinks T -> fixed_point T Q ->
  (forall s a, Q' s a <= T Q' s a + e) -> forall s a, Q' s a <= Q s a + e / (1 - g).
Proof.
move=> shT fixQ le s a; pose over (sa : S * A) := Q' sa.1 sa.2 - Q sa.1 sa.2.
have over_le s' a' : Q' s' a' <= Q s' a' + maximum over.
  by rewrite -ler_subl_addl (@maximum_ge _ _ over (s', a')).
apply: le_trans (over_le s a) _; rewrite ler_add2l ler_pdivl_mulr ?discount_rest //.
have [[s' a'] top] := maximum_attained over (s, a).
rewrite mulrBr mulr1 ler_subl_addl mulrC {1}top /over /= ler_subl_addl addrA.
by apply: le_trans (le s' a') _; rewrite ler_add2r fixQ; apply: shT.
Qed.

Lemma above_fixed T Q Q' e : shrinks T -> fixed_point T Q ->
  (forall s a, T Q' s a <= Q' s a + e) -> forall s a, Q s a <= Q' s a + e / (1 - g).
Proof.
move=> shT fixQ le s a; pose over (sa : S * A) := Q sa.1 sa.2 - Q' sa.1 sa.2.
have over_le s' a' : Q s' a' <= Q' s' a' + maximum over.
  by rewrite -ler_subl_addl (@maximum_ge _ _ over (s', a')).
apply: le_trans (over_le s a) _; rewrite ler_add2l ler_pdivl_mulr ?discount_rest //.
have [[s' a'] top] := maximum_attained over (s, a).
rewrite mulrBr mulr1 ler_subl_addl mulrC {1}top /over /= ler_subl_addl addrA fixQ.
by rewrite addrAC; apply: le_trans (shT _ _ _ over_le s' a') _; rewrite ler_add2r.
Qed.

Lemma fixed_point_unique T Q Q' :
  shrinks T -> fixed_point T Q -> fixed_point T Q' -> forall s a, Q s a = Q' s a.
Proof.
move=> shT fixQ fixQ' s a; apply/eqP; rewrite eq_le -[X in _ <= X]addr0 -[X in _ && (_ <= X)]addr0 -(mul0r (1 - g)^-1).
by apply/andP; split; apply: below_fixed shT _ _ _ _ => // s' a'; rewrite addr0 -?fixQ -?fixQ' lexx.
Qed.

(** What an attacker can do to a policy lies between nothing and T_rob. *)
Lemma attacked_le_pair pi om Q s : attack B om -> attacked_values B pi Q s <= pair_values pi om Q s.
Proof. by move=> om_in; apply: (minimum_le (fun t => Q s (pi t))). Qed.

Lemma pair_le_greedy pi om Q s : pair_values pi om Q s <= greedy_values Q s.
Proof. exact: (maximum_ge (Q s)). Qed.

Lemma best_response_attains pi om Q s :
  best_response B Q pi om -> attacked_values B pi Q s = pair_values pi om Q s.
Proof.
case=> om_in om_min; apply/eqP; rewrite eq_le attacked_le_pair //=.
exact: le_minimum (om_in s) (om_min s).
Qed.

Lemma T_rob_best_response pi om Q s a :
  best_response B Q pi om -> T_rob M B pi Q s a = T_pair M pi om Q s a.
Proof.
by move=> br; congr (_ + g * _); apply: eq_bigr => s' _; rewrite (best_response_attains _ br).
Qed.

Lemma rob_le_pair pi om Qrob Qpair : attack B om ->
  fixed_point (T_rob M B pi) Qrob -> fixed_point (T_pair M pi om) Qpair -> forall s a, Qrob s a <= Qpair s a.
Proof.
move=> om_in fixr fixp s a; rewrite -[leRHS]addr0 -(mul0r (1 - g)^-1).
apply: below_fixed (@shrinks_T_pair pi om) fixp _ s a => s' a'; rewrite {1}fixr -(mulr0 g).
by apply: backup_le => t; rewrite addr0 attacked_le_pair.
Qed.

Lemma pair_le_star pi om Qpair Qstar :
  fixed_point (T_pair M pi om) Qpair -> fixed_point (T_star M) Qstar -> forall s a, Qpair s a <= Qstar s a.
Proof.
move=> fixp fixs s a; rewrite -[leRHS]addr0 -(mul0r (1 - g)^-1).
apply: below_fixed shrinks_T_star fixs _ s a => s' a'; rewrite {1}fixp -(mulr0 g).
by apply: backup_le => t; rewrite addr0 pair_le_greedy.
Qed.

Lemma rob_le_star pi Qrob Qstar :
  fixed_point (T_rob M B pi) Qrob -> fixed_point (T_star M) Qstar -> forall s a, Qrob s a <= Qstar s a.
Proof.
move=> fixr fixs s a; rewrite -[leRHS]addr0 -(mul0r (1 - g)^-1).
apply: below_fixed shrinks_T_star fixs _ s a => s' a'; rewrite {1}fixr -(mulr0 g); apply: backup_le => t.
by rewrite addr0; apply: le_trans (pair_le_greedy pi id Qrob t); apply: attacked_le_pair; apply: ball_centre.
Qed.

End Operators.
