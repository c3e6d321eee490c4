//! K3 of the step that splits its path: the hysteresis stays within ±1 and never runs backward, whatever the power function.
//!
//! A path is followed in parts. Each part is proved for any state and any path above zero, so
//! that every pass of the loop over the parts keeps the state in its interval. Then follow
//! the last pass of each loop with what comes after it, the two branches joined, the closed
//! forms, and the step itself, each with stubs that return any value that the rows before it
//! allow. Exponential, logarithm and square root of the parts return any float at all.

use super::number::Number;
use super::path::{follow, leave_zero, load, load_part, unload, unload_part, NEAR_ZERO};
use super::{closed, BoucWen};
use crate::proofs::any::{finite, within};
use crate::proofs::stubs;
use crate::Real;

/// Any path that is not used up, infinite included.
fn path() -> f32 {
    kani::any_where(|p: &f32| *p > 0.0)
}

/// K3. A part of a loading path ends between its start and 1; the last part uses up the path.
///
/// Assumes: zeta ∈ (0, 1], n ∈ [1, 1e9], any path above zero.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
#[kani::stub(libm::sqrtf, stubs::garbage)]
fn loading_part() {
    let (zeta, p, n, last) = (within(0.0, 1.0), path(), within(1.0, 1e9), kani::any());
    kani::assume(zeta > 0.0);
    let (next, left) = load_part(zeta, p, last, n);
    kani::cover!(next > zeta && next < 1.0 && left > 0.0);
    assert!(zeta <= next && next <= 1.0);
    assert!(!last || !(left > 0.0));
}

/// K3. A part of an unloading path ends between its start and 0; the last part reaches 0 or
/// uses up the path.
///
/// Assumes: zeta ∈ [-1, -1e-9), c ∈ [0, 2e9], n ∈ [1, 1e9], any path above zero.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
#[kani::stub(libm::sqrtf, stubs::garbage)]
fn unloading_part() {
    let (zeta, p, n, last) = (within(-1.0, -1e-9), path(), within(1.0, 1e9), kani::any());
    let c = within(0.0, 2e9);
    let (next, left) = unload_part(zeta, p, last, c, n);
    kani::cover!(next > zeta && next < 0.0 && left > 0.0);
    assert!(zeta <= next && next <= 0.0);
    assert!(!last || next == 0.0 || !(left > 0.0));
}

/// K3. The part of a path that starts at zero ends within \[0, 1\].
///
/// Assumes: n ∈ [1, 1e9], any path above zero.
#[kani::proof]
#[kani::stub(libm::expf, stubs::garbage)]
#[kani::stub(libm::logf, stubs::garbage)]
fn part_from_zero() {
    let (p, n) = (path(), within(1.0, 1e9));
    let (next, left) = leave_zero(p, n);
    kani::cover!(next > 0.0 && left > 0.0);
    assert!((0.0..=1.0).contains(&next) && left >= 0.0);
}

/// Any number of the solver's that is not NaN, as the step computes with it.
fn any_number<N: Number>(admitted: impl Fn(N::Float) -> bool) -> N {
    let x: f32 = kani::any();
    let x = N::Float::from_f64(x.into());
    kani::assume(admitted(x));
    N::constant(x)
}

/// What `unloading_part` proves of a part, and no more; of the last pass of the loop, so that
/// the loop ends after it.
fn last_unloading_part<N: Number>(zeta: N, _: N, _: bool, _: N, _: N) -> (N, N) {
    let zero = N::Float::from_f64(0.0);
    let next: N = any_number(|next| zeta.value() <= next && next <= zero);
    let left: N = any_number(|_| true);
    let near = next.value() >= -N::Float::from_f64(NEAR_ZERO);
    kani::assume(near || !(left.value() > zero));
    (next, left)
}

