(* Theorem 1 in sampled time, per step, and the RMS certificate that follows from it.

   V = s^2/2 + z^2/2 + sum c*(1 + h*sigma)*(p* - p)^2/(2*m) over the estimates, as in
   bound::PerStep. Estimates adapt: p+ = clamp((p + h*(m*v + sigma*p0))/(1 + h*sigma)). *)
Require Import Reals Lra Psatz List.
Require Import Box.
Open Scope R_scope.

Definition clampR (lo hi p : R) : R := Rmax lo (Rmin hi p).

(* K6: a projection moves towards any truth that the box holds. *)
Lemma projection_moves_towards_the_truth : forall lo hi p truth,
  lo <= truth <= hi -> (clampR lo hi p - truth) ^ 2 <= (p - truth) ^ 2.
Proof.
  intros lo hi p truth H. unfold clampR, Rmax, Rmin.
  destruct (Rle_dec hi p); destruct (Rle_dec lo _); nra.
Qed.

(* One estimate. *)
Record estimate := {
  val : R; truth : R; low : R; high : R;     (* p, p*, box *)
  m : R; sigma : R; prior : R;                (* gain, leakage, prior *)
  c : R; drive : R                            (* weight in V, and what drives it: v *)
}.

Definition ok (e : estimate) : Prop :=
  low e <= truth e <= high e /\ 0 < m e /\ 0 <= sigma e /\ 0 <= c e.

(* Estimator::update in exact arithmetic. *)
Definition moved (h : R) (e : estimate) : R :=
  clampR (low e) (high e)
    ((val e + h * (m e * drive e + sigma e * prior e)) / (1 + h * sigma e)).

(* Its share of V. *)
Definition share_of (h : R) (e : estimate) (p : R) : R :=
  c e * (1 + h * sigma e) * (truth e - p) ^ 2 / (2 * m e).

(* What it takes and gives in a step: the drive, the leakage's residue, the second order. *)
Definition gives (h : R) (e : estimate) : R :=
  c e * (- h * drive e * (truth e - val e)
         + h * sigma e * (truth e - prior e) ^ 2 / (2 * m e)
         + h * h * m e * drive e ^ 2 / 2).

Lemma implicit_leakage : forall h e, 0 < h -> ok e ->
  share_of h e (moved h e) <= share_of h e (val e) * (1 - h * (sigma e / (1 + h * sigma e))) + gives h e.
Proof.
  intros h e Hh (Hbox & Hm & Hs & Hc).
  set (a := 1 + h * sigma e). assert (Ha : 0 < a) by (unfold a; nra).
  set (d := truth e - val e). set (v := drive e). set (l := truth e - prior e).
  set (raw := (val e + h * (m e * v + sigma e * prior e)) / a).
  assert (P : (truth e - moved h e) ^ 2 <= (truth e - raw) ^ 2).
  { assert (Q := projection_moves_towards_the_truth (low e) (high e) raw (truth e) Hbox).
    unfold moved. fold a v raw. nra. }
  (* The step without the box, and the convexity of the square. *)
  assert (Eraw : a * (truth e - raw) = (d - h * m e * v) + h * sigma e * l).
  { unfold raw, d, l, a. field. unfold a in Ha. lra. }
  assert (J : a * (truth e - raw) ^ 2 <= (d - h * m e * v) ^ 2 + h * sigma e * l ^ 2).
  { set (A := d - h * m e * v) in *. set (y := truth e - raw) in *.
    assert (Hhs : 0 <= h * sigma e) by nra.
    (* a*(A^2 + hs*l^2) - (A + hs*l)^2 = hs*(A - l)^2 *)
    assert (K : a * (a * y ^ 2) <= a * (A ^ 2 + h * sigma e * l ^ 2)).
    { replace (a * (a * y ^ 2)) with ((a * y) ^ 2) by ring. rewrite Eraw.
      assert (I : a * (A ^ 2 + h * sigma e * l ^ 2) - (A + h * sigma e * l) ^ 2
                  = h * sigma e * (A - l) ^ 2) by (unfold a; ring).
      assert (0 <= h * sigma e * (A - l) ^ 2) by (apply pos2; [assumption | apply pow2_ge_0]).
      lra. }
    apply Rmult_le_reg_l with a; lra. }
  unfold share_of, gives. fold a d v l.
  assert (Hq : 0 <= c e / (2 * m e)) by (apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]).
  assert (L : c e * a * (truth e - moved h e) ^ 2 / (2 * m e)
              <= c e / (2 * m e) * ((d - h * m e * v) ^ 2 + h * sigma e * l ^ 2)).
  { replace (c e * a * (truth e - moved h e) ^ 2 / (2 * m e))
      with (c e / (2 * m e) * (a * (truth e - moved h e) ^ 2)) by (field; lra).
    apply le2; [assumption |]. assert (X := le2 a _ _ (Rlt_le _ _ Ha) P). lra. }
  apply Rle_trans with (1 := L). right. unfold a. field. unfold a in Ha. lra.
