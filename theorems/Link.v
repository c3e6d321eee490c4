(* With the drives that (24)-(26) give the estimates, what s loses is what they gain (28): the
   hypothesis of theorem_1_in_sampled_time, for the lag form on the static plant. *)
Require Import Reals Lra List.
Require Import Box Decrease.
Open Scope R_scope.

(* Regressors as the estimates have them: the drive of theta_i is -lambda*s*x_i. *)
Record reg := { est : estimate; x : R }.

Fixpoint hats (l : list reg) : R := match l with nil => 0 | e :: t => val (est e) * x e + hats t end.
Fixpoint truths (l : list reg) : R := match l with nil => 0 | e :: t => truth (est e) * x e + truths t end.

Section Link.
Variables (h lambda k alpha s z rho D xi sT : R) (beta delta : estimate) (regs : list reg).
Hypotheses (Hl : 0 < lambda) (Ha : 0 < alpha).
(* rho is r + (r+ - r)/(h*lambda); adapt() in step.rs. *)
Let ubar := - k * s + rho - z / lambda + hats regs - val delta * sT.
Hypotheses (Hbeta : truth beta = / alpha /\ c beta = alpha /\ drive beta = - lambda * s * ubar)
  (Hdelta : c delta = 1 /\ drive delta = lambda * s * sT)
  (Hregs : Forall (fun e => c (est e) = 1 /\ drive (est e) = - lambda * s * x e) regs).

Let g := alpha * val beta.
Let w := (g - 1) * rho + (g * hats regs - truths regs) - D.
Let s' := s_next h lambda k g (val delta) sT w xi s s z.

Lemma cross_of_regressors : forall l,
  Forall (fun e => c (est e) = 1 /\ drive (est e) = - lambda * s * x e) l ->
  total (fun e => - c e * drive e * (truth e - val e)) (map est l) = lambda * s * (truths l - hats l).
Proof.
  induction l as [| e l IH]; intro H; cbn [map total truths hats]; [ring |].
  inversion H as [| ? ? [C Dr] T]; subst. rewrite (IH T), C, Dr. ring.
Qed.

Theorem what_s_loses_the_estimates_gain :
  s * (s' - s) = h * lambda * (- k * s ^ 2 - s * z / lambda - s * D - truth delta * (s * sT))
                 - h * cross (beta :: delta :: map est regs) - s * xi.
Proof.
  unfold cross. cbn [total]. rewrite (cross_of_regressors regs Hregs).
  destruct Hbeta as (B1 & B2 & B3). destruct Hdelta as (D1 & D2).
  rewrite B1, B2, B3, D1, D2. unfold s', s_next, w, g, ubar. field. lra.
Qed.
End Link.