/// What `loading_part` proves of a part, and no more; of the last pass of the loop.
fn last_loading_part<N: Number>(zeta: N, _: N, _: bool, _: N) -> (N, N) {
    let next: N = any_number(|next| zeta.value() <= next && next <= N::Float::from_f64(1.0));
    let left: N = any_number(|_| true);
    kani::assume(!(left.value() > N::Float::from_f64(0.0)));
    (next, left)
}

/// Whether the state has not moved backward. A start above zero but nearer to it than 1e-9
/// counts as zero, so that the general step may end at zero then; `advance` clamps that.
fn not_before<T: Real>(start: T, end: T) -> bool {
    start <= end || (start <= T::from_f64(NEAR_ZERO) && T::from_f64(0.0) <= end)
}

/// What `part_from_zero` proves, and no more.
fn any_part_from_zero<N: Number>(_: N, _: N) -> (N, N) {
    let zero = N::Float::from_f64(0.0);
    let next = any_number(|next| zero <= next && next <= N::Float::from_f64(1.0));
    (next, any_number(|left| left >= zero))
}

/// K3. The branch below zero, from the last pass of its loop to its end, ends between its start and
/// 0; it ends below 0 only if the path is used up.
///
/// Assumes: zeta ∈ [-1, 1], any path, the part as proved by unloading_part.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(unload_part, last_unloading_part)]
fn unloading_loop() {
    let (zeta, p) = (within(-1.0, 1.0), kani::any::<f32>());
    let (next, left) = unload(zeta, p, within(0.0, 2e9), within(1.0, 1e9));
    kani::cover!(zeta < -0.5 && next == 0.0 && left > 0.0);
    if zeta < 0.0 {
        assert!(zeta <= next && next <= 0.0);
        assert!(next == 0.0 || !(left > 0.0));
    } else {
        assert!(next == zeta && left.to_bits() == p.to_bits());
    }
}

/// K3. The branch above zero, from the last pass of its loop to its end, ends between its start (or
/// 0, if the start is less than 1e-9 above 0) and 1.
///
/// Assumes: zeta ∈ [0, 1], any path, the parts as proved by loading_part and part_from_zero.
#[kani::proof]
#[kani::unwind(3)]
#[kani::stub(load_part, last_loading_part)]
#[kani::stub(leave_zero, any_part_from_zero)]
fn loading_loop() {
    let (zeta, p) = (within(0.0, 1.0), kani::any());
    let next = load(zeta, p, within(1.0, 1e9));
    kani::cover!(zeta == 0.0 && next > 0.9);
    kani::cover!(zeta > 0.5 && next == 1.0);
    assert!(not_before(zeta, next) && next <= 1.0);
}

/// What `unloading_loop` proves of the branch below zero, and no more.
fn any_unloading<N: Number>(zeta: N, path: N, _: N, _: N) -> (N, N) {
    let zero = N::Float::from_f64(0.0);
    if zeta.value() >= zero {
        return (zeta, path);
    }
    let next: N = any_number(|next| zeta.value() <= next && next <= zero);
    let left: N = any_number(|_| true);
    kani::assume(next.value() >= zero || !(left.value() > zero));
    (next, left)
}

/// What `loading_loop` proves of the branch above zero, and no more; where nothing is left of
/// the path, `load` returns at once.
fn any_loading<N: Number>(zeta: N, path: N, _: N) -> N {
    if !(path.value() > N::Float::from_f64(0.0)) {
        return zeta;
    }
    any_number(|next| not_before(zeta.value(), next) && next <= N::Float::from_f64(1.0))
}

/// K3. The general step, with both branches joined, ends between its start (or 0, if the start is
/// less than 1e-9 above 0) and 1.
///
/// Assumes: zeta ∈ [-1, 1], any path, the branches as proved by unloading_loop and loading_loop.
#[kani::proof]
#[kani::stub(unload, any_unloading)]
#[kani::stub(load, any_loading)]
fn both_branches() {
    let (zeta, p) = (within(-1.0, 1.0), kani::any::<f32>());
    kani::assume(p >= 0.0);
    let next = follow(zeta, p, within(0.0, 2e9), within(1.0, 1e9));
    kani::cover!(zeta < -0.5 && next > 0.5 && next < 1.0);
    assert!(not_before(zeta, next) && next <= 1.0);
}