Qed.

(* A sum over any number of estimates. *)
Fixpoint total (f : estimate -> R) (l : list estimate) : R :=
  match l with nil => 0 | e :: l' => f e + total f l' end.

Section Step.
Variables (h lambda k eps WT Sbox Xi rate : R) (ests : list estimate).
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Hk : 0 < k) (Hok : Forall ok ests).
(* rate <= min(2*lambda, k*lambda, sigma/(1 + h*sigma)). *)
Hypotheses (Hr0 : 0 <= rate) (Hr1 : rate <= k * lambda) (Hr2 : rate <= 2 * lambda)
  (Hrs : Forall (fun e => rate <= sigma e / (1 + h * sigma e)) ests).

Definition V (s z : R) (p : estimate -> R) : R :=
  s ^ 2 / 2 + z ^ 2 / 2 + total (fun e => share_of h e (p e)) ests.

(* What the estimates take from s: alpha*beta~*ubar + theta~*x - delta~*T, each a drive. *)
Definition cross : R := total (fun e => - c e * drive e * (truth e - val e)) ests.
Definition residue : R :=
  total (fun e => c e * sigma e * (truth e - prior e) ^ 2 / (2 * m e)) ests.
Definition second : R := total (fun e => c e * m e * drive e ^ 2) ests.

Lemma sum_of_shares : forall l, Forall ok l ->
  Forall (fun e => rate <= sigma e / (1 + h * sigma e)) l ->
  total (fun e => share_of h e (moved h e)) l
  <= (1 - h * rate) * total (fun e => share_of h e (val e)) l
     + h * total (fun e => - c e * drive e * (truth e - val e)) l
     + h * total (fun e => c e * sigma e * (truth e - prior e) ^ 2 / (2 * m e)) l
     + h * h / 2 * total (fun e => c e * m e * drive e ^ 2) l.
Proof.
  induction l as [| e l IH]; intros Ho Hr; cbn [total]; [lra |].
  inversion Ho as [| ? ? Oe Ol]; subst. inversion Hr as [| ? ? Re Rl]; subst.
  specialize (IH Ol Rl).
  assert (L := implicit_leakage h e Hh Oe). destruct Oe as (_ & Hm & Hs & Hc).
  assert (P0 : 0 <= share_of h e (val e)).
  { unfold share_of. apply Rmult_le_pos; [| left; apply Rinv_0_lt_compat; lra].
    apply pos2; [| apply pow2_ge_0]. apply pos2; [lra |].
    assert (X := pos2 h (sigma e) (Rlt_le _ _ Hh) Hs). lra. }
  assert (P1 : share_of h e (val e) * (1 - h * (sigma e / (1 + h * sigma e)))
               <= share_of h e (val e) * (1 - h * rate)).
  { apply le2; [assumption |]. assert (X := le2 h _ _ (Rlt_le _ _ Hh) Re). lra. }
  assert (G : gives h e = h * (- c e * drive e * (truth e - val e))
     + h * (c e * sigma e * (truth e - prior e) ^ 2 / (2 * m e))
     + h * h / 2 * (c e * m e * drive e ^ 2)) by (unfold gives; field; lra).
  rewrite G in L. lra.
Qed.

