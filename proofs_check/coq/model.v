(** * The setting: models, perturbations, policies, operators

    Beside theory/finite_mdp.hpp, theory/perturbation.hpp, theory/policies.hpp and theory/bellman.hpp. Everything is
    stated for any finite sets S of states and A of actions and any ordered field R: the rationals, the reals. *)
From mathcomp Require Import all_ssreflect all_algebra.
From Maximin Require Import extremum.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

(** A finite Markov decision process <S, A, P, R, gamma> (paper, section 2.1; class FiniteMdp). *)
Record mdp (R : realFieldType) (S A : finType) := Mdp {
  reward : S -> A -> R;                            (* R(s,a) *)
  prob : S -> A -> S -> R;                         (* prob s a s' is P(s'|s,a) *)
  discount : R;                                    (* gamma *)
  state_0 : S;                                     (* |S| >= 1 *)
  action_0 : A;                                    (* |A| >= 1 *)
  prob_ge0 : forall s a s', 0 <= prob s a s';
  prob_sum : forall s a, \sum_s' prob s a s' = 1;
  discount_ge0 : 0 <= discount;
  discount_lt1 : discount < 1
}.

(** What an attacker may show (paper, section 2.2; class Perturbation): the balls B(s), each with its centre, symmetric,
    and no wider than 2 eps. Of the distance nothing else is needed; [closed_balls] below makes the balls of a metric. *)
Record perturbation (R : realFieldType) (S : finType) := Perturbation {
  ball : S -> {set S};                             (* B(s) *)
  dist : S -> S -> R;                              (* |x_s - x_t| *)
  eps : R;                                         (* radius() in C++ *)
  ball_centre : forall s, s \in ball s;
  ball_sym : forall s t, t \in ball s -> s \in ball t;
  ball_width : forall t m m', m \in ball t -> m' \in ball t -> dist m m' <= 2 * eps
}.

(** B(s) = { t in S : |x_s - x_t| <= eps }. *)
Section ClosedBalls.
Variables (R : realFieldType) (S : finType) (d : S -> S -> R) (e : R).
Hypotheses (d_refl : forall s, d s s = 0) (d_sym : forall s t, d s t = d t s).
Hypotheses (d_triangle : forall s t u, d s u <= d s t + d t u) (e_ge0 : 0 <= e).

Let B s := [set t | d s t <= e].

Fact closed_ball_centre s : s \in B s. Proof. by rewrite inE d_refl. Qed.

Fact closed_ball_sym s t : t \in B s -> s \in B t. Proof. by rewrite !inE d_sym. Qed.

Fact closed_ball_width t m m' : m \in B t -> m' \in B t -> d m m' <= 2 * e.
Proof.
rewrite !inE => tm tm'; apply: le_trans (d_triangle m t m') _.
by rewrite mulrDl mul1r ler_add // d_sym.
Qed.

Definition closed_balls : perturbation R S := Perturbation closed_ball_centre closed_ball_sym closed_ball_width.
End ClosedBalls.

Section Operators.
Variables (R : realFieldType) (S A : finType) (M : mdp R S A) (B : perturbation R S).
Implicit Types (V : S -> R) (Q : S -> A -> R) (pi : S -> A) (om : S -> S).

(** ** Operators (theory/bellman.hpp) *)

