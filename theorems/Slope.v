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
  set (most := x / (n + 1)).
  assert (Hm : most * (n + 1) = x) by (unfold most; field; lra).
  assert (Em : eta <= most).
  { apply Rmult_le_reg_r with (n + 1); lra. }
  set (Q := fun e => f ^ 2 * (f - n * x / 2) + f ^ 2 * (1 + e) - f * (1 + e) ^ 2 / 2 - 3 / 2 * (1 + e) ^ 4).
  change (0 <= Q eta).
  admit.
Admitted.
End Flat.