/// K3. The closed form for n = 1 gives a number, for any path.
///
/// Assumes: zeta ∈ [-1, 1], c ∈ [0, 2e9], any path.
#[kani::proof]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(libm::log1pf, stubs::log1pf)]
fn closed_form_of_n_1() {
    let (zeta, p, c) = (within(-1.0, 1.0), kani::any::<f32>(), within(0.0, 2e9));
    kani::assume(p >= 0.0);
    let next = closed::linear(zeta, p, c);
    kani::cover!(zeta < -0.5 && next > 0.5 && next < 1.0);
    assert!(!next.is_nan());
}

/// K3. The closed form for n = 2 gives a number, for any path.
///
/// Assumes: zeta ∈ [-1, 1], c = 0 or c ∈ [1e-7, 2e9] (c = 2·sigma - 1 is one of these), any
/// path.
#[kani::proof]
#[kani::stub(libm::sqrtf, stubs::sqrtf)]
#[kani::stub(libm::atanf, stubs::atanf)]
#[kani::stub(libm::tanf, stubs::tanf)]
#[kani::stub(libm::tanhf, stubs::tanhf)]
fn closed_form_of_n_2() {
    let (zeta, p, c) = (within(-1.0, 1.0), kani::any::<f32>(), within(0.0, 2e9));
    kani::assume(p >= 0.0 && (c == 0.0 || c >= 1e-7));
    let next = closed::quadratic(zeta, p, c);
    kani::cover!(zeta < -0.5 && next > 0.5 && next < 1.0);
    assert!(!next.is_nan());
}

/// What the rows of the closed forms prove, and no more.
fn any_closed_form<T: Real>(_: T, _: T, _: T) -> T {
    let next: f32 = kani::any();
    kani::assume(!next.is_nan());
    T::from_f64(next.into())
}

/// What `both_branches` proves of the general step, and no more.
fn any_step<N: Number>(zeta: N, _: N, _: N, _: N) -> N {
    any_number(|next| not_before(zeta.value(), next) && next <= N::Float::from_f64(1.0))
}

/// K3. The splitting step with any accepted shape: eta ends within ±1, and a finite change of the
/// input never moves it backwards.
///
/// Assumes: any eta but NaN (an eta beyond ±1 counts as ±1), any change; the general step as proved
/// by both_branches, the closed forms as proved by closed_form_of_n_1 and closed_form_of_n_2.
#[kani::proof]
#[kani::stub(follow, any_step)]
#[kani::stub(closed::linear, any_closed_form)]
#[kani::stub(closed::quadratic, any_closed_form)]
fn split_eta_stays_within_1() {
    let shape = BoucWen::<f32>::try_new(kani::any(), kani::any(), kani::any());
    kani::assume(shape.is_ok());
    if let Ok(shape) = shape {
        let (eta, change): (f32, f32) = (within(-1.0, 1.0), kani::any());
        let next = shape.advance_split(eta, change);
        kani::cover!(shape.n() == 2.0 && change < -1.0 && next < eta);
        kani::cover!(shape.n() > 2.0 && change > 1.0 && next > eta);
        let c = 2.0 * shape.sigma() - 1.0;
        assert!(c == 0.0 || (1e-7..=2e9).contains(&c));
        assert!(next.abs() <= 1.0);
        assert!(!(change > 0.0) || next >= eta);
        assert!(!(change < 0.0) || next <= eta);
        assert!(change.is_finite() || next == eta);
        let outside = finite();
        assert!(
            !change.is_finite()
                || change == 0.0
                || shape.advance_split(outside, change).abs() <= 1.0
        );
    }
}