(* (27)-(34) in sampled time, with s*(s' - s) as the algebra gives it: Loop.v has the recursion,
   Link below the cancelling. [sT] is T(s/eps), [target] what delta_hat is measured against. *)
(* What the rate leaves of k*lambda*s^2/2 is kept: with rate = 0 it is what the RMS needs. *)
Theorem theorem_1_with_what_is_left : forall s z s' z' D Delta target sT xi R2,
  s * (s' - s) = h * lambda * (- k * s ^ 2 - s * z / lambda - s * D - target * (s * sT))
                 - h * cross - s * xi ->
  z' - z = h * (s - lambda * z) ->
  - Delta <= D <= Delta -> - (h * Xi) <= xi <= h * Xi -> 0 <= Xi ->
  0 <= target <= Delta ->
  Rabs s - s * sT <= WT * eps -> Rabs s <= Sbox ->
  (s' - s) ^ 2 + (z' - z) ^ 2 <= h * h * R2 ->
  V s' z' (moved h) <=
    (1 - h * rate) * V s z val
    + h * (residue + WT * eps * lambda * target + lambda * Sbox * (Delta - target)
           + Xi ^ 2 / (2 * k * lambda) + h / 2 * (R2 + second))
    - h * ((k * lambda - rate) / 2 * s ^ 2).
Proof.
  intros s z s' z' D Delta target sT xi R2 Es Ez HD Hxi HXi Ht HT HS HR.
  assert (Sum := sum_of_shares ests Hok Hrs). fold cross residue second in Sum.
  unfold V.
  set (P := total (fun e => share_of h e (val e)) ests) in *.
  set (P' := total (fun e => share_of h e (moved h e)) ests) in *.
  assert (Ez2 : z * (z' - z) = h * (s * z - lambda * z ^ 2)) by (rewrite Ez; ring).
  assert (Sq : s' ^ 2 / 2 + z' ^ 2 / 2 = s ^ 2 / 2 + z ^ 2 / 2 + s * (s' - s) + z * (z' - z)
     + ((s' - s) ^ 2 + (z' - z) ^ 2) / 2) by field.
  (* - s*D <= |s|*Delta, and |s|*Delta - target*s*T <= (Delta - target)*S + target*WT*eps *)
  assert (A0 : 0 <= Rabs s) by apply Rabs_pos.
  assert (A1 : - s <= Rabs s /\ s <= Rabs s) by (unfold Rabs; destruct (Rcase_abs s); lra).
  assert (B1 : - (s * D) <= Rabs s * Delta).
  { assert (Q := times (Rabs s) D Delta A0 HD). unfold Rabs in *; destruct (Rcase_abs s); lra. }
  assert (B2 : target * (Rabs s - s * sT) <= target * (WT * eps)) by (apply le2; lra).
  assert (B3 : (Delta - target) * Rabs s <= (Delta - target) * Sbox) by (apply le2; lra).
  (* - s*xi <= h*|s|*Xi <= h*(k*lambda*s^2/2 + Xi^2/(2*k*lambda)) *)
  assert (B4 : - (s * xi) <= h * (Rabs s * Xi)).
  { assert (Q := times (Rabs s) xi (h * Xi) A0 Hxi). unfold Rabs in *; destruct (Rcase_abs s); lra. }
  assert (Hkl : 0 < k * lambda) by (apply Rmult_lt_0_compat; assumption).
  assert (B5 : Rabs s * Xi <= k * lambda * s ^ 2 / 2 + Xi ^ 2 / (2 * k * lambda)).
  { assert (Sq2 : Rabs s ^ 2 = s ^ 2) by (unfold Rabs; destruct (Rcase_abs s); ring).
    rewrite <- Sq2. set (a := Rabs s) in *.
    assert (Y : 0 <= (k * lambda * a - Xi) ^ 2 / (2 * (k * lambda))).
    { apply Rmult_le_pos; [apply pow2_ge_0 | left; apply Rinv_0_lt_compat; lra]. }
    replace ((k * lambda * a - Xi) ^ 2 / (2 * (k * lambda))) with
      (k * lambda * a ^ 2 / 2 - a * Xi + Xi ^ 2 / (2 * k * lambda)) in Y by (field; lra).
    lra. }
  assert (B6 := le2 h _ _ (Rlt_le _ _ Hh) B5).
  (* The rate is paid by what is left. *)
  assert (s2 : 0 <= s ^ 2) by apply pow2_ge_0. assert (z2 : 0 <= z ^ 2) by apply pow2_ge_0.
  assert (C2 : h * (rate * (z ^ 2 / 2)) <= h * (2 * lambda * (z ^ 2 / 2)))
    by (apply le2; [lra | apply Rmult_le_compat_r; lra]).
  assert (D1 : h * lambda * (- (s * D)) <= h * lambda * (Rabs s * Delta))
    by (apply le2; [apply pos2; lra | lra]).
  assert (D2 : h * lambda * (target * (Rabs s - s * sT)) <= h * lambda * (target * (WT * eps)))
    by (apply le2; [apply pos2; lra | lra]).
  assert (D3 : h * lambda * ((Delta - target) * Rabs s) <= h * lambda * ((Delta - target) * Sbox))
    by (apply le2; [apply pos2; lra | lra]).
  assert (F : h * lambda * (s * z / lambda) = h * (s * z)) by (field; lra).
  rewrite Sq, Es, Ez2. lra.
Qed.

Corollary theorem_1_in_sampled_time : forall s z s' z' D Delta target sT xi R2,
  s * (s' - s) = h * lambda * (- k * s ^ 2 - s * z / lambda - s * D - target * (s * sT))
                 - h * cross - s * xi ->
  z' - z = h * (s - lambda * z) ->
  - Delta <= D <= Delta -> - (h * Xi) <= xi <= h * Xi -> 0 <= Xi ->
  0 <= target <= Delta ->
  Rabs s - s * sT <= WT * eps -> Rabs s <= Sbox ->
  (s' - s) ^ 2 + (z' - z) ^ 2 <= h * h * R2 ->
  V s' z' (moved h) <=
    (1 - h * rate) * V s z val
    + h * (residue + WT * eps * lambda * target + lambda * Sbox * (Delta - target)
           + Xi ^ 2 / (2 * k * lambda) + h / 2 * (R2 + second)).
Proof.
  intros s z s' z' D Delta target sT xi R2 H1 H2 H3 H4 H5 H6 H7 H8 H9.
  assert (A := theorem_1_with_what_is_left s z s' z' D Delta target sT xi R2 H1 H2 H3 H4 H5 H6 H7 H8 H9).
  assert (s2 : 0 <= s ^ 2) by apply pow2_ge_0.
  assert (B : 0 <= (k * lambda - rate) / 2 * s ^ 2) by (apply pos2; lra).
  assert (C := pos2 h _ (Rlt_le _ _ Hh) B). lra.
Qed.
End Step.

(* What V's decrease says after many steps. *)
Section Long.
Variables (v : nat -> R) (h rate phi : R).
Hypotheses (Hh : 0 < h) (Hr : 0 < rate) (Hhr : h * rate <= 1)
  (Hv : forall n, v (S n) <= (1 - h * rate) * v n + h * phi).

(* UUB: geometrically into phi/rate. *)
Theorem v_comes_in : forall n, v n - phi / rate <= (1 - h * rate) ^ n * (v 0%nat - phi / rate).
Proof.
  induction n as [| n IH]; [simpl; lra |].
  specialize (Hv n). set (f := phi / rate) in *.
  assert (E : h * phi = h * rate * f) by (unfold f; field; lra).
  assert (A := le2 (1 - h * rate) _ _ ltac:(lra) IH). simpl. lra.
Qed.
End Long.

(* The RMS certificate, sampled. *)
Fixpoint sum_to (f : nat -> R) (n : nat) : R :=
  match n with O => 0 | S m => sum_to f m + f m end.

Section Rms.
Variables (v s e z : nat -> R) (h lambda kappa phi : R).
Hypotheses (Hh : 0 < h) (Hl : 0 < lambda) (Hk : 0 < kappa) (Hv0 : forall n, 0 <= v n)
  (Hv : forall n, v (S n) <= v n - h * kappa * s n ^ 2 + h * phi).

Theorem mean_square_of_s : forall n, h * kappa * sum_to (fun i => s i ^ 2) n <= v 0%nat + INR n * (h * phi).
Proof.
  intro n.
  assert (T : v n + h * kappa * sum_to (fun i => s i ^ 2) n <= v 0%nat + INR n * (h * phi)).
  { induction n as [| n IH]; [cbn [sum_to INR]; lra |].
    rewrite S_INR. cbn [sum_to]. specialize (Hv n). lra. }
  specialize (Hv0 n). lra.
Qed.

(* rms(e) <= rms(s)/sqrt(1 - h*lambda): the discrete form of "s = e + lambda*z gives
   int s^2 >= int e^2 where z starts at zero". *)
Hypotheses (Hs : forall n, s n = e n + lambda * z n) (Hz : forall n, z (S n) = z n + h * e n)
  (Hz0 : z 0%nat = 0).

Theorem e_is_no_larger_than_s : forall n,
  (1 - h * lambda) * sum_to (fun i => e i ^ 2) n <= sum_to (fun i => s i ^ 2) n.
Proof.
  intro n.
  assert (T : (1 - h * lambda) * sum_to (fun i => e i ^ 2) n + lambda / h * z n ^ 2
              <= sum_to (fun i => s i ^ 2) n).
  { induction n as [| n IH]; [cbn [sum_to]; rewrite Hz0; lra |].
    cbn [sum_to]. rewrite (Hs n), (Hz n).
    assert (0 <= (lambda * z n) ^ 2) by apply pow2_ge_0.
    assert (E : lambda / h * (z n + h * e n) ^ 2
      = lambda / h * z n ^ 2 + 2 * lambda * (e n * z n) + h * lambda * e n ^ 2) by (field; lra).
    rewrite E. lra. }
  assert (0 <= lambda / h * z n ^ 2).
  { apply pos2; [| apply pow2_ge_0]. apply Rmult_le_pos; [lra | left; apply Rinv_0_lt_compat; lra]. }
  lra.
Qed.

Theorem rms_certificate_sampled : forall n,
  h * kappa * ((1 - h * lambda) * sum_to (fun i => e i ^ 2) n) <= v 0%nat + INR n * (h * phi).
Proof.
  intro n. assert (A := mean_square_of_s n). assert (B := e_is_no_larger_than_s n).
  assert (0 < h * kappa) by (apply Rmult_lt_0_compat; assumption).
  assert (C := le2 (h * kappa) _ _ ltac:(lra) B). lra.
Qed.
End Rms.
