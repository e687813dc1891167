(** * The claims, under the names of proofs_check/claims.hpp

    Read beside theory/bounds.hpp: every right-hand side is one of its functions, defined again in bounds.v. Definitions
    are in model.v; extremum.v defines minimum, maximum, distance (the sup norm) and excess (max of the positive part).

    gap_n is excess Qstar (Qrob n) = max (Q* - Q^{pi_n,rob}); [gap_nonneg] shows that it needs no positive part. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum model operators lipschitz pessimism existence.
From Maximin Require bounds.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** ** The operators, for any model, perturbation, policies *)
Section Operators.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Variables (pi : S -> A) (om : S -> S).
Local Notation gamma := (discount M).

(** Lemma 3 (paper): T^{pi o om} of a fixed pair is a contraction. *)
Theorem lemma_3 Q1 Q2 : distance (T_pair M pi om Q1) (T_pair M pi om Q2) <= gamma * distance Q1 Q2.
Proof. exact: shrinks_contraction (shrinks_T_pair M pi om). Qed.

(** So are T* and T^{pi}_rob. *)
Theorem contraction_star Q1 Q2 : distance (T_star M Q1) (T_star M Q2) <= gamma * distance Q1 Q2.
Proof. exact: shrinks_contraction (shrinks_T_star M). Qed.

Theorem contraction_rob Q1 Q2 : distance (T_rob M B pi Q1) (T_rob M B pi Q2) <= gamma * distance Q1 Q2.
Proof. exact: shrinks_contraction (shrinks_T_rob M B pi). Qed.

(** All three are monotone. *)
Theorem monotone Q1 Q2 : (forall s a, Q1 s a <= Q2 s a) -> forall s a,
  [/\ T_star M Q1 s a <= T_star M Q2 s a, T_pair M pi om Q1 s a <= T_pair M pi om Q2 s a &
      T_rob M B pi Q1 s a <= T_rob M B pi Q2 s a].
Proof.
by move=> le s a; split; apply: (shrinks_mono _ le); [apply: shrinks_T_star|apply: shrinks_T_pair|apply: shrinks_T_rob].
Qed.

(** Their fixed points are unique: Q*, Q^{pi o om} and Q^{pi,rob} are well named. ([existence.v]: there are some.) *)
Theorem uniqueness Q1 Q2 :
  (fixed_point (T_star M) Q1 /\ fixed_point (T_star M) Q2) \/
  (fixed_point (T_pair M pi om) Q1 /\ fixed_point (T_pair M pi om) Q2) \/
  (fixed_point (T_rob M B pi) Q1 /\ fixed_point (T_rob M B pi) Q2) -> forall s a, Q1 s a = Q2 s a.
Proof.
case=> [[f1 f2]|[[f1 f2]|[f1 f2]]].
- exact: fixed_point_unique (shrinks_T_star M) f1 f2.
- exact: fixed_point_unique (shrinks_T_pair M pi om) f1 f2.
- exact: fixed_point_unique (shrinks_T_rob M B pi) f1 f2.
Qed.

(** An attack never gains and the optimal one is the worst: Q^{pi,rob} <= Q^{pi o om} <= Q*. *)
Theorem gap_nonneg Qstar Qpair Qrob : attack B om ->
  fixed_point (T_star M) Qstar -> fixed_point (T_pair M pi om) Qpair -> fixed_point (T_rob M B pi) Qrob ->
  forall s a, Qrob s a <= Qpair s a <= Qstar s a.
Proof. by move=> om_in fs fp fr s a; rewrite (rob_le_pair om_in fr fp) (pair_le_star fp fs). Qed.

(** What "optimal attacker" means: no attacker with finite memory does worse to pi than min_{t in B(s)} Q^{pi,rob}(s, pi(t)).
    X are the positions of the run, what the attacker remembers included; st x is the true state, obs x what is shown, nxt
    x s' the next position when the next true state is s', W x the worth of the run from x. (<= allows an attacker who
    randomises: nxt is then the worst of the positions he may go to.) *)
