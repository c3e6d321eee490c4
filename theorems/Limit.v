(* The box theorem of the lag form where a limit of the command is met (anti-windup).

   The limit cuts the command: the error e' that comes of it lies between the one that the law
   asked for and [reserve], the error that the limit itself leaves. Against a limit z waits. Both
   are Adaptive::step: u+ = clamp(v), and z+ = z where e asks for more than the limit gives. *)
Require Import Reals Lra Psatz List.
Require Import Box Decrease Loop.
Open Scope R_scope.

(* e and z after a step, of [ev] and [zv] that they would be without a limit. *)
Inductive limited (reserve e z ev zv : R) : R -> R -> Prop :=
  | free : limited reserve e z ev zv ev zv
  | above_waits : forall e', e < 0 -> reserve <= e' <= ev -> limited reserve e z ev zv e' z
  | above : forall e', 0 <= e -> reserve <= e' <= ev -> limited reserve e z ev zv e' zv
  | below_waits : forall e', 0 < e -> ev <= e' <= - reserve -> limited reserve e z ev zv e' z
  | below : forall e', e <= 0 -> ev <= e' <= - reserve -> limited reserve e z ev zv e' zv.

(* What the smooth sign leaves of s from above. *)
Lemma pull_from_above : forall b k d q t s sm Es,
  0 <= b -> 0 <= k -> 0 <= d -> 0 <= Es -> b * (k + d * q) <= 1 -> 0 <= q ->
  is_sign q sm t -> - Es <= sm - s <= Es ->
  (0 <= s -> s - b * (k * sm + d * t) <= s - b * k * s + Es)
  /\ (s <= 0 -> s - b * (k * sm + d * t) <= Es).
Proof.
  intros b k d q t s sm Es Hb Hk Hd He Hst Hq [T1 T2] Hsm.
  assert (Hbk := pos2 _ _ Hb Hk). assert (Hbd := pos2 _ _ Hb Hd). assert (Hbdq := pos2 _ _ Hbd Hq).
  assert (Hbk1 : 0 <= 1 - b * k) by lra.
  assert (F6 : b * k * Es <= Es) by (assert (X := pos2 _ _ Hbk1 He); lra).
  destruct (Rle_dec 0 sm) as [A | A].
  - specialize (T1 A).
    assert (F1 := pos2 (b * d) t Hbd (proj1 T1)).
    assert (F4 : b * k * (s - Es) <= b * k * sm) by (apply le2; lra).
    assert (F5 := pos2 (b * k) sm Hbk A). split; intro B; lra.
  - assert (A' : sm <= 0) by lra. specialize (T2 A').
    assert (F1 := le2 (b * d) _ _ Hbd (proj1 T2)).
    assert (F3 : 0 <= (1 - b * (k + d * q)) * (- sm)) by (apply pos2; lra).
    split; intro B; [assert (F5 := pos2 (1 - b * k) s Hbk1 B) |]; lra.
Qed.

Section Limit.
Variables h lambda k q dmax gmin gmax W Xi Es Re Rs Rz S Z reserve : R.
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Hk : 0 < k) (Hq : 0 <= q)
  (Hd : 0 <= dmax) (Hg : 0 < gmin) (Hes : 0 <= Es).
(* Those of box_invariant; what rounding adds to s comes with e or with z. *)
Hypothesis Hhl : h * lambda <= 1.
Hypothesis Hstep : h * lambda * gmax * (k + dmax * q) <= 1.
Hypothesis Hroom_z : h * S + Rz <= h * (lambda * Z).
Hypothesis Hstiff : Z <= lambda * k * S.
Hypothesis Hroom_s :
  h * lambda * W + h * Xi + Rs + Es <= h * gmin * (lambda * k * S - Z).
Hypothesis Hrounded : Re + lambda * Rz <= Rs.
Hypothesis Hrz0 : 0 <= Rz.
(* And three for the limit: what it leaves beyond reference and load; the last two are of a z
   that waits. *)
Hypothesis Hreserve : lambda * Z - S <= reserve.
Hypothesis Hwaits : h * lambda * (2 + gmax * k) <= 1. (* longer steps throw s over its box *)
Hypothesis Hslack : lambda * (lambda * Z - S) <= 2 * gmin * Z.

