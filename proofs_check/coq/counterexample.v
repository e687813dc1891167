(** * The paper's Theorem 1 as printed is false: Assumption 2 must bound |R|, not only R from above

    S = {0, 1, 20} on a line, R(s,a) = -x_s, eps = 1, gamma = 1/2. Action 0 keeps state 0 and sends state 1 to 20; action 1
    keeps state 1 and sends state 0 to 20; 20 absorbs. R <= R_max = 0, so the printed bound is 6; the gap is 10 in
    every round. C++: counterexamples. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators.
From Maximin Require bounds.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** Theorem 1 as the paper prints it, over the rationals. *)
Definition printed_theorem_1 : Prop :=
  forall (S A : finType) (M : mdp rat_realFieldType S A) (B : perturbation rat_realFieldType S) (l_r l_p r_max : rat),
  lipschitz B l_r (reward M) -> lipschitz_kernel M B l_p -> (forall s a, reward M s a <= r_max) ->
  forall Q pi om, pessimistic_iteration M B Q pi om -> (forall s a, Q 0%N s a = 0) ->
  forall Qstar Qpair, fixed_point (T_star M) Qstar -> (forall n, fixed_point (T_pair M (pi n) (om n)) (Qpair n)) ->
  limsup_le (fun n => distance Qstar (Qpair n))
    (bounds.theorem_1 (discount M)
      (bounds.delta (eps B) (discount M) (bounds.lipschitz_of_q_printed (discount M) l_r l_p #|S| r_max))).

(** ** The model *)
Definition S : finType := [finType of option bool].
Notation Zero := (Some false : S).
Notation One := (Some true : S).
Notation Far := (None : S).

Definition x (s : S) : rat := match s with Some false => 0 | Some true => 1 | None => 20 end.

Definition next (s : S) (a : bool) : S :=
  match s, a with Some false, false => Zero | Some true, true => One | _, _ => Far end.

Definition P (s : S) (a : bool) (s' : S) : rat := (s' == next s a)%:R.

Fact mean_P V s a : \sum_s' P s a s' * V s' = V (next s a).
Proof.
rewrite (bigD1 (next s a)) //= /P eqxx mul1r big1 ?addr0 // => s' /negbTE->.
by rewrite mul0r.
Qed.

Fact P_ge0 s a s' : 0 <= P s a s'. Proof. exact: ler0n. Qed.

Fact P_sum s a : \sum_s' P s a s' = 1.
Proof. by rewrite -[RHS](mean_P (fun=> 1) s a); apply: eq_bigr => s' _; rewrite mulr1. Qed.

Fact half_ge0 : 0 <= 2^-1 :> rat. Proof. by []. Qed.
Fact half_lt1 : 2^-1 < 1 :> rat. Proof. by []. Qed.

Definition M : mdp rat_realFieldType S [finType of bool] :=
  Mdp (fun s _ => - x s) Zero false P_ge0 P_sum half_ge0 half_lt1.

Definition d (s t : S) := `|x s - x t|.

Fact d_refl s : d s s = 0. Proof. by rewrite /d subrr normr0. Qed.
Fact d_sym s t : d s t = d t s. Proof. exact: distrC. Qed.
Fact d_triangle s t u : d s u <= d s t + d t u. Proof. exact: ler_dist_add. Qed.

Definition B : perturbation rat_realFieldType S := closed_balls d_refl d_sym d_triangle ler01.

(** States 0 and 1 are taken for each other, 20 is not. *)
Fact ball_M t m : (m \in ball B t) = ((t == Far) == (m == Far)).
Proof. by rewrite inE; case: t m => [[]|] [[]|]; vm_compute. Qed.

(** What the printed theorem assumes: l_r = 1, l_p = 1, R_max = 0. *)
Fact R_lipschitz : lipschitz B 1 (reward M).
Proof. by split=> // s t a; rewrite mul1r /= -opprD normrN. Qed.

Fact P_lipschitz : lipschitz_kernel M B 1.
Proof. by split=> // -[[]|] [[]|] [] [[]|]; vm_compute. Qed.

Fact R_bounded_above s a : reward M s a <= 0. Proof. by case: s => [[]|]. Qed.

Fact backup_M V s a : backup M V s a = - x s + 2^-1 * V (next s a).
Proof. by rewrite /backup mean_P. Qed.

(** ** The policies play action 1 whatever they see; the attacker shows the truth *)
Definition pi (n : nat) (t : S) := true.
Definition om (n : nat) (s : S) := s.
Definition Q n := iter n (T_pair M (pi 0) (om 0)) (fun _ _ => 0).

Fact Q_step n s a : Q n.+1 s a = - x s + 2^-1 * Q n (next s a) true.
Proof. exact: backup_M. Qed.

(** Under action 0 the worst of the two near states is One, and is worse than either of them under action 1. *)
Fact Q_order n : [/\ Q n One false <= Q n Zero true, Q n One false <= Q n One true,
  Q n Far false = Q n Far true & Q n Far true <= Q n One true].
Proof.
elim: n => // n [_ _ _ far]; have half_far : 2^-1 * Q n Far true <= 2^-1 * Q n One true by rewrite ler_wpmul2l.
by rewrite !Q_step /=; split=> //; rewrite ler_add.
Qed.

Fact iteration : pessimistic_iteration M B Q pi om.
Proof.
move=> n; split=> //; last by split=> // s; rewrite ball_centre.
have [zero one far _] := Q_order n.
move=> t [] //; apply: le_minimum (ball_centre B t) _ => m; case: t => [b|]; rewrite ball_M => m_in.
  apply: le_trans (_ : Q n One false <= _).
    by apply: (minimum_le (fun m => Q n m false)); rewrite ball_M.
  by case: m m_in => [[]|].
case: m m_in => [[]|] // _; rewrite -far.
exact: (minimum_le (fun m => Q n m false) (ball_centre B Far)).
Qed.

(** ** Q* and what the policies are worth *)
Definition Qstar (s : S) (a : bool) : rat :=
  match s, a with
  | Some false, false => 0   | Some false, true => - 20
  | Some true, false => - 21 | Some true, true => - 2
  | None, _ => - 40
  end.

Definition Qpair (s : S) (a : bool) : rat :=
  match s, a with
  | Some false, false => - 10 | Some false, true => - 20
  | Some true, false => - 21  | Some true, true => - 2
  | None, _ => - 40
  end.

Fact greedy_Qstar s : greedy_values Qstar s = Qstar s (s != Zero).
Proof.
apply/eqP; rewrite eq_le (maximum_ge (Qstar s)) andbT.
by apply: maximum_le => [|a]; [exact: true|case: s a => [[]|] []].
Qed.

Fact Qstar_fixed : fixed_point (T_star M) Qstar.
Proof. by move=> s a; rewrite /T_star backup_M greedy_Qstar; case: s a => [[]|] []; apply/eqP. Qed.

Fact Qpair_fixed n : fixed_point (T_pair M (pi n) (om n)) Qpair.
Proof. by move=> s a; rewrite /T_pair backup_M; case: s a => [[]|] []; apply/eqP. Qed.

Theorem printed_theorem_1_is_false : ~ printed_theorem_1.
Proof.
move=> thm; have card_S : #|S| = 3%N by rewrite card_option card_bool.
have := thm _ _ M B 1 1 0 R_lipschitz P_lipschitz R_bounded_above Q pi om iteration (fun _ _ => erefl) Qstar
  (fun=> Qpair) Qstar_fixed Qpair_fixed 1 ltr01.
case=> N /(_ N (leqnn N)); rewrite card_S => gap_le.
have := le_trans (distance_ge Qstar Qpair Zero false) gap_le.
by vm_compute.
Qed.

(** ** A start may be Lipschitz with L and still be too steep

    Q_0 = 21 x_s has the Lipschitz constant L_tv = 21 of this model (l_r = 1, K = 1, span(R) = 20), but a span of 420, and
    span(R)/(1-gamma) is 40. Q_1 is steeper, and round 1
    loses 99.75, where Delta = 2 eps gamma L_tv is 21. So "any Q_0 that is Lipschitz with L" would not do in C. *)
Fact P_lipschitz_tv : lipschitz_tv M B 1.
Proof.
split=> // s t a; rewrite mul1r; have [->|s_t] := eqVneq s t.
  by rewrite big1 ?mul0r ?normr_ge0 // => s' _; rewrite subrr normr0.
apply: (@le_trans _ _ 1); last by case: s t s_t => [[]|] [[]|]; vm_compute.
rewrite ler_pdivr_mulr // mul1r; apply: le_trans (ler_sum _ (fun s' _ => ler_norm_sub _ _)) _.
by rewrite big_split /= -!(eq_bigr _ (fun s' _ => esym (ger0_norm (P_ge0 _ a s')))) !P_sum.
Qed.

Fact R_span : has_span 20 (reward M).
Proof. by move=> s a s' a'; case: s s' => [[]|] [[]|]; vm_compute. Qed.

Local Notation L_tv := (bounds.lipschitz_of_q_tv (discount M) 1 1 20).

Theorem steep_start Q1 pi1 om1 :
  pessimistic_iteration M B Q1 pi1 om1 -> (forall s a, Q1 0%N s a = 21 * x s) ->
  lipschitz B L_tv (Q1 0%N) /\
  bounds.delta (eps B) (discount M) L_tv < T_star M (Q1 1%N) One true - Q1 2%N One true.
Proof.
move=> iter1 start1; have L_21 : L_tv = 21 by vm_compute.
split.
  rewrite L_21; split=> [|s t a]; first exact: ler0n.
  by rewrite !start1 -mulrBr normrM normr_nat; apply: lexx.
have [_ _ step0] := iter1 0%N; have [max1 [om_in _] step1] := iter1 1%N.
have Q1_eq s a : Q1 1%N s a = - x s + 2^-1 * (21 * x (next s a)).
  by rewrite step0 /T_pair backup_M /pair_values start1.
have near : om1 1%N One \in ball B One by apply: om_in.
have plays_true : pi1 1%N (om1 1%N One) = true.
  apply: negbNE; apply/negP => /negbTE pi_false.
  have := max1 (om1 1%N One) true; rewrite pi_false => le_false.
  have zero_in : Zero \in ball B (om1 1%N One) by move: near; rewrite !ball_M; case: (om1 _ _) => [[]|].
  have := minimum_le (fun m => Q1 1%N m false) zero_in.
  move/(le_trans le_false); rewrite Q1_eq => min_le.
  suff /le_trans/(_ min_le) : 1 <= min[m in ball B (om1 1%N One)] Q1 1%N m true by vm_compute.
  apply: le_minimum zero_in _ => m; move: near; rewrite !ball_M Q1_eq.
  by case: (om1 _ _) m => [?|] [[]|] //; vm_compute.
rewrite step1 /T_star /T_pair !backup_M /pair_values plays_true.
apply: (@lt_le_trans _ _ (- x One + 2^-1 * Q1 1%N One false - (- x One + 2^-1 * Q1 1%N One true))).
  by rewrite !Q1_eq; vm_compute.
rewrite ler_add2r ler_add2l; apply: (ler_wpmul2l half_ge0).
exact: (maximum_ge (Q1 1%N One) false).
Qed.