Theorem rob_is_worst Qrob (X : finType) (st obs : X -> S) (nxt : X -> S -> X) (W : X -> R) :
  fixed_point (T_rob M B pi) Qrob ->
  (forall x, obs x \in ball B (st x)) -> (forall x s', st (nxt x s') = s') ->
  (forall x, let a := pi (obs x) in
     reward M (st x) a + gamma * (\sum_s' prob M (st x) a s' * W (nxt x s')) <= W x) ->
  forall x, attacked_values B pi Qrob (st x) <= W x.
Proof.
move=> fixr obs_in nxt_st worth x; rewrite -subr_le0 -(mul0r (1 - gamma)^-1).
apply: (finite_positions nxt_st worth) => y; rewrite addr0 -[leRHS]fixr.
exact: (minimum_le (fun t => Qrob (st y) (pi t)) (obs_in y)).
Qed.
End Operators.

(** ** The iteration, for every n *)
Section EveryRound.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Local Notation gamma := (discount M).

(** Assumptions 1 and 2 of the paper, the second with |R| <= R_max in the place of R <= R_max. *)
Variables l_r l_p r_max : R.
Hypothesis R_lipschitz : lipschitz B l_r (reward M).
Hypothesis P_lipschitz : lipschitz_kernel M B l_p.
Hypothesis R_bounded : bounded r_max (reward M).
Local Notation L := (bounds.lipschitz_of_q gamma l_r l_p #|S| r_max).
Local Notation Delta := (bounds.delta (eps B) gamma L).

(** The constants of D, in the place of l_p and R_max. *)
Variables k_tv span : R.
Hypothesis P_lipschitz_tv : lipschitz_tv M B k_tv.
Hypothesis R_span : has_span span (reward M).
Local Notation L_tv := (bounds.lipschitz_of_q_tv gamma l_r k_tv span).
Local Notation Delta_tv := (bounds.delta (eps B) gamma L_tv).

(** Q* and pessimistic Q-iteration. *)
Variables (Qstar : S -> A -> R) (Q : nat -> S -> A -> R) (pi : nat -> S -> A) (om : nat -> S -> S).
Hypothesis Qstar_fixed : fixed_point (T_star M) Qstar.
Hypothesis iteration : pessimistic_iteration M B Q pi om.

(** The values of its policies: Q^{pi_n o om_n} against its own attacker, Q^{pi_n,rob} against the optimal one. *)
Variables Qpair Qrob : nat -> S -> A -> R.
Hypothesis Qpair_fixed : forall n, fixed_point (T_pair M (pi n) (om n)) (Qpair n).
Hypothesis Qrob_fixed : forall n, fixed_point (T_rob M B (pi n)) (Qrob n).

Local Notation d_0 := (excess Qstar (Q 0%N)).
Local Notation u_0 := (excess (Q 0%N) Qstar).

(** C with any Delta that bounds T*Q_n - Q_{n+1} in every round, from any Q_0. C++: bounds::finite_n. *)
Theorem c_finite_n_any_delta D n : (forall k s a, T_star M (Q k) s a - Q k.+1 s a <= D) ->
  excess Qstar (Qrob n) <= bounds.finite_n gamma D d_0 u_0 n.
Proof.
move=> loss; apply: (finite_n_gap iteration Qstar_fixed) (Qrob_fixed n) => k s a.
by rewrite -ler_subl_addl.
Qed.

(** C from any Q_0 that is Lipschitz with L_tv and has a span of at most span(R)/(1-gamma). (The second is needed: a steep
    far end of Q_0 makes Q_1 steeper than L_tv.) *)
Theorem c_finite_n_any_start n : lipschitz B L_tv (Q 0%N) -> has_span (span / (1 - gamma)) (Q 0%N) ->
  excess Qstar (Qrob n) <= bounds.finite_n gamma Delta_tv d_0 u_0 n.
Proof.
move=> Q0_lip Q0_span; apply: (finite_n_gap iteration Qstar_fixed) (Qrob_fixed n).
exact: iterates_loss (iterates_lipschitz R_lipschitz P_lipschitz_tv R_span iteration Q0_span Q0_lip).
Qed.

(** From here on Q_0 = 0. *)
Hypothesis start : forall s a, Q 0%N s a = 0.

(** Lemma 1 repaired: with its factor gamma, for Q^{pi o om} of any pair of policies. C++: bounds::lipschitz_of_q. *)
Theorem lemma_1 p o Q' : fixed_point (T_pair M p o) Q' -> lipschitz B L Q'.
Proof.
move=> fixQ; rewrite lipschitz_of_q_as_tv.
exact (fixed_lipschitz R_lipschitz (tv_of_kernel P_lipschitz) (span_of_bound R_bounded) (pair_read_off Q' p o) fixQ).
Qed.

(** Lemma 1 for what it is used for: every Q_n. *)
Theorem lemma_1_iterates n : lipschitz B L (Q n).
Proof.
rewrite lipschitz_of_q_as_tv.
exact (iterates_from_zero R_lipschitz (tv_of_kernel P_lipschitz) (span_of_bound R_bounded) iteration start n).
Qed.

(** Lemma 2: |T*Q_n - Q_{n+1}| <= Delta, and the difference is never negative. C++: bounds::delta. *)
Theorem lemma_2 n s a : 0 <= T_star M (Q n) s a - Q n.+1 s a <= Delta.
Proof.
rewrite subr_ge0 (round_below_star iteration) ler_subl_addl.
exact: iterates_loss iteration lemma_1_iterates n s a.
Qed.

(** Theorem 1 for every n: C++: bounds::theorem_1, and a term that vanishes as n grows. *)
Theorem theorem_1_every_n n : distance Qstar (Qpair n)
  <= bounds.theorem_1 gamma Delta + gamma ^+ n.+1 / (1 - gamma) * (2 * distance Qstar (Q 0%N)).
Proof.
have [Qr fixr] := exists_rob M B (pi n).
apply: (pessimism.theorem_1_every_n iteration Qstar_fixed _ fixr).
  exact: iterates_loss iteration lemma_1_iterates.
by move=> s a; have [_ [om_in _] _] := iteration n; apply: (@gap_nonneg _ _ _ _ _ (pi n) (om n)).
Qed.

(** A for every n: the same against the optimal attacker. *)
Theorem a_optimal_attacker_every_n n : distance Qstar (Qrob n)
  <= bounds.theorem_1 gamma Delta + gamma ^+ n.+1 / (1 - gamma) * (2 * distance Qstar (Q 0%N)).
Proof.
apply: (pessimism.theorem_1_every_n iteration Qstar_fixed _ (Qrob_fixed n)).
  exact: iterates_loss iteration lemma_1_iterates.
by move=> s a; rewrite lexx (rob_le_star (Qrob_fixed n) Qstar_fixed).
Qed.

(** C: gap_n <= [ gamma ( gamma^n (d_0+u_0) + Delta (1-gamma^n)/(1-gamma) ) + Delta ] / (1-gamma).
    C++: bounds::finite_n. *)
Theorem c_finite_n n : excess Qstar (Qrob n) <= bounds.finite_n gamma Delta d_0 u_0 n.
Proof.
apply: (finite_n_gap iteration Qstar_fixed) (Qrob_fixed n).
exact: iterates_loss iteration lemma_1_iterates.
Qed.

(** C, the sum worked out: the same number, read more easily. *)
Theorem c_closed_form D d u n : bounds.finite_n gamma D d u n
  = (gamma ^+ n.+1 * (d + u) + D * (1 - gamma ^+ n.+1) / (1 - gamma)) / (1 - gamma).
Proof. exact: finite_n_closed (discount_lt1 M) D d u n. Qed.

(** C for Theorem 1's own quantity |Q* - Q^{pi_n o om_n}|, which is at most gap_n. *)
Theorem c_own_attacker n : distance Qstar (Qpair n) <= bounds.finite_n gamma Delta d_0 u_0 n.
Proof.
have [Qr fixr] := exists_rob M B (pi n); have [_ [om_in _] _] := iteration n.
apply: distance_le (state_0 M) (action_0 M) => s a.
have /andP[rob_le le_star] := gap_nonneg om_in Qstar_fixed (Qpair_fixed n) fixr s a.
rewrite ger0_norm ?subr_ge0 // ler_subl_addl.
have loss := iterates_loss iteration lemma_1_iterates.
by rewrite (le_trans (finite_n_pointwise iteration Qstar_fixed loss s a fixr)) // ler_add2r.
Qed.

(** D: every Q_n is Lipschitz with L_tv, so all of the above holds with L_tv. C++: bounds::lipschitz_of_q_tv. *)
Theorem d_iterates n : lipschitz B L_tv (Q n).
Proof. exact: (iterates_from_zero R_lipschitz P_lipschitz_tv R_span iteration start). Qed.

Theorem d_lemma_2 n s a : 0 <= T_star M (Q n) s a - Q n.+1 s a <= Delta_tv.
Proof.
rewrite subr_ge0 (round_below_star iteration) ler_subl_addl.
exact: iterates_loss iteration d_iterates n s a.
Qed.

Theorem d_finite_n n : excess Qstar (Qrob n) <= bounds.finite_n gamma Delta_tv d_0 u_0 n.
Proof. by apply: c_finite_n_any_delta => k s a; have /andP[] := d_lemma_2 k s a. Qed.
End EveryRound.

(** D: L_tv is never larger than L: |S| l_p/2 and 2 R_max may serve as K and as span(R), and the smallest K and span(R), which
    are what C++ computes, are at most that. *)
Theorem d_never_larger (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S) (l_r l_p r_max : R) :
  lipschitz_kernel M B l_p -> bounded r_max (reward M) ->
  lipschitz_tv M B (l_p * #|S|%:R / 2) /\ has_span (2 * r_max) (reward M) /\
  forall k_tv span, 0 <= k_tv <= l_p * #|S|%:R / 2 -> span <= 2 * r_max ->
    bounds.lipschitz_of_q_tv (discount M) l_r k_tv span <= bounds.lipschitz_of_q (discount M) l_r l_p #|S| r_max.
Proof.
move=> Pl Rb; split; first exact: tv_of_kernel.
split=> [|k span /andP[k_ge0 k_le] span_le]; first exact: span_of_bound.
apply: lipschitz_tv_le; rewrite ?discount_ge0 ?discount_lt1 //.
exact: le_trans (normr_ge0 _) (Rb (state_0 M) (action_0 M)).
Qed.

(** ** The limits, in an archimedean field (the rationals, the reals) *)
Section Limits.
Variables (R : archiFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Local Notation gamma := (discount M).

Variables l_r l_p r_max : R.
Hypothesis R_lipschitz : lipschitz B l_r (reward M).
Hypothesis P_lipschitz : lipschitz_kernel M B l_p.
Hypothesis R_bounded : bounded r_max (reward M).
Local Notation L := (bounds.lipschitz_of_q gamma l_r l_p #|S| r_max).
Local Notation Delta := (bounds.delta (eps B) gamma L).

Variables k_tv span : R.
Hypothesis P_lipschitz_tv : lipschitz_tv M B k_tv.
Hypothesis R_span : has_span span (reward M).
Local Notation L_tv := (bounds.lipschitz_of_q_tv gamma l_r k_tv span).
Local Notation Delta_tv := (bounds.delta (eps B) gamma L_tv).

Variables (Qstar : S -> A -> R) (Q : nat -> S -> A -> R) (pi : nat -> S -> A) (om : nat -> S -> S).
Hypothesis Qstar_fixed : fixed_point (T_star M) Qstar.
Hypothesis iteration : pessimistic_iteration M B Q pi om.
Hypothesis start : forall s a, Q 0%N s a = 0.

Variables Qpair Qrob : nat -> S -> A -> R.
Hypothesis Qpair_fixed : forall n, fixed_point (T_pair M (pi n) (om n)) (Qpair n).
Hypothesis Qrob_fixed : forall n, fixed_point (T_rob M B (pi n)) (Qrob n).

(** Theorem 1: limsup_n |Q* - Q^{pi_n o om_n}| <= (1+gamma)/(1-gamma)^2 Delta. C++: bounds::theorem_1. *)
Theorem theorem_1 : limsup_le (fun n => distance Qstar (Qpair n)) (bounds.theorem_1 gamma Delta).
Proof.
have d_ge0 : 0 <= 2 * distance Qstar (Q 0%N) by rewrite mulr_ge0 ?ler0n ?distance_ge0.
apply: limsup_vanishing (discount_ge0 M) (discount_lt1 M) d_ge0 _ => n.
exact (theorem_1_every_n R_lipschitz P_lipschitz R_bounded Qstar_fixed iteration Qpair_fixed start n).
Qed.

(** A: the same bound against the optimal attacker. *)
Theorem a_optimal_attacker : limsup_le (fun n => distance Qstar (Qrob n)) (bounds.theorem_1 gamma Delta).
Proof.
have d_ge0 : 0 <= 2 * distance Qstar (Q 0%N) by rewrite mulr_ge0 ?ler0n ?distance_ge0.
apply: limsup_vanishing (discount_ge0 M) (discount_lt1 M) d_ge0 _ => n.
exact (a_optimal_attacker_every_n R_lipschitz P_lipschitz R_bounded Qstar_fixed iteration Qrob_fixed start n).
Qed.

(** B: against the optimal attacker, limsup_n gap_n <= Delta/(1-gamma)^2. C++: bounds::theorem_1_one_sided. *)
Theorem b_one_sided : limsup_le (fun n => excess Qstar (Qrob n)) (bounds.theorem_1_one_sided gamma Delta).
Proof.
apply: (finite_n_limsup (discount_ge0 M) (discount_lt1 M)) (excess_ge0 _ _) (excess_ge0 _ _) _ => [|n].
  by have /andP[] := lemma_2 R_lipschitz P_lipschitz R_bounded iteration start 0 (state_0 M) (action_0 M); apply: le_trans.
exact (c_finite_n R_lipschitz P_lipschitz R_bounded Qstar_fixed iteration Qrob_fixed start n).
Qed.

(** So Theorem 1 itself holds with 1/(1-gamma)^2 in the place of (1+gamma)/(1-gamma)^2. *)
Theorem b_own_attacker : limsup_le (fun n => distance Qstar (Qpair n)) (bounds.theorem_1_one_sided gamma Delta).
Proof.
apply: (finite_n_limsup (discount_ge0 M) (discount_lt1 M)) (excess_ge0 _ _) (excess_ge0 _ _) _ => [|n].
  by have /andP[] := lemma_2 R_lipschitz P_lipschitz R_bounded iteration start 0 (state_0 M) (action_0 M); apply: le_trans.
exact (c_own_attacker R_lipschitz P_lipschitz R_bounded Qstar_fixed iteration Qpair_fixed start n).
Qed.

(** B + D: limsup_n gap_n <= Delta_tv/(1-gamma)^2. *)
Theorem d_total_variation : limsup_le (fun n => excess Qstar (Qrob n)) (bounds.theorem_1_one_sided gamma Delta_tv).
Proof.
apply: (finite_n_limsup (discount_ge0 M) (discount_lt1 M)) (excess_ge0 _ _) (excess_ge0 _ _) _ => [|n].
  by have /andP[] := d_lemma_2 R_lipschitz P_lipschitz_tv R_span iteration start 0 (state_0 M) (action_0 M); apply: le_trans.
exact (d_finite_n R_lipschitz P_lipschitz_tv R_span Qstar_fixed iteration Qrob_fixed start n).
Qed.
End Limits.

(** ** Pessimism at test time only *)
Section TestTime.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Variables (Qstar Qrob : S -> A -> R) (pi : S -> A) (L_star : R).
Hypothesis Qstar_fixed : fixed_point (T_star M) Qstar.
Hypothesis Qstar_lipschitz : lipschitz B L_star Qstar.
Hypothesis pi_maximin : maximin_policy B Qstar pi.
Hypothesis Qrob_fixed : fixed_point (T_rob M B pi) Qrob.

(** E: |Q* - Q^{pi,rob}| <= 2 eps gamma L_star/(1-gamma). C++: bounds::test_time_pessimism. *)
Theorem e_test_time : distance Qstar Qrob <= bounds.test_time_pessimism (eps B) (discount M) L_star.
Proof. exact: test_time. Qed.

(** L_tv will do for L_star. *)
Theorem e_lipschitz_of_q_star l_r k_tv span :
  lipschitz B l_r (reward M) -> lipschitz_tv M B k_tv -> has_span span (reward M) ->
  lipschitz B (bounds.lipschitz_of_q_tv (discount M) l_r k_tv span) Qstar.
Proof.
by move=> Rl Pl Rs; apply: (fixed_lipschitz Rl Pl Rs) (greedy_read_off M Qstar) _.
Qed.
End TestTime.

(** ** Beliefs

    A run moves through positions x of X, which hold all that agent and attacker know: the true state st x, the agent's
    belief bel x, whatever else they remember. The agent plays act x, a maximin action of Q* over the belief. The attacker
    is any function nxt that picks the next position when the next true state is s'. W x is the worth of the run from x.
    (<= allows an attacker who randomises: nxt is then the worst of the positions he may go to.) *)

(** F: V*(st x) - W(x) <= rho L_star/(1-gamma), for finitely many positions: every attacker with finite memory.
    C++: bounds::belief. *)
Theorem f_belief (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S)
    (Qstar : S -> A -> R) (L_star rho : R)
    (X : finType) (st : X -> S) (bel : X -> {set S}) (act : X -> A) (nxt : X -> S -> X) (W : X -> R) :
  fixed_point (T_star M) Qstar -> lipschitz B L_star Qstar ->
  (forall x, st x \in bel x) -> (forall x m, m \in bel x -> dist B (st x) m <= rho) ->
  (forall x, maximin_action Qstar (bel x) (act x)) -> (forall x s', st (nxt x s') = s') ->
  (forall x, reward M (st x) (act x) + discount M * (\sum_s' prob M (st x) (act x) s' * W (nxt x s')) <= W x) ->
  forall x, greedy_values Qstar (st x) - W x <= bounds.belief rho (discount M) L_star.
Proof.
move=> fixQ QL in_bel near max_act nxt_st worth x; apply: (finite_positions nxt_st worth) => y.
exact: (belief_loss fixQ QL (in_bel y) (near y) (max_act y)).
Qed.

(** F against any attacker whatever, with the whole history for memory: X may be infinite, as long as the worth of a run is
    bounded below (as discounted sums of rewards are), and the field archimedean. *)
Theorem f_belief_any_history (R : archiFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S)
    (Qstar : S -> A -> R) (L_star rho low : R)
    (X : Type) (st : X -> S) (bel : X -> {set S}) (act : X -> A) (nxt : X -> S -> X) (W : X -> R) :
  fixed_point (T_star M) Qstar -> lipschitz B L_star Qstar ->
  (forall x, st x \in bel x) -> (forall x m, m \in bel x -> dist B (st x) m <= rho) ->
  (forall x, maximin_action Qstar (bel x) (act x)) -> (forall x s', st (nxt x s') = s') ->
  (forall x, reward M (st x) (act x) + discount M * (\sum_s' prob M (st x) (act x) s' * W (nxt x s')) <= W x) ->
  (forall x, low <= W x) ->
  forall x, greedy_values Qstar (st x) - W x <= bounds.belief rho (discount M) L_star.
Proof.
move=> fixQ QL in_bel near max_act nxt_st worth W_low x.
have loss y := belief_loss fixQ QL (in_bel y) (near y) (max_act y).
apply: (any_positions nxt_st worth loss _ W_low); case: QL => L_ge0 QL.
apply: le_trans (normr_ge0 _) (le_trans (QL (st x) (st x) (action_0 M)) _).
by rewrite mulrC ler_wpmul2r // near.
Qed.