(** R(s,a) + gamma sum_{s'} P(s'|s,a) V(s'). C++: backup. *)
Definition backup V s a := reward M s a + discount M * \sum_s' prob M s a s' * V s'.

(** V(s) = max_a Q(s,a). C++: greedy_values. *)
Definition greedy_values Q s := max[a] Q s a.

(** V(s) = Q(s, pi(om(s))). C++: policy_values of the composed policy. *)
Definition pair_values pi om Q s := Q s (pi (om s)).

(** V(s) = min_{t in B(s)} Q(s, pi(t)). C++: attacked_values. *)
Definition attacked_values pi Q s := min[t in ball B s] Q s (pi t).

(** T*Q (paper, equation 2). C++: bellman_optimality. *)
Definition T_star Q := backup (greedy_values Q).

(** T^{pi o om}Q (paper, Definition 3, equation 1). C++: bellman_pair. *)
Definition T_pair pi om Q := backup (pair_values pi om Q).

(** T^{pi}_rob Q, the optimal attacker of pi. C++: bellman_robust. *)
Definition T_rob pi Q := backup (attacked_values pi Q).

(** Q is a fixed point of T. *)
Definition fixed_point (T : (S -> A -> R) -> S -> A -> R) Q := forall s a, Q s a = T Q s a.

(** ** Policies (theory/policies.hpp), by what they achieve: whatever way ties are broken *)

(** a is one of argmax_a min_{m in b} Q(m,a). C++: belief_action. *)
Definition maximin_action Q (b : {set S}) a := forall a', min[m in b] Q m a' <= min[m in b] Q m a.

(** pi(t) is one of argmax_a min_{m in B(t)} Q(m,a) for every t. C++: maximin_policy. *)
Definition maximin_policy Q pi := forall t, maximin_action Q (ball B t) (pi t).

(** om may be played: it shows members of the ball only. *)
Definition attack om := forall s, om s \in ball B s.

(** om(s) is one of argmin_{t in B(s)} Q(s, pi(t)) for every s. C++: best_response_attack. *)
Definition best_response Q pi om :=
  attack om /\ forall s t, t \in ball B s -> Q s (pi (om s)) <= Q s (pi t).

(** Pessimistic Q-iteration (paper, Algorithm 3) from any Q_0: in every round pi_n is a maximin policy of Q_n and om_n a
    best response to it, and Q_{n+1} = T^{pi_n o om_n} Q_n. C++: pessimistic_update. *)
Definition pessimistic_iteration (Q : nat -> S -> A -> R) (pi : nat -> S -> A) (om : nat -> S -> S) :=
  forall n, [/\ maximin_policy (Q n) (pi n), best_response (Q n) (pi n) (om n) &
                forall s a, Q n.+1 s a = T_pair (pi n) (om n) (Q n) s a].

(** ** Constants of a model (theory/lipschitz.hpp) *)

(** |Q(s,a) - Q(t,a)| <= c |x_s - x_t| for all s, t, a. C++: lipschitz_constant is the smallest such c. *)
Definition lipschitz c Q := 0 <= c /\ forall s t a, `|Q s a - Q t a| <= c * dist B s t.

(** |P(s'|s,a) - P(s'|t,a)| <= c |x_s - x_t| (paper, Assumption 1). C++: ModelConstants::l_p. *)
Definition lipschitz_kernel c :=
  0 <= c /\ forall s t a s', `|prob M s a s' - prob M t a s'| <= c * dist B s t.

(** Half the l1 distance of P(.|s,a) and P(.|t,a) is at most c |x_s - x_t|. C++: ModelConstants::k_tv. *)
Definition lipschitz_tv c :=
  0 <= c /\ forall s t a, (\sum_s' `|prob M s a s' - prob M t a s'|) / 2 <= c * dist B s t.

(** |Q(m,a) - Q(m',a)| <= w for all states m, m' of one ball: how much states differ that an attacker can confuse. *)
Definition oscillation w Q := forall t m m' a, m \in ball B t -> m' \in ball B t -> `|Q m a - Q m' a| <= w.

(** |Q| <= c. *)
Definition bounded c Q := forall s a, `|Q s a| <= c.

(** All values of Q lie in an interval of length c: max Q - min Q <= c. *)
Definition has_span c Q := forall s a s' a', Q s a - Q s' a' <= c.

End Operators.

(** limsup_n u_n <= c: for every e > 0, u_n <= c + e from some n on. *)
Definition limsup_le (R : realFieldType) (u : nat -> R) (c : R) :=
  forall e, 0 < e -> exists N, forall n, (N <= n)%N -> u n <= c + e.
