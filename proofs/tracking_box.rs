//! K2: the box of the tracking error, of the lag form's shipped recursion.
//!
//! The recursion is what lag form and static plant do to the errors, see [`LagRecursion`].
//! By the formula the box is `S = (W + Xi/lambda)/(g⁻·(k - 1/lambda²))`; the `S` below is a
//! little more, for the rounding of f32, and `|e| = |s - lambda·z| <= 2·S`.

use super::any::within;
use super::properties::tracking::errors_stay_within_theorem_1;
use super::properties::tracking::{errors_stay_in_their_box, in_box};
use super::stubs;
use bowden::control::{Disturbance, ErrorState, LagRecursion, SmoothSign};

/// Table 2 of the paper; every smooth sign at 1 kHz needs epsilon >= 0.048 for this.
fn paper(smooth_sign: SmoothSign) -> LagRecursion<f32> {
    LagRecursion {
        gain: 24.0,
        lambda: 8.0,
        epsilon: 0.05,
        smooth_sign,
    }
}

/// Ranges: the greatest delta_hat, |w| and |xi| \[N·m\]; g is any number of \[0.8, 1.2\].
fn any_disturbance(delta_hat: f32, w: f32, xi: f32) -> Disturbance<f32> {
    Disturbance {
        g: within(0.8, 1.2),
        delta_hat: if delta_hat > 0.0 {
            within(0.0, delta_hat)
        } else {
            0.0
        },
        w: within(-w, w),
        xi: if xi > 0.0 { within(-xi, xi) } else { 0.0 },
    }
}

/// One step of `dt` \[s\] from anywhere in the box `|s| <= most` \[N·m\].
fn a_step_keeps_the_box(law: &LagRecursion<f32>, dt: f32, by: &Disturbance<f32>, most: f32) {
    let reach = most / law.lambda;
    let at = ErrorState {
        s: within(-most, most),
        z: within(-reach, reach),
    };
    let corner = at.s > 0.95 * most && at.z < -0.95 * reach && by.w > 0.95 * 8.0;
    kani::cover!(corner && in_box(law, at, most));
    assert!(errors_stay_in_their_box(law, at, dt, by, most));
}

/// K2. Table 2 at 1 kHz: if |s| ≤ 0.43 N·m holds, it continues to hold; hence |e| ≤ 0.86 N·m.
///
/// Assumes: |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat = 0, a constant disturbance.
#[kani::proof]
fn tracking_box() {
    let by = any_disturbance(0.0, 8.0, 0.0);
    a_step_keeps_the_box(&paper(SmoothSign::Clamp), 0.001, &by, 0.43);
}

/// K2. The same with the clamped line as smooth sign, epsilon = 0.05 N·m.
///
/// Assumes: |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat ∈ [0, 4] N·m, a constant disturbance.
#[kani::proof]
fn tracking_box_clamp() {
    let by = any_disturbance(4.0, 8.0, 0.0);
    a_step_keeps_the_box(&paper(SmoothSign::Clamp), 0.001, &by, 0.43);
}

/// K2. The same with tanh as smooth sign, epsilon = 0.05 N·m.
///
/// Assumes: |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat ∈ [0, 4] N·m, a constant disturbance.
#[kani::proof]
#[kani::stub(libm::tanhf, stubs::tanhf)]
fn tracking_box_tanh() {
    let by = any_disturbance(4.0, 8.0, 0.0);
    a_step_keeps_the_box(&paper(SmoothSign::Tanh), 0.001, &by, 0.43);
}

/// K2. Table 2 at 1 kHz with a varying disturbance: |s| ≤ 0.48 N·m, |e| ≤ 0.96 N·m.
///
/// Assumes: |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat ∈ [0, 4] N·m, |xi| ≤ 0.008 N·m per sample (8
/// N·m/s).
#[kani::proof]
fn tracking_box_moving() {
    let by = any_disturbance(4.0, 8.0, 0.008);
    a_step_keeps_the_box(&paper(SmoothSign::Clamp), 0.001, &by, 0.48);
}

/// K2. k = 12, lambda = 4/s, epsilon = 0.2 N·m at 500 Hz: |s| ≤ 0.85 N·m, |e| ≤ 1.7 N·m.
///
/// Assumes: |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat ∈ [0, 7] N·m, a constant disturbance.
#[kani::proof]
fn tracking_box_second_set() {
    let law = LagRecursion {
        gain: 12.0,
        lambda: 4.0,
        epsilon: 0.2,
        smooth_sign: SmoothSign::Clamp,
    };
    a_step_keeps_the_box(&law, 0.002, &any_disturbance(7.0, 8.0, 0.0), 0.85);
}

/// K2. Theorem 1's bound holds over a step: if |s| ≤ delta and |z| ≤ delta hold, they continue to
/// hold, hence |e| ≤ (1 + lambda)·delta, for any delta that the theorem gives. (Table 2: 126.5
/// N·m.)
///
/// Assumes: Table 2 at 1 kHz, delta ∈ [0.5, 1000] N·m, |w| ≤ 8 N·m, g ∈ [0.8, 1.2], delta_hat ∈ [0,
/// 4] N·m, |xi| ≤ 0.008 N·m per sample.
#[kani::proof]
fn theorem_1_is_carried_over() {
    let (law, delta) = (paper(SmoothSign::Clamp), within(0.5, 1000.0));
    let at = ErrorState {
        s: within(-1000.0, 1000.0),
        z: within(-1000.0, 1000.0),
    };
    let by = any_disturbance(4.0, 8.0, 0.008);
    kani::cover!(at.s > 0.95 * delta && at.z < -0.95 * delta && delta < 1.0);
    assert!(errors_stay_within_theorem_1(&law, at, 0.001, &by, delta));
}
