(* The step of the Bouc-Wen state in f64 over the reals, part by part, whatever exp, ln and sqrt
   return; and the inverse of a torque transmission (5)-(7). *)
Require Import Reals Lra Psatz Ranalysis5.
Open Scope R_scope.

(* What keeps an honest loading part below 1 without any guard: 27/256 is the least factor. *)
Lemma quartic : forall r, r <= 1 + 27 / 256 * r ^ 4.
Proof.
  intro r.
  assert (H : 1 + 27 / 256 * r ^ 4 - r = (3 * r - 4) ^ 2 * (3 * (r + 4/3) ^ 2 + 32/3) / 256) by field.
  assert (0 <= (3 * r - 4) ^ 2) by apply pow2_ge_0.
  assert (0 <= (r + 4/3) ^ 2) by apply pow2_ge_0. nra.
Qed.

(* load_part: any n >= 1, any path: the increment ends within the room, f, half_slope, curve
   not negative, however exactly the power was computed. *)
Theorem loading_part_is_within_its_room : forall h f room half_slope curve,
  0 <= h -> 0 <= f -> 0 < room -> 0 <= half_slope -> 0 <= curve ->
  let r := h * (f / room) in
  let denominator := 1 + h * (half_slope + h * curve) + 27 / 256 * r ^ 4 in
  0 <= h * f / denominator <= room.
Proof.
  intros h f room half_slope curve Hh Hf Hroom Hs Hc r denominator.
  assert (Q := quartic r).
  assert (P : 0 <= h * (half_slope + h * curve)).
  { apply Rmult_le_pos; [assumption |]. assert (0 <= h * curve) by (apply Rmult_le_pos; assumption). lra. }
  assert (R4 : 0 <= r ^ 4) by (replace (r ^ 4) with ((r ^ 2) ^ 2) by ring; apply pow2_ge_0).
  assert (D : r <= denominator /\ 1 <= denominator) by (unfold denominator; lra).
  assert (E : h * f = r * room) by (unfold r; field; lra).
  split.
  - apply Rmult_le_pos; [apply Rmult_le_pos; assumption | left; apply Rinv_0_lt_compat; lra].
  - apply Rmult_le_reg_r with denominator; [lra |].
    replace (h * f / denominator * denominator) with (h * f) by (field; lra).
    rewrite E, (Rmult_comm room). apply Rmult_le_compat_r; lra.
Qed.

(* The parts as they are guarded, whatever exp, ln and sqrt give: [forward], [used], [h] are any
   numbers at all. Any sequence of parts. *)
Definition positive (x : R) : R := if Rlt_dec 0 x then x else 0.

Inductive part : R * R -> R * R -> Prop :=
  | unloaded : forall zeta p forward h, zeta < 0 -> forward < - zeta ->
      part (zeta, p) (zeta + positive forward, p - h)
  | crossed : forall zeta p used, zeta < 0 -> part (zeta, p) (0, p - used)
  | near_zero : forall zeta p, zeta < 0 -> 0 < p -> p <= - zeta -> part (zeta, p) (zeta + p, 0)
  | left_zero : forall p h zeta left, 0 <= zeta -> zeta <= h -> h <= 1 -> part (0, p) (zeta, left)
  | loaded : forall zeta p forward h, 0 < zeta -> forward < 1 - zeta ->
      part (zeta, p) (zeta + positive forward, p - h)
  | saturated : forall zeta p left, 0 < zeta -> zeta <= 1 -> part (zeta, p) (1, left).

Inductive follows : R * R -> R * R -> Prop :=
  | there : forall x, follows x x
  | further : forall x y w, follows x y -> part y w -> follows x w.

Theorem eta_stays_within_one_and_runs_forward : forall a b, follows a b ->
  -1 <= fst a <= 1 -> fst a <= fst b <= 1.
Proof.
  intros a b H. induction H as [x | x y w H IH P]; intro Ha.
  - lra.
  - specialize (IH Ha).
    destruct P; simpl in *; unfold positive in *; try destruct (Rlt_dec 0 forward); lra.
Qed.

