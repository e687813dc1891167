(** * Largest and smallest values over finite sets, distances between tables *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Unset Printing Implicit Defensive.
Import Order.TTheory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Section Extremum.
Variables (R : realFieldType) (T : finType).
Implicit Types (M : {set T}) (f : T -> R).

(** The smallest value of f over M: f at a minimiser. (0 when M is empty, which no statement rests on.) *)
Definition minimum M f : R :=
  if [pick i in M] is Some i0 then f [arg min_(i < i0 in M) f i]%O else 0.

(** The largest value of f. *)
Definition maximum f : R := - minimum [set: T] (fun i => - f i).

(** [minimum] and [maximum] are what their names say: a bound for every value, and one of the values. *)
Lemma minimum_le M f i : i \in M -> minimum M f <= f i.
Proof.
rewrite /minimum; case: pickP => [i0 Mi0|none] Mi; last by have := none i; rewrite Mi.
by case: arg_minP => // j _; apply.
Qed.

Lemma minimum_attained M f i : i \in M -> exists2 j, j \in M & minimum M f = f j.
Proof.
rewrite /minimum; case: pickP => [i0 Mi0|none] Mi; last by have := none i; rewrite Mi.
by case: arg_minP => // j Mj _; exists j.
Qed.

Lemma maximum_ge f i : f i <= maximum f.
Proof. by rewrite ler_oppr (@minimum_le _ (fun i => - f i)) ?inE. Qed.

Lemma maximum_attained f (i : T) : exists j, maximum f = f j.
Proof.
have [|j _ min_j] := @minimum_attained [set: T] (fun i => - f i) i; first by rewrite inE.
by exists j; rewrite /maximum min_j opprK.
Qed.

(** The same for proofs: bounds of all values bound the extreme one. *)
Lemma le_minimum M f c i : i \in M -> (forall j, j \in M -> c <= f j) -> c <= minimum M f.
Proof. by move=> Mi cf; have [j Mj ->] := minimum_attained f Mi; apply: cf. Qed.

Lemma maximum_le f c (i : T) : (forall j, f j <= c) -> maximum f <= c.
Proof. by move=> fc; have [j ->] := maximum_attained f i. Qed.

Lemma maximum_ge0 f : (forall i, 0 <= f i) -> 0 <= maximum f.
Proof.
move=> f_ge0; rewrite /maximum /minimum oppr_ge0; case: pickP => // i0 _.
by case: arg_minP => // j _ _; rewrite oppr_le0.
Qed.

Lemma minimum_mono M f f' c i : i \in M -> (forall j, j \in M -> f j <= f' j + c) -> minimum M f <= minimum M f' + c.
Proof.
by move=> Mi ff'; have [j Mj ->] := minimum_attained f' Mi; apply: le_trans (ff' j Mj); apply: minimum_le.
Qed.

Lemma eq_minimum M f f' i : i \in M -> f =1 f' -> minimum M f = minimum M f'.
Proof.
move=> Mi ff'; apply/eqP; rewrite eq_le -[X in _ <= X]addr0 -[X in _ && (_ <= X)]addr0.
by rewrite !(minimum_mono Mi) // => j _; rewrite addr0 ff'.
Qed.

Lemma maximum_mono f f' c (i : T) : (forall j, f j <= f' j + c) -> maximum f <= maximum f' + c.
Proof.
by move=> ff'; apply: maximum_le => // j; apply: le_trans (ff' j) _; rewrite ler_add2r maximum_ge.
Qed.
End Extremum.

Notation "'min[' m 'in' M ] E" := (minimum M (fun m => E))
  (at level 36, m name, E at level 36, format "'min[' m  'in'  M ]  E") : ring_scope.
Notation "'max[' a ] E" := (maximum (fun a => E))
  (at level 36, a name, E at level 36, format "'max[' a ]  E") : ring_scope.

Section Distance.
Variables (R : realFieldType) (S A : finType).
Implicit Types Q : S -> A -> R.

(** |Q1 - Q2|, the largest difference of two tables. *)
Definition distance Q1 Q2 : R := max[sa] `|Q1 sa.1 sa.2 - Q2 sa.1 sa.2|.

(** max (Q1 - Q2)^+, how far Q1 reaches above Q2. *)
Definition excess Q1 Q2 : R := max[sa] Num.max 0 (Q1 sa.1 sa.2 - Q2 sa.1 sa.2).

Lemma distance_ge Q1 Q2 s a : `|Q1 s a - Q2 s a| <= distance Q1 Q2.
Proof. exact: (@maximum_ge R _ (fun sa : S * A => `|Q1 sa.1 sa.2 - Q2 sa.1 sa.2|) (s, a)). Qed.

Lemma excess_ge Q1 Q2 s a : Q1 s a <= Q2 s a + excess Q1 Q2.
Proof.
rewrite -ler_subl_addl; apply: le_trans (@maximum_ge R _ (fun sa : S * A => Num.max 0 _) (s, a)).
by rewrite le_maxr lexx orbT.
Qed.

Lemma distance_le Q1 Q2 c : (forall s a, `|Q1 s a - Q2 s a| <= c) -> S -> A -> distance Q1 Q2 <= c.
Proof. by move=> le_c s a; apply: maximum_le => [|[s' a']]; [exact: (s, a)|apply: le_c]. Qed.

Lemma excess_le Q1 Q2 c : 0 <= c -> (forall s a, Q1 s a <= Q2 s a + c) -> S -> A -> excess Q1 Q2 <= c.
Proof.
move=> c_ge0 le_c s a; apply: maximum_le => [|[s' a']]; first exact: (s, a).
by rewrite le_maxl c_ge0 ler_subl_addl le_c.
Qed.

Lemma distance_ge0 Q1 Q2 : 0 <= distance Q1 Q2.
Proof. by apply: maximum_ge0 => sa. Qed.

Lemma excess_ge0 Q1 Q2 : 0 <= excess Q1 Q2.
Proof. by apply: maximum_ge0 => sa; rewrite le_maxr lexx. Qed.

Lemma excess_le_distance Q1 Q2 : S -> A -> excess Q1 Q2 <= distance Q1 Q2.
Proof.
move=> s a; apply: excess_le => // [|s' a']; first exact: le_trans (distance_ge Q1 Q2 s a).
by rewrite -ler_subl_addl; apply: le_trans (ler_norm _) (distance_ge Q1 Q2 s' a').
Qed.

Lemma distanceC Q1 Q2 : S -> A -> distance Q1 Q2 = distance Q2 Q1.
Proof.
move=> s a; have le Q Q' : distance Q Q' <= distance Q' Q.
  by apply: distance_le => // s' a'; rewrite distrC distance_ge.
by apply/eqP; rewrite eq_le !le.
Qed.
End Distance.
