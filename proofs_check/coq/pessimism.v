(** * What pessimism costs: one backup, n rounds, the limit; at test time only; with a belief *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators.
From Maximin Require bounds.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section OneBackup.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Implicit Types (Q : S -> A -> R) (pi : S -> A).
Local Notation g := (discount M).

(** A maximin action over a set that contains s loses at most w in s, if no member promises less than s by more than w. *)
Lemma maximin_loss Q b a s w a' :
  maximin_action Q b a -> s \in b -> (forall m, m \in b -> Q s a' - Q m a' <= w) -> Q s a' <= Q s a + w.
Proof.
move=> max_a bs near; have [m bm min_m] := minimum_attained (fun m => Q m a') bs.
have le_a : Q m a' <= Q s a by rewrite -min_m (le_trans (max_a a')) // (minimum_le (fun m => Q m a)).
by rewrite -ler_subl_addl; apply: le_trans (near m bm); rewrite ler_sub.
Qed.

(** Hence the maximin policy of a table that varies by at most w inside each ball, attacked, keeps all but w. *)
Lemma pessimism_loss Q pi w s : oscillation B w Q -> maximin_policy B Q pi ->
  greedy_values Q s <= attacked_values B pi Q s + w.
Proof.
move=> Qw max_pi; apply: maximum_le (action_0 M) _ => a; rewrite /attacked_values.
have [t st ->] := minimum_attained (fun t => Q s (pi t)) (ball_centre B s).
apply: maximin_loss (max_pi t) (ball_sym st) _ => m tm.
exact: le_trans (ler_norm _) (Qw t s m a (ball_sym st) tm).
Qed.

Lemma oscillation_backup Q pi w s a : oscillation B w Q -> maximin_policy B Q pi ->
  T_star M Q s a <= T_rob M B pi Q s a + g * w.
Proof. by move=> Qw max_pi; apply: backup_le => s'; apply: pessimism_loss. Qed.