(* A cable y = B*tau - kappa*eta(tau) - T0 on a branch: eta rises, and no faster than
   L = rho*max(1, 2*sigma). Where kappa*L < B every y is reached, by one tau. *)
Section Inverse.
Variables (B kappa rho sigma T0 : R) (eta : R -> R).
Hypotheses (HB : 0 < B) (Hk : 0 < kappa) (Hr : 0 < rho) (Hs : 1 / 2 <= sigma)
  (sigma_small : sigma < B / (2 * kappa * rho))
  (rises : forall a b, a <= b -> 0 <= eta b - eta a <= 2 * sigma * rho * (b - a))
  (bounded : forall a, -1 <= eta a <= 1).

Definition out (tau : R) : R := B * tau - kappa * eta tau - T0.
Definition slope : R := B - kappa * (2 * sigma * rho).

Lemma slope_positive : 0 < slope.
Proof.
  unfold slope. assert (H := Rmult_lt_compat_r (2 * kappa * rho) _ _ ltac:(nra) sigma_small).
  replace (B / (2 * kappa * rho) * (2 * kappa * rho)) with B in H by (field; nra). lra.
Qed.

Lemma out_rises : forall a b, a <= b -> slope * (b - a) <= out b - out a <= B * (b - a).
Proof.
  intros a b H. destruct (rises a b H) as [L U]. unfold out, slope.
  assert (A := Rmult_le_compat_l kappa _ _ ltac:(lra) U).
  assert (C := Rmult_le_compat_l kappa _ _ ltac:(lra) L). lra.
Qed.

Lemma out_continuous : continuity out.
Proof.
  intro x. intros eps He. exists (eps / (2 * B)). split.
  - apply Rmult_lt_0_compat; [assumption | apply Rinv_0_lt_compat; lra].
  - intros y [_ Hd]. simpl in *. unfold R_dist in *.
    assert (E : B * (eps / (2 * B)) = eps / 2) by (field; lra).
    assert (P := slope_positive).
    assert (A := Rmult_lt_compat_l B _ _ HB Hd). rewrite E in A.
    destruct (Rle_dec x y) as [L | L].
    + destruct (out_rises x y L) as [O1 O2].
      assert (0 <= slope * (y - x)) by (apply Rmult_le_pos; lra).
      unfold Rabs in *. repeat destruct Rcase_abs; lra.
    + assert (L' : y <= x) by lra. destruct (out_rises y x L') as [O1 O2].
      assert (0 <= slope * (x - y)) by (apply Rmult_le_pos; lra).
      unfold Rabs in *. repeat destruct Rcase_abs; lra.
Qed.

Theorem inverse_exists : forall y, exists tau, out tau = y /\ forall other, out other = y -> other = tau.
Proof.
  intro y. assert (P := slope_positive).
  set (low := (y + T0 - kappa - 1) / B). set (high := (y + T0 + kappa + 1) / B).
  assert (EL : B * low = y + T0 - kappa - 1) by (unfold low; field; lra).
  assert (EH : B * high = y + T0 + kappa + 1) by (unfold high; field; lra).
  assert (OL : out low < y) by (unfold out; destruct (bounded low) as [b1 b2]; rewrite EL;
    assert (X := Rmult_le_compat_l kappa _ _ ltac:(lra) b1); lra).
  assert (OH : y < out high) by (unfold out; destruct (bounded high) as [b1 b2]; rewrite EH;
    assert (X := Rmult_le_compat_l kappa _ _ ltac:(lra) b2); lra).
  assert (LH : low < high).
  { apply Rmult_lt_reg_l with B; lra. }
  destruct (IVT (fun t => out t - y) low high) as [tau [T1 T2]]; try lra.
  - intro x. apply continuity_pt_minus; [apply out_continuous | apply continuity_pt_const; intros ? ?; reflexivity].
  - exists tau. split; [lra |]. intros other Ho.
    destruct (Rle_dec tau other) as [L | L].
    + destruct (out_rises tau other L) as [O1 _]. nra.
    + assert (L' : other <= tau) by lra. destruct (out_rises other tau L') as [O1 _]. nra.
Qed.
End Inverse.
