(** * What pessimism can cost, as closed formulas: theory/bounds.hpp, function by function, under the same names *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Local Open Scope ring_scope.

Section Bounds.
Variable R : realFieldType.
Implicit Types g l_r l_p k_tv r_max span eps L delta rho : R.

(** l_r + |S| l_p R_max/(1-g), as Lemma 1 prints it. *)
Definition lipschitz_of_q_printed g l_r l_p (states : nat) r_max := l_r + l_p * states%:R * r_max / (1 - g).

(** L = l_r + g |S| l_p R_max/(1-g): Lemma 1 with the factor g it drops. *)
Definition lipschitz_of_q g l_r l_p (states : nat) r_max := l_r + g * l_p * states%:R * r_max / (1 - g).

(** L_tv = l_r + g K span(R)/(1-g). *)
Definition lipschitz_of_q_tv g l_r k_tv span := l_r + g * k_tv * span / (1 - g).

(** Delta = 2 eps g L. *)
Definition delta eps g L := 2 * eps * g * L.

(** Theorem 1: (1+g)/(1-g)^2 Delta. *)
Definition theorem_1 g delta := (1 + g) / (1 - g) ^+ 2 * delta.

(** Strengthening B: Delta/(1-g)^2. *)
Definition theorem_1_one_sided g delta := delta / (1 - g) ^+ 2.

(** Strengthening C: [ g ( g^n (d_0 + u_0) + Delta (1-g^n)/(1-g) ) + Delta ] / (1-g). *)
Definition finite_n g delta (d_0 u_0 : R) n :=
  (g * (g ^+ n * (d_0 + u_0) + delta * (1 - g ^+ n) / (1 - g)) + delta) / (1 - g).

(** Strengthening E: 2 eps g L*/(1-g). *)
Definition test_time_pessimism eps g L := delta eps g L / (1 - g).

(** Strengthening F: rho L*/(1-g). *)
Definition belief rho g L := rho * L / (1 - g).

End Bounds.
