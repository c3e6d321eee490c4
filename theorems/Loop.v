(* The lag form (18), (23) on the static plant (11), for any number of regressors and any
   sequence of estimates, in exact arithmetic: its errors follow the recursion of Box.v, so that
   |e| <= 2*S holds at every sample. The equations are those of Adaptive::step. *)
Require Import Reals Lra Psatz List.
Require Import Box.
Open Scope R_scope.

(* Regressors: pairs of what is summed, so that any number of them is covered. *)
Fixpoint dot (a x : list R) : R :=
  match a, x with
  | a1 :: a', x1 :: x' => a1 * x1 + dot a' x'
  | _, _ => 0
  end.

Record world := {
  alpha : R; theta : list R;                  (* the plant, constant *)
  r : nat -> R; D : nat -> R; x : nat -> list R  (* reference, disturbance, regressors *)
}.
(* What the law holds at sample n: all may change from sample to sample as it likes. *)
Record estimates := { beta_hat : nat -> R; delta_hat : nat -> R; theta_hat : nat -> list R }.

Section Loop.
Variables (h lambda k : R) (T : R -> R) (p : world) (est : estimates).
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Ha : alpha p <> 0).

Definition y (u : R) (n : nat) := alpha p * u - dot (theta p) (x p n) - D p n.

(* Adaptive::terms and advance: (18), (23) in lag form; u is what is out, z as it is held. *)
Definition ubar (n : nat) (s z : R) : R :=
  - k * s + r p n + ((r p (S n) - r p n) / h - z) / lambda
  + dot (theta_hat est n) (x p n) - delta_hat est n * T s.
Definition u_next (n : nat) (u z : R) : R :=
  let e := y u n - r p n in
  let s := e + lambda * z in
  u + h * lambda * (beta_hat est n * ubar n s z - u).
Definition z_next' (n : nat) (u z : R) : R := z + h * (y u n - r p n).

Definition s_of (n : nat) (u z : R) : R := y u n - r p n + lambda * z.

(* What LagRecursion is given. *)
Definition g (n : nat) := alpha p * beta_hat est n.
Definition w (n : nat) := (g n - 1) * (r p n + (r p (S n) - r p n) / (h * lambda))
  + (g n * dot (theta_hat est n) (x p n) - dot (theta p) (x p n)) - D p n.
Definition xi (n : nat) := (D p (S n) - D p n) + (dot (theta p) (x p (S n)) - dot (theta p) (x p n)).

(* The errors of the controller are those of LagRecursion. *)
Theorem the_controller_is_the_recursion : forall n u z,
  s_of (S n) (u_next n u z) (z_next' n u z)
  = s_next h lambda k (g n) (delta_hat est n) (T (s_of n u z)) (w n) (xi n)
      (s_of n u z) (s_of n u z) z
  /\ z_next' n u z = z_next h lambda (s_of n u z) z.
Proof.
  intros n u z. unfold z_next', z_next, s_of, s_next, u_next, ubar, w, xi, g, y.
  cbv zeta. split; [ field; lra | ring ].
Qed.

(* The loop over time. *)
Fixpoint run (u0 z0 : R) (n : nat) : R * R :=
  match n with
  | O => (u0, z0)
  | S m => let (u, z) := run u0 z0 m in (u_next m u z, z_next' m u z)
  end.

Variables q dmax gmin gmax W Xi B : R.
Hypotheses (Hk : 0 < k) (Hq : 0 <= q) (Hd : 0 <= dmax) (Hg : 0 < gmin).
Hypothesis Hhl : h * lambda <= 1.
Hypothesis Hstep : h * lambda * gmax * (k + dmax * q) <= 1.
Hypothesis HB : 0 <= B.
Hypothesis Hstiff : / lambda <= lambda * k.
Hypothesis Hroom : lambda * W + Xi <= gmin * (lambda * k - / lambda) * B.
Hypothesis HT : forall s, is_sign q s (T s).
(* The estimates adapt in their boxes; the world keeps to its bounds. Nothing else. *)
Hypothesis Hgs : forall n, gmin <= g n <= gmax.
Hypothesis Hds : forall n, 0 <= delta_hat est n <= dmax.
Hypothesis Hws : forall n, - W <= w n <= W.
Hypothesis Hxis : forall n, - (h * Xi) <= xi n <= h * Xi.

Theorem the_error_stays_in_its_box : forall u0 z0,
  - B <= s_of 0 u0 z0 <= B -> - (B * / lambda) <= z0 <= B * / lambda ->
  forall n, let (u, z) := run u0 z0 n in
    - B <= s_of n u z <= B /\ - (B * / lambda) <= z <= B * / lambda
    /\ - (2 * B) <= y u n - r p n <= 2 * B.
Proof.
  intros u0 z0 Hs0 Hz0.
  assert (Core : forall n, let (u, z) := run u0 z0 n in
    - B <= s_of n u z <= B /\ - (B * / lambda) <= z <= B * / lambda).
  { induction n as [| n IH]; [ simpl; auto |].
    simpl. destruct (run u0 z0 n) as [u z]. destruct IH as [Is Iz].
    destruct (the_controller_is_the_recursion n u z) as [E1 E2].
    rewrite E1, E2.
    assert (E : h * (lambda * (B * / lambda)) = h * B) by (field; lra).
    assert (Rm : h * lambda * W + h * Xi + 0 + 0 <= h * gmin * (lambda * k * B - B * / lambda)).
    { assert (A := le2 h _ _ (Rlt_le _ _ Hh) Hroom). lra. }
    assert (St : B * / lambda <= lambda * k * B) by (assert (A := le2 B _ _ HB Hstiff); lra).
    assert (P := box_invariant h lambda k q dmax gmin gmax W Xi 0 0 0 B (B * / lambda)
      Hh Hl Hk Hq Hg (Rle_refl 0) Hhl Hstep).
    assert (Q : h * B + 0 <= h * (lambda * (B * / lambda))) by lra.
    assert (Z0 : - 0 <= 0 <= 0) by lra.
    assert (S0 : - 0 <= s_of n u z - s_of n u z <= 0) by lra.
    specialize (P Q St Rm (g n) (delta_hat est n) (T (s_of n u z)) (w n) (xi n)
      (s_of n u z) (s_of n u z) z 0 0 (Hgs n) (Hds n) (HT _) (Hws n) (Hxis n)
      S0 Z0 Z0 Is Iz).
    rewrite !Rplus_0_r in P. exact P. }
  intro n. specialize (Core n). destruct (run u0 z0 n) as [u z].
  destruct Core as [Cs Cz]. repeat split; try lra.
  - unfold s_of in Cs. assert (A := times lambda _ _ (Rlt_le _ _ Hl) Cz).
    assert (E : lambda * (B * / lambda) = B) by (field; lra). lra.
  - unfold s_of in Cs. assert (A := times lambda _ _ (Rlt_le _ _ Hl) Cz).
    assert (E : lambda * (B * / lambda) = B) by (field; lra). lra.
Qed.
End Loop.
