(* The step of the Bouc-Wen state in bounded time, Shape::advance_bounded, meets the condition
   that inverse_exists (Hysteresis.v) puts on eta: along the path it does not fall, and rises no
   faster than 2*sigma. Over the reals; of the powers only what is stated with each part.

   zeta after the path p is piece by piece a smooth function of p, as the one power is of where
   the step starts; so slopes are bounded piece by piece, and pieces are joined. *)
Require Import Reals Lra Psatz.
Require Import Box.
Open Scope R_scope.

(* Between two slopes on [a, b]. *)
Definition slopes (f : R -> R) (low high a b : R) : Prop :=
  forall x y, a <= x -> x <= y -> y <= b -> low * (y - x) <= f y - f x <= high * (y - x).

Lemma slopes_of_derivative : forall f f' low high a b,
  (forall x, a <= x <= b -> derivable_pt_lim f x (f' x)) ->
  (forall x, a <= x <= b -> low <= f' x <= high) -> slopes f low high a b.
Proof.
  intros f f' low high a b D B x y Hx Hxy Hy. destruct (Rle_lt_or_eq_dec _ _ Hxy) as [L | E].
  - destruct (MVT_cor2 f f' x y L) as (c & E & Hc); [intros; apply D; lra |].
    assert (Bc := B c ltac:(lra)). rewrite E. split; apply Rmult_le_compat_r; lra.
  - subst. lra.
Qed.

Theorem pieces_join : forall f low high a b c,
  slopes f low high a b -> slopes f low high b c -> slopes f low high a c.
Proof.
  intros f low high a b c A B x y Hx Hxy Hy.
  destruct (Rle_dec y b) as [L | L]; [apply A; lra |].
  destruct (Rle_dec b x) as [M | M]; [apply B; lra |].
  assert (P := A x b Hx ltac:(lra) (Rle_refl b)). assert (Q := B b y (Rle_refl b) ltac:(lra) Hy). lra.
Qed.

(* The same of a path that is measured in another unit: p = unit*t. *)
Lemma slopes_scale : forall f low high a b unit height, 0 < unit -> 0 <= height ->
  slopes f low high a b ->
  slopes (fun p => height * f (p / unit)) (height * low / unit) (height * high / unit) (unit * a) (unit * b).
Proof.
  intros f low high a b unit height Hu Hh A x y Hx Hxy Hy.
  assert (I : 0 < / unit) by (apply Rinv_0_lt_compat; lra).
  assert (T : forall v, unit * (v / unit) = v) by (intro; field; lra).
  assert (L : forall v v', v <= v' -> v / unit <= v' / unit) by (intros; apply Rmult_le_compat_r; lra).
  assert (U : forall v, unit * v / unit = v) by (intro; field; lra).
  assert (P := A (x / unit) (y / unit)).
  assert (Hx' := L _ _ Hx). assert (Hy' := L _ _ Hy). rewrite U in Hx', Hy'.
  specialize (P Hx' (L _ _ Hxy) Hy'). destruct P as [P1 P2].
  assert (Q1 := le2 height _ _ Hh P1). assert (Q2 := le2 height _ _ Hh P2).
  replace (height * (low * (y / unit - x / unit))) with (height * low / unit * (y - x)) in Q1 by (field; lra).
  replace (height * (high * (y / unit - x / unit))) with (height * high / unit * (y - x)) in Q2 by (field; lra).
  lra.
Qed.

(* Polynomials of third degree, and their quotients. *)
Definition cubic (c0 c1 c2 c3 t : R) : R := c0 + t * (c1 + t * (c2 + t * c3)).
Definition cubic' (c1 c2 c3 t : R) : R := c1 + 2 * c2 * t + 3 * c3 * t ^ 2.
Lemma cubic_derives : forall c0 c1 c2 c3 t,
  derivable_pt_lim (cubic c0 c1 c2 c3) t (cubic' c1 c2 c3 t).
Proof.
  intros.
  replace (cubic' c1 c2 c3 t)
    with (0 + (1 * (c1 + t * (c2 + t * c3)) + t * (0 + (1 * (c2 + t * c3) + t * (0 + (1 * c3 + t * 0))))))
    by (unfold cubic'; ring).
  change (cubic c0 c1 c2 c3) with
    (fct_cte c0 + id * (fct_cte c1 + id * (fct_cte c2 + id * fct_cte c3)))%F.
  assert (P : forall c (f : R -> R) d, derivable_pt_lim f t d ->
    derivable_pt_lim (fct_cte c + id * f)%F t (0 + (1 * f t + t * d))).
  { intros c f d H. apply derivable_pt_lim_plus; [apply derivable_pt_lim_const |].
    exact (derivable_pt_lim_mult id f t 1 d (derivable_pt_lim_id t) H). }
  apply P. apply P. apply P. apply derivable_pt_lim_const.
Qed.

Lemma quotient_derives : forall f g t f' g', g t <> 0 ->
  derivable_pt_lim f t f' -> derivable_pt_lim g t g' ->
  derivable_pt_lim (fun x => f x / g x) t ((f' * g t - g' * f t) / (g t) ^ 2).
Proof.
  intros f g t f' g' Hg Hf Hgg. replace (g t ^ 2) with (Rsqr (g t)) by (unfold Rsqr; ring).
  apply (derivable_pt_lim_div f g t f' g' Hf Hgg Hg).
Qed.

(* Loading, `approach`: zeta + w*(1 - 1/(1 + m)^2), m of r; turn is w*|f'|/f, clamped to one. *)
Section Loading.
Variable turn : R.
Hypothesis Hturn : 0 <= turn <= 1.
Let A := 3 / 8 - turn / 4.
Let B := 5 / 16 - 3 * turn / 8 + turn ^ 2 / 12.
Definition gone (r : R) : R := 1 - 1 / (cubic 1 (1 / 2) A B r) ^ 2.

Lemma m_rises_no_faster : forall r, 0 <= r ->
  0 < cubic 1 (1 / 2) A B r /\ 0 <= 2 * cubic' (1 / 2) A B r <= (cubic 1 (1 / 2) A B r) ^ 3.
Proof.
  intros r Hr. assert (HA : 1 / 8 <= A <= 3 / 8) by (unfold A; lra).
  assert (HB : 0 <= B) by (unfold B; nra).
  assert (HB2 : 6 * B <= 3 * A + 3 / 4) by (unfold A, B; nra).
  unfold cubic, cubic'. set (m := r * (1 / 2 + r * (A + r * B))).
  assert (Hm : 0 <= m).
  { unfold m. apply pos2; [lra |]. assert (0 <= r * (A + r * B)); [| lra].
    apply pos2; [lra |]. assert (0 <= r * B) by (apply pos2; lra). lra. }
  assert (R2 : 0 <= r ^ 2) by apply pow2_ge_0. assert (R3 : 0 <= r ^ 3) by (apply pow_le; lra).
  assert (R2B := pos2 _ _ R2 HB). assert (RA : 0 <= r * A) by (apply pos2; lra).
  split; [lra |]. split; [nra |].
  assert (M2 : r ^ 2 / 4 + r ^ 3 * A <= m ^ 2).
  { replace (m ^ 2) with (r ^ 2 / 4 + r ^ 3 * A + r ^ 4 * B + r ^ 4 * (A + r * B) ^ 2) by (unfold m; field).
    assert (0 <= r ^ 4) by (apply pow_le; lra).
    assert (0 <= r ^ 4 * B) by (apply pos2; lra).
    assert (0 <= r ^ 4 * (A + r * B) ^ 2) by (apply pos2; [lra | apply pow2_ge_0]). lra. }
  assert (M3 : 0 <= m ^ 3) by (apply pow_le; lra).
  replace ((1 + m) ^ 3) with (1 + 3 * m + 3 * m ^ 2 + m ^ 3) by ring.
  assert (E : 3 * m = 3 / 2 * r + 3 * A * r ^ 2 + 3 * r ^ 3 * B) by (unfold m; field).
  assert (R3B := pos2 _ _ R3 HB). assert (R3A : 0 <= r ^ 3 * A) by (apply pos2; lra).
  assert (Q : r ^ 2 * (6 * B) <= r ^ 2 * (3 * A + 3 / 4)) by (apply le2; lra).
  assert (Q1 : r * (4 * A) <= r * (3 / 2)) by (apply le2; lra). lra.
Qed.

Lemma gone_rises : forall last, slopes gone 0 1 0 last.
Proof.
  intro last.
  apply slopes_of_derivative with (f' := fun r => 2 * cubic' (1 / 2) A B r / (cubic 1 (1 / 2) A B r) ^ 3).
  - intros r [Hr _]. destruct (m_rises_no_faster r Hr) as (P & _).
    set (g := cubic 1 (1 / 2) A B) in *.
    assert (Dg : derivable_pt_lim g r (cubic' (1 / 2) A B r)) by apply cubic_derives.
    assert (D2 := derivable_pt_lim_mult g g r _ _ Dg Dg).
    assert (Dq := quotient_derives (fct_cte 1) (g * g)%F r 0 _
      ltac:(unfold mult_fct; apply Rgt_not_eq; apply Rmult_lt_0_compat; assumption)
      (derivable_pt_lim_const 1 r) D2).
    assert (Dd := derivable_pt_lim_minus (fct_cte 1) _ r 0 _ (derivable_pt_lim_const 1 r) Dq).
    replace (2 * cubic' (1 / 2) A B r / g r ^ 3) with
      (0 - (0 * (g * g)%F r - (cubic' (1 / 2) A B r * g r + g r * cubic' (1 / 2) A B r) * fct_cte 1 r) / (g * g)%F r ^ 2).
    + intros eps He. destruct (Dd eps He) as [d Hd]. exists d. intros x Hx Hxd.
      specialize (Hd x Hx Hxd). unfold gone, minus_fct, fct_cte, mult_fct, g in *.
      replace (1 - 1 / cubic 1 (1 / 2) A B (r + x) ^ 2 - (1 - 1 / cubic 1 (1 / 2) A B r ^ 2))
        with (1 - 1 / (cubic 1 (1 / 2) A B (r + x) * cubic 1 (1 / 2) A B (r + x))
          - (1 - 1 / (cubic 1 (1 / 2) A B r * cubic 1 (1 / 2) A B r)));
      [exact Hd | simpl; rewrite !Rmult_1_r; reflexivity].
    + unfold mult_fct, fct_cte. field. lra.
  - intros r [Hr _]. destruct (m_rises_no_faster r Hr) as (P & Q1 & Q2).
    assert (P3 : 0 < cubic 1 (1 / 2) A B r ^ 3) by (apply pow_lt; assumption).
    split.
    + apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; assumption].
    + apply Rmult_le_reg_r with (cubic 1 (1 / 2) A B r ^ 3); [assumption |].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
Qed.
End Loading.

(* The slope while loading is at most f, and f is at most one: any f in [0, 1] will do, from any
   power. *)
Theorem loading_rises_no_faster_than_f : forall turn zeta w f last,
  0 <= turn <= 1 -> 0 < w -> 0 < f ->
  slopes (fun p => zeta + w * gone turn (p / (w / f))) 0 f 0 last.
Proof.
  intros turn zeta w f last Ht Hw Hf x y Hx Hxy Hy.
  assert (Hu : 0 < w / f) by (apply Rdiv_lt_0_compat; lra).
  assert (P := slopes_scale (gone turn) 0 1 0 (last / (w / f)) (w / f) w Hu (Rlt_le _ _ Hw)
    (gone_rises turn Ht (last / (w / f)))).
  replace (w * 0 / (w / f)) with 0 in P by (field; lra).
  replace (w * 1 / (w / f)) with f in P by (field; lra).
  replace (w / f * 0) with 0 in P by ring.
  replace (w / f * (last / (w / f))) with last in P by (field; lra).
  specialize (P x y Hx Hxy Hy). cbv beta in P. lra.
Qed.

(* Unloading where n*x <= 3, x = c*a^n: from -a the step is -a*(1 - t)/D(t) with t = p/(a*H), D
   with alpha = f*H - 1, beta = f*H*(alpha - n*x*H/2), gamma = 1/H - 1 - alpha - beta. H is the
   path to zero over a, 1/(1 + eta): flat_share has eta = x/(n + 1)*(a share). *)
Section Flat.
Variables n x eta : R.
Hypotheses (Hn : 1 <= n) (Hx : 0 <= x) (Hnx : n * x <= 3) (Heta : 0 <= eta) (Hx1 : eta * (n + 1) <= x).
Let f := 1 + x.
Let H := / (1 + eta).
Let u := f * H.
Let alpha := u - 1.
Let beta := u * (alpha - n * x * H / 2).
Let gamma := 1 + eta - 1 - alpha - beta.
Definition D (t : R) : R := cubic 1 alpha beta gamma t.
Definition below (t : R) : R := - (1 - t) / D t.
(* D + (1 - t)*D', the slope times D^2. *)
Definition above (t : R) : R := D t + (1 - t) * cubic' alpha beta gamma t.

Lemma H_bounds : 0 < H /\ H * (1 + eta) = 1.
Proof. unfold H. split; [apply Rinv_0_lt_compat; lra | field; lra]. Qed.

Lemma eta_below_x : eta <= x / 2 /\ eta <= 3 / 2.
Proof.
  assert (A : eta * 2 <= eta * (n + 1)) by (apply Rmult_le_compat_l; lra).
  assert (B : 1 * x <= n * x) by (apply Rmult_le_compat_r; lra). lra.
Qed.

Lemma u_above_one : 1 <= u.
Proof.
  destruct H_bounds as [P E]. destruct eta_below_x as [A _].
  unfold u. rewrite <- E, Rmult_comm. apply Rmult_le_compat_r; unfold f; lra.
Qed.

(* Bernstein's coefficients of D: none is below 0, so D is positive. *)
Lemma D_positive : forall t, 0 <= t <= 1 -> 0 < D t.
Proof.
  intros t Ht. destruct H_bounds as [P E]. assert (U := u_above_one).
  assert (B2 : 0 <= 3 + 2 * alpha + beta).
  { assert (Sq : 0 <= (1 + eta) ^ 2 * (3 + 2 * alpha + beta)).
    { assert (K : (1 + eta) ^ 2 * (3 + 2 * alpha + beta) = f * (1 + eta) + (1 + eta) ^ 2 + f ^ 2 - f * (n * x) / 2).
      { unfold beta, alpha, u, H. field. lra. }
      rewrite K. assert (F : 1 <= f) by (unfold f; lra).
      assert (f * (n * x) <= f * 3) by (apply le2; lra).
      assert (0 <= f * eta) by (apply pos2; lra). nra. }
    destruct (Rle_dec 0 (3 + 2 * alpha + beta)); [assumption |].
    assert (0 < (1 + eta) ^ 2) by (apply pow_lt; lra). nra. }
  assert (K : D t = (1 - t) ^ 3 + t * (1 - t) ^ 2 * (3 + alpha)
      + t ^ 2 * (1 - t) * (3 + 2 * alpha + beta) + t ^ 3 * (1 + eta)).
  { unfold D, cubic, gamma. ring. }
  rewrite K. assert (Al : 0 <= alpha) by (unfold alpha; lra).
  assert (T1 : 0 <= t * (1 - t) ^ 2 * (3 + alpha)).
  { apply pos2; [apply pos2; [lra | apply pow2_ge_0] | lra]. }
  assert (T2 : 0 <= t ^ 2 * (1 - t) * (3 + 2 * alpha + beta)).
  { apply pos2; [apply pos2; [apply pow2_ge_0 | lra] | assumption]. }
  assert (T3 : 0 <= t ^ 3 * eta) by (apply pos2; [apply pow_le |]; lra).
  assert (T4 : 0 < (1 - t) ^ 3 + t ^ 3).
  { destruct (Rle_dec t (1 / 2)).
    - assert (0 < (1 - t) ^ 3) by (apply pow_lt; lra). assert (0 <= t ^ 3) by (apply pow_le; lra). lra.
    - assert (0 <= (1 - t) ^ 3) by (apply pow_le; lra). assert (0 < t ^ 3) by (apply pow_lt; lra). lra. }
  lra.
Qed.

(* Any n: the step does not fall. *)
Lemma above_positive : forall t, 0 <= t <= 1 -> 0 <= above t.
Proof.
  intros t Ht. destruct H_bounds as [P E]. assert (U := u_above_one).
  assert (H1 : H <= 1) by (assert (X := le2 H _ _ (Rlt_le _ _ P) (proj2 (conj Heta Heta))); lra).
  assert (Y : n * x * H <= 3).
  { assert (X := Rmult_le_compat_r H _ _ (Rlt_le _ _ P) Hnx). lra. }
  assert (B1 : 0 <= 3 * u + 2 * beta).
  { replace (3 * u + 2 * beta) with (u * (3 + 2 * alpha - n * x * H)) by (unfold beta; field).
    apply pos2; [| unfold alpha]; lra. }
  assert (K : above t = u * (1 - t) ^ 3 + t * (1 - t) ^ 2 * (3 * u + 2 * beta)
     + (3 * t ^ 2 * (1 - t) + t ^ 3) * (1 + eta)).
  { unfold above, D, cubic, cubic', gamma, alpha. ring. }
  rewrite K.
  assert (0 <= u * (1 - t) ^ 3) by (apply pos2; [| apply pow_le]; lra).
  assert (0 <= t * (1 - t) ^ 2 * (3 * u + 2 * beta)).
  { apply pos2; [apply pos2; [lra | apply pow2_ge_0] | assumption]. }
  assert (0 <= (3 * t ^ 2 * (1 - t) + t ^ 3) * (1 + eta)).
  { apply pos2; [| lra]. assert (0 <= t ^ 2 * (1 - t)) by (apply pos2; [apply pow2_ge_0 | lra]).
    assert (0 <= t ^ 3) by (apply pow_le; lra). lra. }
  lra.
Qed.

(* Up to n = 4: no faster than at its start. *)
Hypothesis Hn4 : n <= 4.

(* What is left of u*D^2 - above, over t: three coefficients of Bernstein, of which only this one
   needs n <= 4. Concave in eta, so that its ends will do. *)
Lemma middle_coefficient : 0 <= f ^ 2 * (f - n * x / 2) + f ^ 2 * (1 + eta) - f * (1 + eta) ^ 2 / 2
    - 3 / 2 * (1 + eta) ^ 4.
Proof.
  assert (Hy : 0 <= n * x <= 3) by (split; [apply pos2; lra | lra]).
  assert (Y4 : n * x <= 4 * x) by (apply Rmult_le_compat_r; lra).
  set (y := n * x) in Hy, Y4 |- *. set (m := n - 1).
  set (M := 1 + x / (n + 1)). set (X := 1 + eta).
  assert (HM : (M - 1) * (n + 1) = x) by (unfold M; field; lra).
  assert (XM : 1 <= X <= M).
  { split; [unfold X; lra |]. apply Rmult_le_reg_r with (n + 1); [lra |]. unfold X. lra. }
  (* At the lower end. *)
  assert (Q1 : 0 <= f ^ 2 * (f - y / 2) + f ^ 2 - f / 2 - 3 / 2).
  { assert (F2 : 0 <= f ^ 2) by apply pow2_ge_0.
    destruct (Rle_dec x (3 / 4)).
    - assert (A : f ^ 2 * (f - 2 * x) <= f ^ 2 * (f - y / 2)) by (apply le2; lra).
      unfold f in *. nra.
    - assert (A : f ^ 2 * (f - 3 / 2) <= f ^ 2 * (f - y / 2)) by (apply le2; lra).
      unfold f in *. nra. }
  (* At the upper end: a polynomial of n and y, in Bernstein's form in y. *)
  assert (QM : 0 <= f ^ 2 * (f - y / 2) + f ^ 2 * M - f * M ^ 2 / 2 - 3 / 2 * M ^ 4).
  { assert (Hm : 0 <= m <= 3) by (unfold m; lra).
    set (w := y / 3). assert (Hw : 0 <= w <= 1) by (unfold w; lra).
    set (c0 := 32 + m * (192 + m * (472 + m * (612 + m * (444 + m * (171 + m * (25 + m * (-3 - m)))))))).
    set (c1 := 68 + m * (372 + m * (797 + m * (868 + m * (511 + m * (151 + m * (11 + m * (-5 - m)))))))).
    set (c2 := 116 + m * (636 + m * (1203 + m * (1091 + m * (515 + m * (107 + m * (-6 + m * (-7 - m)))))))).
    set (c3 := 95 + m * (984 + m * (1690 + m * (1281 + m * (456 + m * (39 + m * (-26 + m * (-9 - m)))))))).
    assert (N0 : forall c k, 0 <= c -> 0 <= k -> 0 <= c + m * k).
    { intros c k Hc Hk0. assert (0 <= m * k) by (apply pos2; lra). lra. }
    assert (M2 : m * m <= 3 * m) by nra.
    assert (M3 : m * (m * m) <= 9 * m) by nra.
    assert (M4 : m * (m * (m * m)) <= 27 * m).
    { assert (m * (m * (m * m)) <= m * (9 * m)) by (apply le2; lra). lra. }
    assert (C0 : 0 <= c0) by (unfold c0; do 6 (apply N0; [lra |]); lra).
    assert (C1 : 0 <= c1) by (unfold c1; do 5 (apply N0; [lra |]); lra).
    assert (C2 : 0 <= c2) by (unfold c2; do 4 (apply N0; [lra |]); lra).
    assert (C3 : 0 <= c3) by (unfold c3; do 4 (apply N0; [lra |]); lra).
    assert (K : 2 * n ^ 4 * (n + 1) ^ 4 * (f ^ 2 * (f - y / 2) + f ^ 2 * M - f * M ^ 2 / 2 - 3 / 2 * M ^ 4)
      = y * (c0 * (1 - w) ^ 3 + 3 * c1 * w * (1 - w) ^ 2 + 3 * c2 * w ^ 2 * (1 - w) + c3 * w ^ 3)).
    { unfold c0, c1, c2, c3, w, m, M, y, f. field. lra. }
    assert (R : 0 <= 2 * n ^ 4 * (n + 1) ^ 4 * (f ^ 2 * (f - y / 2) + f ^ 2 * M - f * M ^ 2 / 2 - 3 / 2 * M ^ 4)).
    { rewrite K. apply pos2; [lra |].
      assert (0 <= c0 * (1 - w) ^ 3) by (apply pos2; [| apply pow_le]; lra).
      assert (0 <= 3 * c1 * w * (1 - w) ^ 2) by (apply pos2; [apply pos2; lra | apply pow2_ge_0]).
      assert (0 <= 3 * c2 * w ^ 2 * (1 - w)) by (apply pos2; [apply pos2; [lra | apply pow2_ge_0] | lra]).
      assert (0 <= c3 * w ^ 3) by (apply pos2; [| apply pow_le]; lra). lra. }
    assert (P : 0 < 2 * n ^ 4 * (n + 1) ^ 4).
    { apply Rmult_lt_0_compat; [apply Rmult_lt_0_compat; [lra |] |]; apply pow_lt; lra. }
    apply Rmult_le_reg_l with (2 * n ^ 4 * (n + 1) ^ 4); [assumption |]. lra. }
  (* Between: the powers lie below their chords. *)
  assert (Hf : 1 <= f) by (unfold f; lra).
  assert (X2 : X ^ 2 <= 1 + (X - 1) * (1 + M)) by nra.
  assert (X4 : X ^ 4 <= 1 + (X - 1) * ((1 + M) * (1 + M ^ 2))).
  { replace (X ^ 4) with (1 + (X - 1) * ((1 + X) * (1 + X ^ 2))) by ring.
    assert ((X - 1) * ((1 + X) * (1 + X ^ 2)) <= (X - 1) * ((1 + M) * (1 + M ^ 2))); [| lra].
    apply le2; [lra |]. assert (X ^ 2 <= M ^ 2) by nra.
    apply Rmult_le_compat; try lra. assert (0 <= X ^ 2) by apply pow2_ge_0. lra. }
  assert (FX : f / 2 * X ^ 2 <= f / 2 * (1 + (X - 1) * (1 + M))) by (apply le2; lra).
  set (a := f ^ 2 * (f - y / 2)) in *.
  assert (L : 0 <= a + f ^ 2 * X - f / 2 * (1 + (X - 1) * (1 + M))
      - 3 / 2 * (1 + (X - 1) * ((1 + M) * (1 + M ^ 2)))).
  { destruct (Req_dec M 1) as [E1 | NE].
    - assert (EX : X = 1) by lra. rewrite EX, E1. lra.
    - apply Rmult_le_reg_l with (M - 1); [lra |].
      assert (S1 := pos2 (M - X) _ ltac:(lra) Q1). assert (S2 := pos2 (X - 1) _ ltac:(lra) QM).
      replace ((M - 1) * (a + f ^ 2 * X - f / 2 * (1 + (X - 1) * (1 + M))
        - 3 / 2 * (1 + (X - 1) * ((1 + M) * (1 + M ^ 2)))))
        with ((M - X) * (a + f ^ 2 - f / 2 - 3 / 2) + (X - 1) * (a + f ^ 2 * M - f * M ^ 2 / 2 - 3 / 2 * M ^ 4))
        by field.
      lra. }
  fold X. fold a. lra.
Qed.

Lemma above_below_u : forall t, 0 <= t <= 1 -> above t <= u * (D t) ^ 2.
Proof.
  intros t Ht. destruct H_bounds as [P E]. assert (U := u_above_one).
  assert (Mid := middle_coefficient).
  set (mid := f ^ 2 * (f - n * x / 2) + f ^ 2 * (1 + eta) - f * (1 + eta) ^ 2 / 2 - 3 / 2 * (1 + eta) ^ 4) in *.
  set (E1 := alpha + t * (beta + t * gamma)).
  assert (K : u * D t ^ 2 - above t
    = t * (u * (n * x) * H * (1 - t) ^ 2 + 2 * (mid * H ^ 3) * (t * (1 - t)) + (2 * f - u - (1 + eta)) * t ^ 2)
      + u * (t * E1) ^ 2).
  { unfold mid, E1, above, D, cubic, cubic', gamma, beta, alpha, u, H. field. lra. }
  assert (L : 0 <= 2 * f - u - (1 + eta)).
  { apply Rmult_le_reg_l with (1 + eta); [lra |].
    replace ((1 + eta) * (2 * f - u - (1 + eta))) with (x * (1 + 2 * eta) - eta ^ 2)
      by (unfold u, f, H; field; lra).
    destruct eta_below_x as [A _]. nra. }
  assert (Hxn : 0 <= n * x) by (apply pos2; lra).
  assert (0 <= u * (n * x) * H * (1 - t) ^ 2).
  { apply pos2; [apply pos2; [apply pos2 |] | apply pow2_ge_0]; lra. }
  assert (0 <= 2 * (mid * H ^ 3) * (t * (1 - t))).
  { apply pos2; [| apply pos2; lra]. assert (0 <= mid * H ^ 3) by (apply pos2; [| apply pow_le]; lra). lra. }
  assert (0 <= (2 * f - u - (1 + eta)) * t ^ 2) by (apply pos2; [lra | apply pow2_ge_0]).
  assert (0 <= u * (t * E1) ^ 2) by (apply pos2; [lra | apply pow2_ge_0]).
  assert (0 <= t * (u * (n * x) * H * (1 - t) ^ 2 + 2 * (mid * H ^ 3) * (t * (1 - t))
    + (2 * f - u - (1 + eta)) * t ^ 2)) by (apply pos2; lra).
  lra.
Qed.

Lemma below_rises : slopes below 0 u 0 1.
Proof.
  apply slopes_of_derivative with (f' := fun t => above t / (D t) ^ 2).
  - intros t Ht. assert (P := D_positive t Ht).
    assert (N := cubic_derives (-1) 1 0 0 t). assert (Dd := cubic_derives 1 alpha beta gamma t).
    assert (Q := quotient_derives _ _ t _ _ (Rgt_not_eq _ _ P) N Dd).
    replace (above t / D t ^ 2) with
      ((cubic' 1 0 0 t * cubic 1 alpha beta gamma t - cubic' alpha beta gamma t * cubic (-1) 1 0 0 t)
        / cubic 1 alpha beta gamma t ^ 2)
      by (unfold above, D, cubic', cubic; f_equal; ring).
    intros eps He. destruct (Q eps He) as [d Hd]. exists d. intros k Hk0 Hkd.
    specialize (Hd k Hk0 Hkd). unfold below, D.
    replace (- (1 - (t + k))) with (cubic (-1) 1 0 0 (t + k)) by (unfold cubic; ring).
    replace (- (1 - t)) with (cubic (-1) 1 0 0 t) by (unfold cubic; ring). exact Hd.
  - intros t Ht. assert (P := D_positive t Ht). assert (A := above_positive t Ht).
    assert (B := above_below_u t Ht). assert (P2 : 0 < D t ^ 2) by (apply pow_lt; assumption).
    split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
    apply Rmult_le_reg_r with (D t ^ 2); [assumption |].
    unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
Qed.

Theorem flat_unloading_rises_no_faster_than_f : forall a, 0 < a ->
  slopes (fun p => a * below (p / (a * H))) 0 f 0 (a * H).
Proof.
  intros a Ha. destruct H_bounds as [P E].
  assert (Hu : 0 < a * H) by (apply Rmult_lt_0_compat; assumption).
  assert (S1 := slopes_scale below 0 u 0 1 (a * H) a Hu (Rlt_le _ _ Ha) below_rises).
  replace (a * 0 / (a * H)) with 0 in S1 by (field; lra).
  replace (a * u / (a * H)) with f in S1 by (unfold u; field; lra).
  replace (a * H * 0) with 0 in S1 by ring. replace (a * H * 1) with (a * H) in S1 by ring. exact S1.
Qed.
End Flat.

(* The share that flat_share computes is the H of that: eta is at most x/(n + 1). *)
Theorem flat_share_meets_the_condition : forall n x, 1 <= n -> 0 <= x ->
  let n2 := 2 * n + 1 in
  let first := x / (n + 1) in
  let third := (n + 1) ^ 2 * x / (n2 + n) in
  let over := n2 + third + n * n * first in
  0 <= first * (n2 + third) / over /\ first * (n2 + third) / over * (n + 1) <= x.
Proof.
  intros n x Hn Hx n2 first third over.
  assert (F : 0 <= first) by (unfold first; apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]).
  assert (T : 0 <= third).
  { unfold third, n2. apply Rmult_le_pos; [apply pos2; [apply pow2_ge_0 | lra] |].
    left; apply Rinv_0_lt_compat; lra. }
  assert (G : 0 <= n * n * first) by (apply pos2; [apply pos2 |]; lra).
  assert (O : 0 < over) by (unfold over, n2; lra).
  assert (I : 0 <= / over) by (left; apply Rinv_0_lt_compat; lra).
  split.
  - apply Rmult_le_pos; [apply pos2; [lra | unfold n2; lra] | assumption].
  - assert (S1 : (n2 + third) / over <= 1).
    { apply Rmult_le_reg_r with over; [assumption |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; [unfold over |]; lra. }
    assert (E : first * (n + 1) = x) by (unfold first; field; lra).
    replace (first * (n2 + third) / over * (n + 1)) with (first * (n + 1) * ((n2 + third) / over)) by (field; lra).
    rewrite E. assert (X := le2 x _ _ Hx S1). lra.
Qed.

(* Unloading where n*x > 3: -a*(1 - t)*P(s), P a fraction for a power, of any H for which first =
   f*H - 1 is above zero and second is not below it. *)
Section Steep.
Variables n first second : R.
Hypotheses (Hn : 1 <= n) (Hfirst : 0 < first) (Hsecond : 0 <= second).
Let half := n / 2.
Let A := Rabs (half - 9 / 10).
Let F := 1 + A.
Definition inverse_power (s : R) : R := (1 + s * A) / (1 + s * (F + s * (F - half))).
Definition reach (t : R) : R := first * first * t / (first + second / 2 * t).
Definition below_steep (t : R) : R := - ((1 - t) * inverse_power (reach t)).

Lemma constants : 0 <= A /\ 0 <= F - half <= F.
Proof.
  unfold F, A, half, Rabs. destruct (Rcase_abs _); lra.
Qed.

Lemma inverse_power_falls : forall s s', 0 <= s -> s <= s' ->
  0 <= inverse_power s' <= 1 /\ 0 <= inverse_power s - inverse_power s' <= s' - s.
Proof.
  intros s s' Hs Hss. destruct constants as (HA & HG & HGF). set (G := F - half) in *.
  assert (P : forall v, 0 <= v -> 1 + F * v <= 1 + v * (F + v * G)).
  { intros v Hv. assert (0 <= v * (v * G)) by (apply pos2; [| apply pos2]; lra). lra. }
  assert (HF : 1 <= F) by (unfold F; lra).
  assert (Q : forall v, 0 <= v -> 0 <= F * v) by (intros; apply pos2; lra).
  assert (P1 := P s Hs). assert (P2 := P s' ltac:(lra)).
  assert (Q1 := Q s Hs). assert (Q2 := Q s' ltac:(lra)).
  set (d := 1 + s * (F + s * G)) in *. set (d' := 1 + s' * (F + s' * G)) in *.
  assert (HAs : 0 <= s' * A) by (apply pos2; lra).
  assert (AF : s' * A <= F * s') by (unfold F; lra).
  unfold inverse_power. fold G. fold d. fold d'.
  assert (I : 0 < / (d * d')) by (apply Rinv_0_lt_compat; apply Rmult_lt_0_compat; lra).
  split.
  - split; [apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra] |].
    apply Rmult_le_reg_r with d'; [lra |]. unfold Rdiv. rewrite Rmult_assoc, Rinv_l; lra.
  - assert (E : (1 + s * A) / d - (1 + s' * A) / d'
      = (s' - s) * (1 + G * (s + s') + A * G * (s * s')) * / (d * d')).
    { unfold d, d', F in *. field. split; lra. }
    assert (HAG : 0 <= A * G) by (apply pos2; lra).
    assert (Hp : 0 <= s * s') by (apply pos2; lra).
    assert (N0 : 0 <= 1 + G * (s + s') + A * G * (s * s')).
    { assert (0 <= G * (s + s')) by (apply pos2; lra). assert (0 <= A * G * (s * s')) by (apply pos2; lra). lra. }
    assert (N1 : 1 + G * (s + s') + A * G * (s * s') <= d * d').
    { assert (M : (1 + F * s) * (1 + F * s') <= d * d') by (apply Rmult_le_compat; lra).
      assert (G * (s + s') <= F * (s + s')) by (apply Rmult_le_compat_r; lra).
      assert (A * G <= F * F) by (apply Rmult_le_compat; unfold F in *; lra).
      assert (A * G * (s * s') <= F * F * (s * s')) by (apply Rmult_le_compat_r; lra). lra. }
    rewrite E. split.
    + apply Rmult_le_pos; [apply pos2; lra | lra].
    + apply Rmult_le_reg_r with (d * d'); [apply Rmult_lt_0_compat; lra |].
      rewrite Rmult_assoc, Rinv_l, Rmult_1_r; [apply le2; lra |].
      apply Rgt_not_eq, Rmult_lt_0_compat; lra.
Qed.

Lemma reach_rises : forall t t', 0 <= t -> t <= t' -> 0 <= reach t /\ 0 <= reach t' - reach t <= first * (t' - t).
Proof.
  intros t t' Ht Htt. unfold reach. set (e := second / 2). assert (He : 0 <= e) by (unfold e; lra).
  assert (E1 := pos2 e t He Ht). assert (E2 := pos2 e t' He ltac:(lra)).
  set (d := first + e * t) in *. set (d' := first + e * t') in *.
  assert (Hd : first <= d) by (unfold d; lra). assert (Hd' : first <= d') by (unfold d'; lra).
  assert (Hf2 : 0 <= first * first) by (apply pos2; lra).
  assert (Hdd : first * first <= d * d') by (apply Rmult_le_compat; lra).
  assert (I : 0 < / (d * d')) by (apply Rinv_0_lt_compat; apply Rmult_lt_0_compat; lra).
  assert (K : first * first * t' / d' - first * first * t / d
    = first * (t' - t) * (first * first) * / (d * d')).
  { unfold d, d' in *. field. split; lra. }
  assert (Hft : 0 <= first * (t' - t)) by (apply pos2; lra).
  split; [apply Rmult_le_pos; [apply pos2; lra | left; apply Rinv_0_lt_compat; lra] |].
  rewrite K. split; [apply Rmult_le_pos; [apply pos2; lra | lra] |].
  apply Rmult_le_reg_r with (d * d'); [apply Rmult_lt_0_compat; lra |].
  rewrite Rmult_assoc, Rinv_l, Rmult_1_r; [apply le2; lra |].
  apply Rgt_not_eq, Rmult_lt_0_compat; lra.
Qed.

Theorem steep_unloading_rises_no_faster_than_f : slopes below_steep 0 (1 + first) 0 1.
Proof.
  intros t t' Ht Htt Ht'. destruct (reach_rises t t' Ht Htt) as [R0 [R1 R2]].
  destruct (inverse_power_falls (reach t) (reach t') R0 ltac:(lra)) as [[P0 P1] [Q0 Q1]].
  unfold below_steep. set (p := inverse_power (reach t)) in *. set (p' := inverse_power (reach t')) in *.
  replace (- ((1 - t') * p') - - ((1 - t) * p)) with ((1 - t) * (p - p') + (t' - t) * p') by ring.
  assert (0 <= (1 - t) * (p - p')) by (apply pos2; lra).
  assert (0 <= t * (p - p')) by (apply pos2; lra).
  assert (0 <= (t' - t) * p') by (apply pos2; lra).
  assert ((t' - t) * p' <= (t' - t) * 1) by (apply le2; lra). lra.
Qed.
End Steep.

(* From zero up to p = 1, leave_zero: p/(1 + Y + b*Y^2), Y = p*power/(n + 1). The power is drawn by
   straight lines, c0 + c1*p between two corners; of a straight line that stands for p^(n-1) two
   things are used: it is within [0, 1], and p times its slope is at most 2*(n - 1) of it. *)
Section From_zero.
Variables n c0 c1 first last : R.
Hypotheses (Hn : 1 <= n) (Hfirst : 0 <= first) (Hlast : last <= 1) (Hc1 : 0 <= c1)
  (Hpower : forall p, first <= p <= last -> 0 <= c0 + c1 * p <= 1)
  (Hsteep : forall p, first <= p <= last -> p * c1 <= 2 * (n - 1) * (c0 + c1 * p)).
Let b := (1 + n - n ^ 2) / (2 * n + 1).
Let Y := cubic 0 (c0 / (n + 1)) (c1 / (n + 1)) 0.
Definition from_zero (p : R) : R := p / (1 + Y p * (1 + b * Y p)).

Lemma between_zero_and_its_end : forall v, 0 <= v -> v * (n + 1) <= 1 ->
  0 <= 1 + 2 * b * v /\ 0 <= v * (1 + b * v) /\ (2 * n - 1) * v * (1 + 2 * b * v) <= 1 + v * (1 + b * v).
Proof.
  intros v Hv Hv1.
  assert (Eb : b * (2 * n + 1) = 1 + n - n ^ 2) by (unfold b; field; lra).
  assert (L : 0 <= 1 + 2 * b * v).
  { destruct (Rle_dec 0 b) as [B | B]; [assert (0 <= b * v) by (apply pos2; lra); lra |].
    assert (Bn : - b * 2 <= n + 1).
    { apply Rmult_le_reg_r with (2 * n + 1); [lra |]. nra. }
    assert (X : (- b * 2) * v <= (n + 1) * v) by (apply Rmult_le_compat_r; lra). lra. }
  split; [assumption |]. split.
  { apply pos2; [assumption |]. lra. }
  (* 1 - 2*(n - 1)*v - (4*n - 3)*b*v^2 >= 0 *)
  assert (K : 0 <= 1 - 2 * (n - 1) * v - (4 * n - 3) * b * v ^ 2); [| nra].
  assert (V2 : 0 <= v ^ 2) by apply pow2_ge_0.
  destruct (Rle_dec b 0) as [B | B].
  - destruct (Rle_dec n 3) as [N | N].
    + assert (0 <= (4 * n - 3) * - b * v ^ 2) by (apply pos2; [apply pos2; lra | lra]).
      assert (2 * (n - 1) * v <= (n + 1) * v) by (apply Rmult_le_compat_r; lra). lra.
    + assert (D : (n - 1) ^ 2 <= (4 * n - 3) * - b).
      { apply Rmult_le_reg_r with (2 * n + 1); [lra |].
        replace ((4 * n - 3) * - b * (2 * n + 1)) with (- (4 * n - 3) * (b * (2 * n + 1))) by ring.
        rewrite Eb. nra. }
      assert (0 <= ((4 * n - 3) * - b - (n - 1) ^ 2) * v ^ 2) by (apply pos2; lra).
      assert (0 <= (1 - (n - 1) * v) ^ 2) by apply pow2_ge_0. lra.
  - assert (N2 : n <= 2).
    { destruct (Rle_dec n 2); [assumption |]. assert (0 < b * (2 * n + 1)) by (apply Rmult_lt_0_compat; lra). nra. }
    assert (B1 : (4 * n - 3) * b <= 1).
    { apply Rmult_le_reg_r with (2 * n + 1); [lra |]. rewrite Rmult_assoc, Eb. nra. }
    assert ((4 * n - 3) * b * v ^ 2 <= 1 * v ^ 2) by (apply Rmult_le_compat_r; lra).
    assert (v <= 1 / 2) by nra. assert (v ^ 2 <= v / 2) by nra.
    assert (2 * (n - 1) * v <= n * v) by (apply Rmult_le_compat_r; lra). nra.
Qed.

Lemma Y_within : forall p, first <= p <= last -> 0 <= Y p /\ Y p * (n + 1) <= 1.
Proof.
  intros p Hp. destruct (Hpower p Hp) as [P0 P1].
  assert (E : Y p * (n + 1) = p * (c0 + c1 * p)) by (unfold Y, cubic; field; lra).
  assert (0 <= p * (c0 + c1 * p)) by (apply pos2; lra).
  split; [apply Rmult_le_reg_r with (n + 1); lra |].
  rewrite E. assert (p * (c0 + c1 * p) <= p * 1) by (apply le2; lra). lra.
Qed.

Theorem from_zero_rises_no_faster_than_its_path : slopes from_zero 0 1 first last.
Proof.
  set (Y' := cubic' (c0 / (n + 1)) (c1 / (n + 1)) 0).
  set (den := fun p => 1 + Y p * (1 + b * Y p)).
  apply slopes_of_derivative with
    (f' := fun p => (1 * den p - (Y' p * (1 + 2 * b * Y p)) * p) / (den p) ^ 2).
  - intros p Hp. destruct (Y_within p Hp) as [Y0 Y1].
    destruct (between_zero_and_its_end _ Y0 Y1) as (L & D0 & _).
    assert (Dy : derivable_pt_lim Y p (Y' p)) by apply cubic_derives.
    assert (Dd : derivable_pt_lim den p (Y' p * (1 + 2 * b * Y p))).
    { assert (Q := derivable_pt_lim_comp Y (cubic 1 1 b 0) p _ _ Dy (cubic_derives 1 1 b 0 (Y p))).
      replace (Y' p * (1 + 2 * b * Y p)) with (cubic' 1 b 0 (Y p) * Y' p) by (unfold cubic'; ring).
      intros eps He. destruct (Q eps He) as [d Hd]. exists d. intros k Hk Hkd. specialize (Hd k Hk Hkd).
      unfold den. unfold comp, cubic in Hd.
      replace (1 + Y (p + k) * (1 + b * Y (p + k))) with (1 + Y (p + k) * (1 + Y (p + k) * (b + Y (p + k) * 0))) by ring.
      replace (1 + Y p * (1 + b * Y p)) with (1 + Y p * (1 + Y p * (b + Y p * 0))) by ring. exact Hd. }
    exact (quotient_derives id den p 1 _ ltac:(unfold den; lra) (derivable_pt_lim_id p) Dd).
  - intros p Hp. destruct (Y_within p Hp) as [Y0 Y1].
    destruct (between_zero_and_its_end _ Y0 Y1) as (L & D0 & K).
    assert (Dp : 1 <= den p) by (unfold den; lra).
    assert (P2 : 0 < den p ^ 2) by (apply pow_lt; lra).
    assert (E : Y' p * p * (n + 1) = Y p * (n + 1) + p * (p * c1)).
    { unfold Y', Y, cubic', cubic. field. lra. }
    assert (EY : Y p * (n + 1) = p * (c0 + c1 * p)) by (unfold Y, cubic; field; lra).
    assert (S1 : p * (p * c1) <= p * (2 * (n - 1) * (c0 + c1 * p))) by (apply le2; [lra | apply Hsteep; assumption]).
    replace (p * (2 * (n - 1) * (c0 + c1 * p))) with (2 * (n - 1) * (Y p * (n + 1))) in S1 by (rewrite EY; ring).
    assert (YS : Y' p * p <= (2 * n - 1) * Y p) by (apply Rmult_le_reg_r with (n + 1); lra).
    assert (Y0' : 0 <= Y' p * p).
    { apply Rmult_le_reg_r with (n + 1); [lra |]. rewrite E.
      assert (0 <= p * (p * c1)) by (apply pos2; [| apply pos2]; lra).
      assert (0 <= Y p * (n + 1)) by (apply pos2; lra). lra. }
    assert (M := Rmult_le_compat_r _ _ _ L YS). assert (M0 := pos2 _ _ Y0' L).
    assert (dd : den p = 1 + Y p * (1 + b * Y p)) by reflexivity.
    split.
    + apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra].
    + apply Rmult_le_reg_r with (den p ^ 2); [assumption |].
      unfold Rdiv. rewrite Rmult_assoc, Rinv_l; [nra | lra].
Qed.
End From_zero.

(* Beyond p = 1 the step goes on as a loading part, with n*w for f, from where p = 1 led: so
   loading_rises_no_faster_than_f has it, as n*w is at most one. *)
Theorem beyond_one_it_is_a_loading_part : forall n, 1 <= n ->
  let b := (1 + n - n ^ 2) / (2 * n + 1) in
  let y := 1 / (n + 1) in
  let w := 1 - 1 / (1 + y * (1 + y * b)) in
  0 < w /\ n * w <= 1.
Proof.
  intros n Hn b y w.
  set (q := y * (1 + y * b)).
  assert (Eb : b * (2 * n + 1) = 1 + n - n ^ 2) by (unfold b; field; lra).
  assert (Eq : q * (n + 1) ^ 2 = n + 1 + b) by (unfold q, y; field; lra).
  assert (B1 : b <= 1 / 3) by (apply Rmult_le_reg_r with (2 * n + 1); [lra | nra]).
  assert (B0 : 0 < n + 1 + b) by (apply Rmult_lt_reg_r with (2 * n + 1); [lra | nra]).
  assert (P : 0 < (n + 1) ^ 2) by (apply pow_lt; lra).
  assert (Q0 : 0 < q) by (apply Rmult_lt_reg_r with ((n + 1) ^ 2); lra).
  assert (Q1 : (n - 1) * q <= 1).
  { apply Rmult_le_reg_r with ((n + 1) ^ 2); [assumption |]. rewrite Rmult_assoc, Eq. nra. }
  assert (I : 0 < / (1 + q)) by (apply Rinv_0_lt_compat; lra).
  assert (E : w = q * / (1 + q)) by (unfold w; fold q; field; lra).
  rewrite E. split; [apply Rmult_lt_0_compat; assumption |].
  apply Rmult_le_reg_r with (1 + q); [lra |].
  replace (n * (q * / (1 + q)) * (1 + q)) with (n * q) by (field; lra). lra.
Qed.