(** A Lipschitz table varies by at most 2 eps L. *)
Lemma lipschitz_oscillation Q L : lipschitz B L Q -> oscillation B (2 * eps B * L) Q.
Proof.
case=> L_ge0 QL t m m' a tm tm'; rewrite (le_trans (QL m m' a)) // [leRHS]mulrC ler_wpmul2l //.
exact: ball_width tm tm'.
Qed.

Lemma pessimism_backup Q pi L s a : lipschitz B L Q -> maximin_policy B Q pi ->
  T_star M Q s a <= T_rob M B pi Q s a + bounds.delta (eps B) g L.
Proof.
move=> QL max_pi; have -> : bounds.delta (eps B) g L = g * (2 * eps B * L) by rewrite mulrCA mulrA.
exact: oscillation_backup (lipschitz_oscillation QL) max_pi.
Qed.
End OneBackup.

(** Identities of the constants *)
Section Identities.
Variables (R : realFieldType) (g : R).
Hypotheses (g_ge0 : 0 <= g) (g_lt1 : g < 1).

Fact shortfall_step D d n :
  g * (g ^+ n * d + D * (1 - g ^+ n) / (1 - g)) + D = g ^+ n.+1 * d + D * (1 - g ^+ n.+1) / (1 - g).
Proof.
have rest0 : 1 - g != 0 by rewrite subr_eq0 eq_sym lt_eqF.
rewrite mulrDr mulrA -exprS -addrA; congr (_ + _); apply: (mulIf rest0).
rewrite mulrDl !mulrA !divfK // -!mulrA mulrCA -mulrDr; congr (_ * _).
by rewrite mulrBr mulr1 -exprS addrC addrA subrK.
Qed.

(** C without its inner sum: [ g^{n+1} (d_0 + u_0) + Delta (1-g^{n+1})/(1-g) ] / (1-g). *)
Fact finite_n_closed D d u n :
  bounds.finite_n g D d u n = (g ^+ n.+1 * (d + u) + D * (1 - g ^+ n.+1) / (1 - g)) / (1 - g).
Proof. by rewrite /bounds.finite_n shortfall_step. Qed.

(** C is B and a term that vanishes. *)
Fact finite_n_le D d u n : 0 <= D ->
  bounds.finite_n g D d u n <= bounds.theorem_1_one_sided g D + g ^+ n.+1 / (1 - g) * (d + u).
Proof.
move=> D_ge0; have rest_gt0 : 0 < 1 - g by rewrite subr_gt0.
rewrite finite_n_closed mulrDl addrC [g ^+ _ / _ * _]mulrAC ler_add2r /bounds.theorem_1_one_sided.
rewrite expr2 invfM mulrA !ler_pmul2r ?invr_gt0 // -[leRHS]mulr1 ler_wpmul2l // ler_subl_addr ler_addl.
exact: exprn_ge0.
Qed.

(** B is never above Theorem 1. *)
Fact one_sided_le D : 0 <= D -> bounds.theorem_1_one_sided g D <= bounds.theorem_1 g D.
Proof.
move=> D_ge0; rewrite /bounds.theorem_1_one_sided /bounds.theorem_1 mulrC ler_wpmul2r //.
by rewrite ler_pdivl_mulr ?exprn_gt0 ?subr_gt0 // mulVf ?ler_addl // lt0r_neq0 // exprn_gt0 // subr_gt0.
Qed.

Fact finite_n_ge0 D d u n : 0 <= D -> 0 <= d -> 0 <= u -> 0 <= bounds.finite_n g D d u n.
Proof.
move=> D0 d0 u0; have rest_ge0 : 0 <= (1 - g)^-1 by rewrite invr_ge0 subr_ge0 ltW.
rewrite mulr_ge0 // addr_ge0 // mulr_ge0 // addr_ge0 //; first by rewrite mulr_ge0 ?exprn_ge0 ?addr_ge0.
by rewrite mulr_ge0 // mulr_ge0 // subr_ge0 exprn_ile1 // ltW.
Qed.

(** n (1-g) g^n <= 1, so g^n vanishes in an archimedean field. *)
Fact decay n : n%:R * (1 - g) * g ^+ n <= 1.
Proof.
have le_sum : n%:R * g ^+ n <= \sum_(i < n) g ^+ i.
  have -> : n%:R * g ^+ n = \sum_(i < n) g ^+ n by rewrite sumr_const card_ord mulr_natl.
  by apply: ler_sum => i _; rewrite ler_wiexpn2l ?(ltW g_lt1) // ltnW.
rewrite mulrAC; apply: le_trans (ler_wpmul2r _ le_sum) _; first by rewrite subr_ge0 ltW.
by rewrite mulrC -opprB mulNr -subrX1 opprB ler_subl_addr ler_addl exprn_ge0.
Qed.
End Identities.

Lemma limsup_geometric (R : archiFieldType) (g c d : R) (u : nat -> R) : 0 <= g -> g < 1 -> 0 <= d ->
  (forall n, u n <= c + g ^+ n * d) -> limsup_le u c.
Proof.
move=> g_ge0 g_lt1 d_ge0 u_le e e_gt0; have rest_gt0 : 0 < 1 - g by rewrite subr_gt0.
have big_ge0 : 0 <= d / ((1 - g) * e) by rewrite divr_ge0 // mulr_ge0 // ltW.
exists (Num.bound (d / ((1 - g) * e))) => n le_n; apply: le_trans (u_le n) _; rewrite ler_add2l.
have : d <= n%:R * ((1 - g) * e).
  rewrite -ler_pdivr_mulr ?mulr_gt0 // (le_trans (ltW (archi_boundP big_ge0))) // ler_nat //.
move/(ler_wpmul2l (exprn_ge0 n g_ge0))/le_trans; apply.
by rewrite !mulrA ler_pimull ?(ltW e_gt0) // -mulrA mulrC decay.
Qed.

(** A belief that contains the truth and lies within rho of it costs rho L. *)
Lemma belief_loss (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S)
    (Qstar : S -> A -> R) (L rho : R) (b : {set S}) (s : S) (a : A) :
  fixed_point (T_star M) Qstar -> lipschitz B L Qstar -> s \in b -> (forall m, m \in b -> dist B s m <= rho) ->
  maximin_action Qstar b a -> greedy_values Qstar s <= backup M (greedy_values Qstar) s a + rho * L.
Proof.
move=> fixQ [L_ge0 QL] bs near max_a; apply: maximum_le (action_0 M) _ => a'; rewrite -[X in X + _]fixQ.
apply: maximin_loss max_a bs _ => m bm; apply: le_trans (ler_norm _) (le_trans (QL s m a') _).
by rewrite mulrC ler_wpmul2r // near.
Qed.

(** ** n rounds: Lipschitz iterates have a Delta *)
Lemma iterates_loss (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S) Q pi om L :
  pessimistic_iteration M B Q pi om -> (forall n, lipschitz B L (Q n)) ->
  forall n s a, T_star M (Q n) s a <= Q n.+1 s a + bounds.delta (eps B) (discount M) L.
Proof.
move=> iterQ QL n s a; have [max_pi br ->] := iterQ n; rewrite -(T_rob_best_response _ _ _ br).
exact: pessimism_backup.
Qed.

(** ** n rounds, for any Delta that bounds T*Q_n - Q_{n+1} *)
Lemma limsup_vanishing (R : archiFieldType) (g c d : R) (u : nat -> R) : 0 <= g -> g < 1 -> 0 <= d ->
  (forall n, u n <= c + g ^+ n.+1 / (1 - g) * d) -> limsup_le u c.
Proof.
move=> g_ge0 g_lt1 d_ge0 u_le; apply: (@limsup_geometric _ g c (g / (1 - g) * d)) => // [|n].
  by rewrite mulr_ge0 // divr_ge0 // subr_ge0 ltW.
by rewrite !mulrA -exprSr.
Qed.

Lemma finite_n_limsup (R : archiFieldType) (g D d u_0 : R) (u : nat -> R) : 0 <= g -> g < 1 -> 0 <= D ->
  0 <= d -> 0 <= u_0 -> (forall n, u n <= bounds.finite_n g D d u_0 n) ->
  limsup_le u (bounds.theorem_1_one_sided g D).
Proof.
move=> g_ge0 g_lt1 D_ge0 d_ge0 u_ge0 u_le; apply: (limsup_vanishing g_ge0 g_lt1 (addr_ge0 d_ge0 u_ge0)) => n.
exact: le_trans (u_le n) (finite_n_le g_ge0 g_lt1 _ _ _ D_ge0).
Qed.

Section Rounds.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Variables (Q : nat -> S -> A -> R) (pi : nat -> S -> A) (om : nat -> S -> S) (Qstar : S -> A -> R) (Delta : R).
Hypotheses (iterQ : pessimistic_iteration M B Q pi om) (fixQ : fixed_point (T_star M) Qstar).
Hypothesis round_loss : forall n s a, T_star M (Q n) s a <= Q n.+1 s a + Delta.
Local Notation g := (discount M).
Local Notation d_0 := (excess Qstar (Q 0%N)).
Local Notation u_0 := (excess (Q 0%N) Qstar).

Lemma round_is_rob n s a : Q n.+1 s a = T_rob M B (pi n) (Q n) s a.
Proof. by have [_ br ->] := iterQ n; rewrite (T_rob_best_response _ _ _ br). Qed.

Lemma round_below_star n s a : Q n.+1 s a <= T_star M (Q n) s a.
Proof.
have [_ _ ->] := iterQ n; rewrite -[leRHS]addr0 -(mulr0 g).
by apply: backup_le => s'; rewrite addr0 pair_le_greedy.
Qed.

Lemma Delta_ge0 : 0 <= Delta.
Proof.
have := le_trans (round_below_star 0 (state_0 M) (action_0 M)) (round_loss 0 (state_0 M) (action_0 M)).
by rewrite ler_addl.
Qed.

(** Q_n exceeds Q* by at most g^n u_0. *)
Lemma above_star n s a : Q n s a <= Qstar s a + g ^+ n * u_0.
Proof.
elim: n s a => [|n IH] s a; first by rewrite expr0 mul1r excess_ge.
by rewrite (le_trans (round_below_star n s a)) // fixQ exprS -mulrA; apply: (shrinks_T_star M).
Qed.

(** Q_n falls short of Q* by at most g^n d_0 + Delta (1-g^n)/(1-g). *)
Lemma below_star n s a : Qstar s a <= Q n s a + (g ^+ n * d_0 + Delta * (1 - g ^+ n) / (1 - g)).
Proof.
elim: n s a => [|n IH] s a; first by rewrite expr0 mul1r subrr mulr0 mul0r addr0 excess_ge.
rewrite fixQ (le_trans (shrinks_T_star M IH s a)) // (le_trans (ler_add (round_loss n s a) (lexx _))) //.
by rewrite -addrA ler_add2l -shortfall_step ?discount_lt1 // addrC.
Qed.

(** C, at one pair. *)
Lemma finite_n_pointwise Qrob n s a : fixed_point (T_rob M B (pi n)) Qrob ->
  Qstar s a <= Qrob s a + bounds.finite_n g Delta d_0 u_0 n.
Proof.
move=> fixr; rewrite /bounds.finite_n; apply: below_fixed (shrinks_T_rob M B (pi n)) fixr _ s a => {}s {}a.
rewrite fixQ (le_trans (shrinks_T_star M (below_star n) s a)) //.
rewrite (le_trans (ler_add (round_loss n s a) (lexx _))) // round_is_rob.
rewrite (le_trans (ler_add (ler_add (shrinks_T_rob M B (pi n) (above_star n) s a) (lexx _)) (lexx _))) //.
rewrite -!addrA ler_add2l [d_0 + _]addrC [g ^+ n * (_ + _)]mulrDr -[_ + _ + _ / _]addrA.
by rewrite [g * (_ * u_0 + _)]mulrDr -addrA [Delta + _]addrC.
Qed.

Lemma finite_n_gap Qrob n : fixed_point (T_rob M B (pi n)) Qrob ->
  excess Qstar Qrob <= bounds.finite_n g Delta d_0 u_0 n.
Proof.
move=> fixr; have [s0 a0] := (state_0 M, action_0 M).
apply: excess_le => // [|s a]; last exact: finite_n_pointwise.
by rewrite finite_n_ge0 ?discount_ge0 ?discount_lt1 ?Delta_ge0 ?excess_ge0.
Qed.

(** Theorem 1 for every n: any value between that against the optimal attacker and Q*. *)
Lemma theorem_1_every_n Qrob Q' n : fixed_point (T_rob M B (pi n)) Qrob ->
  (forall s a, Qrob s a <= Q' s a <= Qstar s a) ->
  distance Qstar Q' <= bounds.theorem_1 g Delta + g ^+ n.+1 / (1 - g) * (2 * distance Qstar (Q 0%N)).
Proof.
move=> fixr between; have [s0 a0] := (state_0 M, action_0 M).
apply: distance_le => // s a; have /andP[rob_le le_star] := between s a.
rewrite ger0_norm ?subr_ge0 // ler_subl_addl (le_trans (finite_n_pointwise s a fixr)) //.
rewrite ler_add // (le_trans (finite_n_le _ _ _ _ _ Delta_ge0)) ?discount_ge0 ?discount_lt1 //.
rewrite ler_add ?one_sided_le ?discount_ge0 ?discount_lt1 ?Delta_ge0 // ler_wpmul2l //.
  by rewrite divr_ge0 ?exprn_ge0 ?discount_ge0 // ltW ?discount_rest.
by rewrite mulrDl mul1r ler_add ?excess_le_distance // distanceC // excess_le_distance.
Qed.
End Rounds.

(** ** At test time only *)
Section TestTime.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Local Notation g := (discount M).

Lemma test_time Qstar Qrob pi L : fixed_point (T_star M) Qstar -> fixed_point (T_rob M B pi) Qrob ->
  maximin_policy B Qstar pi -> lipschitz B L Qstar ->
  distance Qstar Qrob <= bounds.test_time_pessimism (eps B) g L.
Proof.
move=> fixQ fixr max_pi QL; apply: distance_le (state_0 M) (action_0 M) => s a.
rewrite ger0_norm ?subr_ge0 ?(rob_le_star fixr fixQ) // ler_subl_addl.
apply: below_fixed (shrinks_T_rob M B pi) fixr _ s a => {}s {}a.
by rewrite fixQ; apply: pessimism_backup.
Qed.
End TestTime.

(** ** With memory: a run moves through positions, each with a true state and an action *)
Section Positions.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A).
Variables (X : Type) (st : X -> S) (act : X -> A) (nxt : X -> S -> X) (W : X -> R) (U : S -> R) (w : R).
Local Notation g := (discount M).
Hypothesis nxt_st : forall x s', st (nxt x s') = s'.
Hypothesis worth :
  forall x, reward M (st x) (act x) + g * (\sum_s' prob M (st x) (act x) s' * W (nxt x s')) <= W x.
Hypothesis loss : forall x, U (st x) <= backup M U (st x) (act x) + w.

Lemma positions_step c : (forall x, U (st x) <= W x + c) -> forall x, U (st x) <= W x + (g * c + w).
Proof.
move=> le_c x; rewrite addrA (le_trans (loss x)) // ler_add2r.
apply: le_trans (ler_add (worth x) (lexx _)); rewrite -addrA ler_add2l -mulrDr ler_wpmul2l ?discount_ge0 //.
by apply: mean_le => s'; have := le_c (nxt x s'); rewrite nxt_st.
Qed.

Lemma positions_every_n c n : (forall x, U (st x) <= W x + c) ->
  forall x, U (st x) <= W x + (g ^+ n * c + w * (1 - g ^+ n) / (1 - g)).
Proof.
move=> le_c; elim: n => [|n IH] x; first by rewrite expr0 mul1r subrr mulr0 mul0r addr0.
by rewrite -shortfall_step ?discount_lt1 //; apply: positions_step.
Qed.
End Positions.

Lemma finite_positions (R : realFieldType) (S A : finType) (M : mdp R S A)
    (X : finType) (st : X -> S) (act : X -> A) (nxt : X -> S -> X) (W : X -> R) (U : S -> R) (w : R) :
  (forall x s', st (nxt x s') = s') ->
  (forall x, reward M (st x) (act x) + discount M * (\sum_s' prob M (st x) (act x) s' * W (nxt x s')) <= W x) ->
  (forall x, U (st x) <= backup M U (st x) (act x) + w) ->
  forall x, U (st x) - W x <= w / (1 - discount M).
Proof.
move=> nxt_st worth loss x; pose short y := U (st y) - W y.
apply: le_trans (maximum_ge short x) _; have [y top] := maximum_attained short x.
rewrite ler_pdivl_mulr ?discount_rest // mulrBr mulr1 ler_subl_addl mulrC {1}top ler_subl_addl.
by apply: (positions_step nxt_st worth loss) => z; rewrite -ler_subl_addl (maximum_ge short).
Qed.

Lemma any_positions (R : archiFieldType) (S A : finType) (M : mdp R S A)
    (X : Type) (st : X -> S) (act : X -> A) (nxt : X -> S -> X) (W : X -> R) (U : S -> R) (w low : R) :
  (forall x s', st (nxt x s') = s') ->
  (forall x, reward M (st x) (act x) + discount M * (\sum_s' prob M (st x) (act x) s' * W (nxt x s')) <= W x) ->
  (forall x, U (st x) <= backup M U (st x) (act x) + w) -> 0 <= w -> (forall x, low <= W x) ->
  forall x, U (st x) - W x <= w / (1 - discount M).
Proof.
move=> nxt_st worth loss w_ge0 W_low x; pose c := Num.max 0 (maximum U - low).
have [g_ge0 g_lt1] := (discount_ge0 M, discount_lt1 M).
have le_c y : U (st y) <= W y + c.
  by rewrite -ler_subl_addl /c le_maxr ler_sub ?orbT // maximum_ge.
apply/ler_addgt0Pr => e e_gt0; have c_ge0 : 0 <= c by rewrite le_maxr lexx.
suff /limsup_geometric-/(_ g_ge0 g_lt1 c_ge0 e e_gt0)[N /(_ N (leqnn N))] :
  forall n, (fun=> U (st x) - W x) n <= w / (1 - discount M) + discount M ^+ n * c by [].
move=> n /=; rewrite ler_subl_addl (le_trans (positions_every_n nxt_st worth loss n le_c x)) // ler_add2l.
rewrite addrC ler_add2r ler_wpmul2r ?invr_ge0 ?subr_ge0 ?(ltW g_lt1) //.
by rewrite -[leRHS]mulr1 ler_wpmul2l // ler_subl_addr ler_addl exprn_ge0.
Qed.