Section From_above.
Variables g d t w xi s sm z re rz : R.
Hypotheses (Hg' : gmin <= g <= gmax) (Hd' : 0 <= d <= dmax) (Ht : is_sign q sm t)
  (Hw : - W <= w <= W) (Hxi : - (h * Xi) <= xi <= h * Xi) (Hsm : - Es <= sm - s <= Es)
  (Hre : - Re <= re <= Re) (Hrz : - Rz <= rz <= Rz) (Hs : - S <= s <= S) (Hz : - Z <= z <= Z).

(* With a z that waits, the step of s still stays below S. *)
Lemma s_below_while_z_waits : s - lambda * z < 0 ->
  s_next h lambda k g d t w xi s sm z - lambda * z_next h lambda s z + re + lambda * z <= S.
Proof.
  intro He.
  destruct (step_at h lambda k q dmax gmin gmax Hh Hl Hk Hq Hg Hstep g d Hg' Hd') as [Hb Hst].
  assert (P := pull_from_above _ k d q t s sm Es Hb (Rlt_le _ _ Hk) (proj1 Hd') Hes Hst Hq Ht Hsm).
  destruct P as [P1 P2].
  assert (Hhl0 : 0 <= h * lambda) by (apply pos2; lra).
  assert (Wl := times _ _ _ Hhl0 Hw).
  assert (R : h * gmin * (lambda * k * S - Z) <= h * g * (lambda * k * S - Z)).
  { apply Rmult_le_compat_r; [lra |]. apply le2; lra. }
  assert (HS : 0 <= S) by lra. assert (HZ : 0 <= Z) by lra.
  assert (Hgg : 0 <= g) by lra.
  assert (B : h * lambda * (2 + g * k) <= 1).
  { assert (g * k <= gmax * k) by (apply Rmult_le_compat_r; lra).
    assert (X := le2 (h * lambda) (2 + g * k) (2 + gmax * k) Hhl0 ltac:(lra)). lra. }
  assert (Sl : h * (lambda * (lambda * Z - S)) <= h * (2 * g * Z)).
  { apply le2; [lra |]. assert (2 * gmin * Z <= 2 * g * Z) by (apply Rmult_le_compat_r; lra). lra. }
  assert (lRz : 0 <= lambda * Rz) by (apply pos2; lra).
  unfold s_next, z_next.
  set (f := s - h * lambda * g * (k * sm + d * t)) in *.
  assert (E : s + h * (lambda * (w - g * (k * sm + d * t)) - g * z) - xi
      - lambda * (z + h * (s - lambda * z)) + re + lambda * z
    = f + h * lambda * w - xi + re - h * lambda * s + h * lambda * (lambda * z) - h * g * z)
    by (unfold f; ring).
  rewrite E. clear E.
  (* f + ... + h*g*(lambda*k*S - Z) bounds what acts. *)
  assert (Act : h * lambda * w - xi + re + Es <= h * g * (lambda * k * S - Z)) by lra.
  assert (Hhg : 0 <= h * g) by (apply pos2; lra).
  destruct (Rle_dec 0 s) as [A | A].
  - specialize (P1 A).
    assert (Z0 : 0 <= z). { destruct (Rle_dec 0 z); [assumption |]. assert (0 <= lambda * - z) by (apply pos2; lra). lra. }
    assert (F : 0 <= (1 - h * lambda * g * k - h * lambda) * (S - s)) by (apply pos2; lra).
    destruct (Rle_dec (h * g) (h * lambda * lambda)) as [C | C].
    + assert (G : 0 <= (h * lambda * lambda - h * g) * (Z - z)) by (apply pos2; lra). lra.
    + assert (G : 0 <= (h * g - h * lambda * lambda) * z) by (apply pos2; lra).
      assert (G1 := pos2 _ _ Hhg HZ). assert (G2 := pos2 _ _ Hhl0 HS). lra.
  - assert (A' : s <= 0) by lra. specialize (P2 A').
    assert (F : 0 <= h * lambda * (S + s)) by (apply pos2; lra).
    assert (F2 : 0 <= (1 - h * lambda * (2 + g * k)) * S) by (apply pos2; lra).
    assert (G1 := pos2 _ _ Hhg HZ). assert (G2 := pos2 _ _ Hhl0 HS).
    destruct (Rle_dec 0 z) as [Zp | Zn].
    + destruct (Rle_dec (h * g) (h * lambda * lambda)) as [C | C].
      * assert (G : 0 <= (h * lambda * lambda - h * g) * (Z - z)) by (apply pos2; lra). lra.
      * assert (G : 0 <= (h * g - h * lambda * lambda) * z) by (apply pos2; lra). lra.
    + assert (Q : 0 <= h * g * (Z + z)) by (apply pos2; lra).
      assert (Q2 : 0 <= h * lambda * (- (lambda * z))).
      { apply pos2; [assumption |]. assert (0 <= lambda * - z) by (apply pos2; lra). lra. }
      lra.
Qed.

Lemma limited_from_above : forall e' z',
  reserve <= e' <= s_next h lambda k g d t w xi s sm z - lambda * z_next h lambda s z + re ->
  (s - lambda * z < 0 /\ z' = z) \/ (0 <= s - lambda * z /\ z' = z_next h lambda s z + rz) ->
  - S <= e' + lambda * z' <= S /\ - Z <= z' <= Z.
Proof.
  intros e' z' He Hcase.
  assert (Rs1 : - Rs <= re + lambda * rz <= Rs).
  { assert (X := times lambda rz Rz (Rlt_le _ _ Hl) Hrz). lra. }
  destruct (box_invariant h lambda k q dmax gmin gmax W Xi Es Rs Rz S Z Hh Hl Hk Hq Hg Hes
    Hhl Hstep Hroom_z Hstiff Hroom_s g d t w xi s sm z (re + lambda * rz) rz
    Hg' Hd' Ht Hw Hxi Hsm Rs1 Hrz Hs Hz) as [Bs Bz].
  assert (Hzz : - Z <= z' <= Z) by (destruct Hcase as [[_ E] | [_ E]]; rewrite E; assumption).
  assert (L := times lambda _ _ (Rlt_le _ _ Hl) Hzz).
  split; [| assumption]. split; [lra |].
  destruct Hcase as [[Neg E] | [_ E]]; rewrite E.
  - assert (X := s_below_while_z_waits Neg). lra.
  - lra.
Qed.
End From_above.

Lemma sign_is_odd : forall sm t, is_sign q sm t -> is_sign q (- sm) (- t).
Proof. intros sm t [A B]. split; intro H; [assert (X := B ltac:(lra)) | assert (X := A ltac:(lra))]; lra. Qed.

(* The box is kept, whether the limit is met or not. *)
Theorem box_at_a_limit : forall g d t w xi s sm z re rz e' z',
  gmin <= g <= gmax -> 0 <= d <= dmax -> is_sign q sm t ->
  - W <= w <= W -> - (h * Xi) <= xi <= h * Xi ->
  - Es <= sm - s <= Es -> - Re <= re <= Re -> - Rz <= rz <= Rz ->
  - S <= s <= S -> - Z <= z <= Z ->
  limited reserve (s - lambda * z) z
    (s_next h lambda k g d t w xi s sm z - lambda * z_next h lambda s z + re)
    (z_next h lambda s z + rz) e' z' ->
  - S <= e' + lambda * z' <= S /\ - Z <= z' <= Z.
Proof.
  intros g d t w xi s sm z re rz e' z' Hg' Hd' Ht Hw Hxi Hsm Hre Hrz Hs Hz Hlim.
  assert (Mirror : forall e1 z1,
    reserve <= - e1 -> s_next h lambda k g d t w xi s sm z - lambda * z_next h lambda s z + re <= e1 ->
    (0 < s - lambda * z /\ z1 = z) \/ (s - lambda * z <= 0 /\ z1 = z_next h lambda s z + rz) ->
    - S <= e1 + lambda * z1 <= S /\ - Z <= z1 <= Z).
  { intros e1 z1 H1 H2 Hc.
    destruct (limited_from_above g d (- t) (- w) (- xi) (- s) (- sm) (- z) (- re) (- rz)
      Hg' Hd' (sign_is_odd _ _ Ht) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra) ltac:(lra)
      ltac:(lra) ltac:(lra) (- e1) (- z1)) as [A B].
    - split; [assumption |]. unfold s_next, z_next in *. lra.
    - destruct Hc as [[N E] | [N E]]; [left | right]; (split; [lra |]); unfold z_next in *; lra.
    - lra. }
  destruct Hlim as [| e1 N R | e1 N R | e1 N R | e1 N R].
  - assert (Rs1 : - Rs <= re + lambda * rz <= Rs).
    { assert (X := times lambda rz Rz (Rlt_le _ _ Hl) Hrz). lra. }
    destruct (box_invariant h lambda k q dmax gmin gmax W Xi Es Rs Rz S Z Hh Hl Hk Hq Hg Hes
      Hhl Hstep Hroom_z Hstiff Hroom_s g d t w xi s sm z (re + lambda * rz) rz
      Hg' Hd' Ht Hw Hxi Hsm Rs1 Hrz Hs Hz) as [Bs Bz]. lra.
  - eapply limited_from_above; eauto.
  - eapply limited_from_above; eauto.
  - apply Mirror; [lra | lra | left; auto].
  - apply Mirror; [lra | lra | right; auto].
Qed.
End Limit.

(* Attraction where a limit is met: outside, at M > S, s comes in by its share of what it is
   beyond S, or by the margin that the limit leaves, whichever is less. *)
Section Attraction_at_a_limit.
Variables h lambda k q dmax gmin gmax W Xi S margin : R.
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Hk : 0 < k) (Hq : 0 <= q)
  (Hd : 0 <= dmax) (Hg : 0 < gmin).
Hypothesis Hhl : h * lambda <= 1.
Hypothesis Hstep : h * lambda * gmax * (k + dmax * q) <= 1.
Hypothesis Hstiff : / lambda < lambda * k.
Hypothesis Hroom : lambda * W + Xi <= gmin * (lambda * k - / lambda) * S.
Hypothesis Hwaits : h * lambda * (2 + gmax * k) <= 1.
Hypothesis Hmargin : 0 <= margin.

Let come M := M - Rmin (share h lambda k gmin * (M - S)) margin.

Lemma comes_from_above : forall g d t w xi s z e' z' M,
  gmin <= g <= gmax -> 0 <= d <= dmax -> is_sign q s t ->
  - W <= w <= W -> - (h * Xi) <= xi <= h * Xi -> S <= M -> 0 <= M ->
  - M <= s <= M -> - (M * / lambda) <= z <= M * / lambda ->
  margin <= e' <= s_next h lambda k g d t w xi s s z - lambda * z_next h lambda s z ->
  (s - lambda * z < 0 /\ z' = z) \/ (0 <= s - lambda * z /\ z' = z_next h lambda s z) ->
  - come M <= e' + lambda * z' <= come M.
Proof.
  intros g d t w xi s z e' z' M Hg' Hd' Ht Hw Hxi HM HM0 Hs Hz He Hc.
  assert (EM : lambda * (M * / lambda) = M) by (field; lra).
  assert (In := s_comes_in h lambda k q dmax gmin gmax W Xi S Hh Hl Hk Hq Hg Hstep Hstiff
    Hroom g d t w xi s z M Hg' Hd' Ht Hw Hxi HM HM0 Hs Hz).
  assert (Zf := z_follows h lambda Hh Hl Hhl s z M M Hs Hz).
  assert (Hzz : - (M * / lambda) <= z' <= M * / lambda).
  { destruct Hc as [[_ E] | [_ E]]; rewrite E; [assumption |].
    replace ((1 - h * lambda) * M + h * lambda * M) with M in Zf by ring. exact Zf. }
  assert (L := times lambda _ _ (Rlt_le _ _ Hl) Hzz). rewrite EM in L.
  assert (C1 := Rmin_l (share h lambda k gmin * (M - S)) margin).
  assert (C2 := Rmin_r (share h lambda k gmin * (M - S)) margin).
  unfold come. split; [lra |].
  apply Rle_trans with (M - share h lambda k gmin * (M - S)); [| lra].
  destruct Hc as [[Neg E] | [_ E]]; [| rewrite E; lra].
  (* While z waits: the box theorem of a box M that the room is scaled to. *)
  assert (Sh0 : 0 <= h * gmin * (lambda * k - / lambda)) by (apply pos2; [apply pos2; lra | lra]).
  rewrite E.
  assert (Room : h * lambda * W + h * (Xi + gmin * (lambda * k - / lambda) * (M - S)) + 0 + 0
      <= h * gmin * (lambda * k * M - M * / lambda)).
  { assert (A := le2 h _ _ (Rlt_le _ _ Hh) Hroom). lra. }
  (* What s loses is given to xi. *)
  assert (G : 0 <= h * (gmin * (lambda * k - / lambda) * (M - S))).
  { apply pos2; [lra |]. apply pos2; [apply pos2; lra | lra]. }
  assert (Hst : M * / lambda <= lambda * k * M) by (assert (A := le2 M _ _ HM0 (Rlt_le _ _ Hstiff)); lra).
  assert (Sl : lambda * (lambda * (M * / lambda) - M) <= 2 * gmin * (M * / lambda)).
  { rewrite EM. assert (0 <= gmin * (M * / lambda)).
    { apply pos2; [lra |]. apply pos2; [lra | left; apply Rinv_0_lt_compat; lra]. } lra. }
  assert (X := s_below_while_z_waits h lambda k q dmax gmin gmax W
    (Xi + gmin * (lambda * k - / lambda) * (M - S)) 0 0 0 0 M (M * / lambda)
    Hh Hl Hk Hq Hg (Rle_refl 0) Hstep Hst Room ltac:(lra) ltac:(lra) Hwaits Sl
    g d t w (xi - h * (gmin * (lambda * k - / lambda) * (M - S))) s s z 0
    Hg' Hd' Ht Hw ltac:(lra) ltac:(lra) ltac:(lra) Hs Hz Neg).
  unfold share, s_next in *. lra.
Qed.

Theorem s_comes_in_at_a_limit : forall g d t w xi s z e' z' M,
  gmin <= g <= gmax -> 0 <= d <= dmax -> is_sign q s t ->
  - W <= w <= W -> - (h * Xi) <= xi <= h * Xi -> S <= M -> 0 <= M ->
  - M <= s <= M -> - (M * / lambda) <= z <= M * / lambda ->
  limited margin (s - lambda * z) z
    (s_next h lambda k g d t w xi s s z - lambda * z_next h lambda s z)
    (z_next h lambda s z) e' z' ->
  - come M <= e' + lambda * z' <= come M.
Proof.
  intros g d t w xi s z e' z' M Hg' Hd' Ht Hw Hxi HM HM0 Hs Hz Hlim.
  assert (Mirror : forall e1 z1,
    margin <= - e1 -> s_next h lambda k g d t w xi s s z - lambda * z_next h lambda s z <= e1 ->
    (0 < s - lambda * z /\ z1 = z) \/ (s - lambda * z <= 0 /\ z1 = z_next h lambda s z) ->
    - come M <= e1 + lambda * z1 <= come M).
  { intros e1 z1 H1 H2 Hc.
    assert (X := comes_from_above g d (- t) (- w) (- xi) (- s) (- z) (- e1) (- z1) M
      Hg' Hd' (sign_is_odd q s t Ht) ltac:(lra) ltac:(lra) HM HM0 ltac:(lra) ltac:(lra)).
    assert (Y : - come M <= - e1 + lambda * - z1 <= come M); [apply X | lra].
    - split; [assumption |]. unfold s_next, z_next in *. lra.
    - destruct Hc as [[N E] | [N E]]; [left | right]; (split; [lra |]); unfold z_next in *; lra. }
  destruct Hlim as [| e1 N R | e1 N R | e1 N R | e1 N R].
  - assert (In := s_comes_in h lambda k q dmax gmin gmax W Xi S Hh Hl Hk Hq Hg Hstep Hstiff
      Hroom g d t w xi s z M Hg' Hd' Ht Hw Hxi HM HM0 Hs Hz).
    assert (C1 := Rmin_l (share h lambda k gmin * (M - S)) margin). unfold come. lra.
  - eapply comes_from_above; eauto.
  - eapply comes_from_above; eauto.
  - apply Mirror; [lra | lra | left; auto].
  - apply Mirror; [lra | lra | right; auto].
Qed.

(* z comes in as it does without a limit: one that waits lies within the bounds of s already. *)
Theorem z_follows_at_a_limit : forall s z M M' e' z' ev,
  M' <= M -> - M' <= s <= M' -> - M' <= e' + lambda * z' <= M' ->
  - (M * / lambda) <= z <= M * / lambda ->
  limited margin (s - lambda * z) z ev (z_next h lambda s z) e' z' ->
  - (((1 - h * lambda) * M + h * lambda * M') * / lambda) <= z'
    <= ((1 - h * lambda) * M + h * lambda * M') * / lambda.
Proof.
  intros s z M M' e' z' ev HM Hs Hs' Hz Hlim.
  assert (F := z_follows h lambda Hh Hl Hhl s z M M' Hs Hz).
  set (Q := (1 - h * lambda) * M + h * lambda * M') in *.
  assert (HQ : M' <= Q).
  { assert (0 <= (1 - h * lambda) * (M - M')) by (apply pos2; lra). unfold Q. lra. }
  assert (Inside : - Q <= lambda * z' <= Q -> - (Q * / lambda) <= z' <= Q * / lambda).
  { intro I. assert (E : lambda * (Q * / lambda) = Q) by (field; lra).
    split; apply Rmult_le_reg_l with lambda; lra. }
  destruct Hlim as [| e1 N R | e1 N R | e1 N R | e1 N R]; try exact F; apply Inside; lra.
Qed.
End Attraction_at_a_limit.

(* The controller as it is shipped, limit and all, in exact arithmetic. *)
Section Limited_loop.
Variables (h lambda k : R) (T : R -> R) (p : world) (est : estimates) (low high : R).
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Ha : 0 < alpha p) (Hrange : low <= high).

(* Limits::apply, and the two lines of advance() about z: asks_more. *)
Definition u_limited (n : nat) (u z : R) : R := clampR low high (u_next h lambda k T p est n u z).
Definition z_limited (n : nat) (u z : R) : R :=
  let e := y p u n - r p n in
  let wanted := u_next h lambda k T p est n u z in
  let command := u_limited n u z in
  if Rlt_dec command wanted then (if Rlt_dec e 0 then z else z_next' h p n u z)
  else if Rlt_dec wanted command then (if Rlt_dec 0 e then z else z_next' h p n u z)
  else z_next' h p n u z.

Fixpoint run_limited (u0 z0 : R) (n : nat) : R * R :=
  match n with
  | O => (u0, z0)
  | S m => let (u, z) := run_limited u0 z0 m in (u_limited m u z, z_limited m u z)
  end.

(* The limit holds the reference against the load, at every sample. *)
Hypothesis Hhigh : forall n, r p n + dot (theta p) (x p n) + D p n <= alpha p * high.
Hypothesis Hlow : forall n, alpha p * low <= r p n + dot (theta p) (x p n) + D p n.

Lemma the_controller_is_limited : forall n u z,
  limited 0 (y p u n - r p n) z
    (y p (u_next h lambda k T p est n u z) (S n) - r p (S n)) (z_next' h p n u z)
    (y p (u_limited n u z) (S n) - r p (S n)) (z_limited n u z).
Proof.
  intros n u z. unfold z_limited. set (v := u_next h lambda k T p est n u z).
  assert (C : u_limited n u z = clampR low high v) by reflexivity.
  assert (Hi := Hhigh (S n)). assert (Lo := Hlow (S n)).
  destruct (Rlt_dec (u_limited n u z) v) as [Above | A].
  - assert (E : u_limited n u z = high).
    { rewrite C in *. unfold clampR, Rmax, Rmin in *.
      destruct (Rle_dec high v); destruct (Rle_dec low _); lra. }
    rewrite E in *. assert (M := Rmult_lt_compat_l _ _ _ Ha Above).
    destruct (Rlt_dec (y p u n - r p n) 0) as [N | N];
      [apply above_waits; [assumption |] | apply above; [apply Rnot_lt_le; assumption |]];
      unfold y; lra.
  - destruct (Rlt_dec v (u_limited n u z)) as [Below | B].
    + assert (E : u_limited n u z = low).
      { rewrite C in *. unfold clampR, Rmax, Rmin in *.
        destruct (Rle_dec high v); destruct (Rle_dec low _); lra. }
      rewrite E in *. assert (M := Rmult_lt_compat_l _ _ _ Ha Below).
      destruct (Rlt_dec 0 (y p u n - r p n)) as [N | N];
        [apply below_waits; [assumption |] | apply below; [apply Rnot_lt_le; assumption |]];
        unfold y; lra.
    + replace (u_limited n u z) with v by lra. apply free.
Qed.

Variables q dmax gmin gmax W Xi B : R.
Hypotheses (Hk : 0 < k) (Hq : 0 <= q) (Hd : 0 <= dmax) (Hg : 0 < gmin).
Hypothesis Hhl : h * lambda <= 1.
Hypothesis Hstep : h * lambda * gmax * (k + dmax * q) <= 1.
Hypothesis HB : 0 <= B.
Hypothesis Hstiff : / lambda <= lambda * k.
Hypothesis Hroom : lambda * W + Xi <= gmin * (lambda * k - / lambda) * B.
Hypothesis Hwaits : h * lambda * (2 + gmax * k) <= 1.
Hypothesis HT : forall s, is_sign q s (T s).
Hypothesis Hgs : forall n, gmin <= g p est n <= gmax.
Hypothesis Hds : forall n, 0 <= delta_hat est n <= dmax.
Hypothesis Hws : forall n, - W <= w h lambda p est n <= W.
Hypothesis Hxis : forall n, - (h * Xi) <= xi p n <= h * Xi.

Theorem the_error_stays_in_its_box_at_a_limit : forall u0 z0,
  - B <= s_of lambda p 0 u0 z0 <= B -> - (B * / lambda) <= z0 <= B * / lambda ->
  forall n, let (u, z) := run_limited u0 z0 n in
    - B <= s_of lambda p n u z <= B /\ - (B * / lambda) <= z <= B * / lambda
    /\ - (2 * B) <= y p u n - r p n <= 2 * B.
Proof.
  intros u0 z0 Hs0 Hz0.
  assert (E : lambda * (B * / lambda) = B) by (field; lra).
  assert (Core : forall n, let (u, z) := run_limited u0 z0 n in
    - B <= s_of lambda p n u z <= B /\ - (B * / lambda) <= z <= B * / lambda).
  { induction n as [| n IH]; [ simpl; auto |].
    cbn [run_limited]. destruct (run_limited u0 z0 n) as [u z]. destruct IH as [Is Iz].
    assert (Lim := the_controller_is_limited n u z).
    destruct (the_controller_is_the_recursion h lambda k T p est Hh Hl n u z) as [E1 E2].
    assert (Rm : h * lambda * W + h * Xi + 0 + 0 <= h * gmin * (lambda * k * B - B * / lambda)).
    { assert (A := le2 h _ _ (Rlt_le _ _ Hh) Hroom). lra. }
    assert (St : B * / lambda <= lambda * k * B) by (assert (A := le2 B _ _ HB Hstiff); lra).
    assert (Bl : 0 <= B * / lambda) by (apply pos2; [lra | left; apply Rinv_0_lt_compat; lra]).
    assert (Sl : lambda * (lambda * (B * / lambda) - B) <= 2 * gmin * (B * / lambda)).
    { rewrite E. assert (0 <= gmin * (B * / lambda)) by (apply pos2; lra). lra. }
    assert (Rz0 : h * B + 0 <= h * (lambda * (B * / lambda))) by (rewrite E; lra).
    set (s := s_of lambda p n u z) in *.
    assert (P := box_at_a_limit h lambda k q dmax gmin gmax W Xi 0 0 0 0 B (B * / lambda) 0
      Hh Hl Hk Hq Hg (Rle_refl 0) Hhl Hstep Rz0 St Rm ltac:(lra) ltac:(lra) ltac:(lra)
      Hwaits Sl (g p est n) (delta_hat est n) (T s) (w h lambda p est n) (xi p n) s s z 0 0
      (y p (u_limited n u z) (S n) - r p (S n)) (z_limited n u z)
      (Hgs n) (Hds n) (HT s) (Hws n) (Hxis n) ltac:(lra) ltac:(lra) ltac:(lra) Is Iz).
    apply P. unfold s at 1. unfold s_of at 1.
    replace (y p u n - r p n + lambda * z - lambda * z) with (y p u n - r p n) by ring.
    fold s in E1, E2. rewrite <- E1, <- E2. unfold s_of.
    replace (y p (u_next h lambda k T p est n u z) (S n) - r p (S n) + lambda * z_next' h p n u z
      - lambda * z_next' h p n u z + 0)
      with (y p (u_next h lambda k T p est n u z) (S n) - r p (S n)) by ring.
    rewrite Rplus_0_r. exact Lim. }
  intro n. specialize (Core n). destruct (run_limited u0 z0 n) as [u z].
  destruct Core as [Cs Cz]. unfold s_of in *.
  assert (A := times lambda _ _ (Rlt_le _ _ Hl) Cz). lra.
Qed.
End Limited_loop.
