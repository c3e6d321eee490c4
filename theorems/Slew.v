(* A slew rate that no step from the box meets: with it the law is the one without it.

   The plant tells the command that is out, alpha*u = y + theta'x + D, whatever limited it, so
   that what the law adds to it is a sum of bounded terms. *)
Require Import Reals Lra Psatz.
Require Import Box.
Open Scope R_scope.

(* What one step of the lag form adds to the command, in the terms of the box. *)
Lemma what_a_step_adds : forall h lambda k alpha beta d t r r' sm z u y X D comp,
  lambda <> 0 -> y = alpha * u - X - D ->
  let s := y - r + lambda * z in
  let w := (alpha * beta - 1) * (r + r' / lambda) + (alpha * beta * comp - X) - D in
  alpha * (h * lambda * (beta * (- k * sm + r + (r' - z) / lambda + comp - d * t) - u))
  = h * (lambda * (w - alpha * beta * (k * sm + d * t)) - alpha * beta * z + r'
         - lambda * (s - lambda * z)).
Proof. intros. unfold s, w. rewrite H0. field. assumption. Qed.

Section Slew.
Variables h lambda k dmax gmin gmax amin W r'max Es Rc S Z slew : R.
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Hk : 0 < k) (Hd : 0 <= dmax) (Hg : 0 < gmin)
  (Ha : 0 < amin) (Hes : 0 <= Es).
Hypothesis Hslew :
  h * (lambda * (W + gmax * (k * (S + Es) + dmax)) + gmax * Z + r'max
       + lambda * (S + lambda * Z)) + amin * Rc <= amin * (h * slew).

(* [rc] is what rounding adds to the new command [v]. *)
Theorem the_slew_rate_is_not_met : forall alpha g d t w r' s sm z u v rc,
  amin <= alpha -> gmin <= g <= gmax -> 0 <= d <= dmax -> - 1 <= t <= 1 ->
  - W <= w <= W -> - r'max <= r' <= r'max -> - Es <= sm - s <= Es ->
  - S <= s <= S -> - Z <= z <= Z -> - Rc <= rc <= Rc ->
  alpha * (v - rc - u)
  = h * (lambda * (w - g * (k * sm + d * t)) - g * z + r' - lambda * (s - lambda * z)) ->
  - (h * slew) <= v - u <= h * slew.
Proof.
  intros alpha g d t w r' s sm z u v rc Halpha Hg' Hd' Ht Hw Hr Hsm Hs Hz Hrc E.
  assert (G0 : 0 <= g) by lra.
  assert (HSE : - (S + Es) <= sm <= S + Es) by lra.
  assert (P1 := times k _ _ (Rlt_le _ _ Hk) HSE).
  assert (P2 := times d t 1 (proj1 Hd') ltac:(lra)).
  assert (HP : - (k * (S + Es) + dmax) <= k * sm + d * t <= k * (S + Es) + dmax) by lra.
  assert (P3 := times g _ _ G0 HP).
  assert (B0 : 0 <= k * (S + Es) + dmax).
  { assert (0 <= k * (S + Es)) by (apply pos2; lra). lra. }
  assert (P4 : g * (k * (S + Es) + dmax) <= gmax * (k * (S + Es) + dmax))
    by (apply Rmult_le_compat_r; lra).
  assert (HQ : - (W + gmax * (k * (S + Es) + dmax)) <= w - g * (k * sm + d * t)
    <= W + gmax * (k * (S + Es) + dmax)) by lra.
  assert (P5 := times lambda _ _ (Rlt_le _ _ Hl) HQ).
  assert (P6 := times g _ _ G0 Hz).
  assert (P7 : g * Z <= gmax * Z) by (apply Rmult_le_compat_r; lra).
  assert (P8 := times lambda _ _ (Rlt_le _ _ Hl) Hz).
  assert (HR : - (S + lambda * Z) <= s - lambda * z <= S + lambda * Z) by lra.
  assert (P9 := times lambda _ _ (Rlt_le _ _ Hl) HR).
  set (all := lambda * (w - g * (k * sm + d * t)) - g * z + r' - lambda * (s - lambda * z)) in *.
  set (most := lambda * (W + gmax * (k * (S + Es) + dmax)) + gmax * Z + r'max
    + lambda * (S + lambda * Z)) in *.
  assert (HA : - most <= all <= most) by (unfold all, most; lra).
  assert (M := times h _ _ (Rlt_le _ _ Hh) HA).
  (* Against the least alpha. *)
  assert (Move : - (h * slew - Rc) <= v - rc - u <= h * slew - Rc).
  { assert (Room : h * most <= amin * (h * slew - Rc)) by lra.
    assert (M0 : 0 <= h * slew - Rc).
    { assert (0 <= h * most) by (apply pos2; lra).
      apply Rnot_lt_le. intro B.
      assert (X := Rmult_lt_compat_l amin _ _ Ha B). lra. }
    assert (Wide : amin * (h * slew - Rc) <= alpha * (h * slew - Rc))
      by (apply Rmult_le_compat_r; lra).
    assert (A0 : 0 < alpha) by lra.
    split; apply Rnot_lt_le; intro B; assert (X := Rmult_lt_compat_l alpha _ _ A0 B); lra. }
  lra.
Qed.
End Slew.
