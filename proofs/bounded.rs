//! K3 of the step in bounded time, which `f32` takes: within ±1 and never backward.
//!
//! The approach to 1, the path above zero, the path from zero, the path below zero, and what
//! joins them, each for any state and any path; the power is any float at all, NaN included,
//! and what a row before it has proved stands for the function that it proved it of.

use super::*;
use crate::hysteresis::BoucWen;
use crate::proofs::any::{finite, within};
use crate::proofs::stubs;

/// Any path, infinite included.
fn path() -> f32 {
    kani::any_where(|p: &f32| *p >= 0.0)
}

/// Any number of the solver's, as the step computes with it.
fn any_number<N: Number>(admitted: impl Fn(N::Float) -> bool) -> N {
    let x: f32 = kani::any();
    let x = N::Float::from_f64(x.into());
    kani::assume(admitted(x));
    N::constant(x)
}

/// A shape: of what is computed from its parameters any float at all, but for the state after
/// the path 1, of which `bounded_from_zero` proves that it lies within \[0, 1\].
fn any_shape() -> Constants<f32> {
    Constants {
        c: within(0.0, 2e9),
        n: within(1.0, 1e9),
        root: kani::any(),
        size: kani::any(),
        series: any_series(),
        after_1: within(0.0, 1.0),
    }
}

fn any_series() -> Series<f32> {
    Series {
        first: kani::any(),
        second: kani::any(),
    }
}

/// K3, bounded. The approach to 1 ends between its start and 1.
///
/// Assumes: zeta ∈ \[0, 1\], any r that is not below zero, any turn.
#[kani::proof]
fn bounded_approach() {
    let (zeta, r) = (within(0.0, 1.0), kani::any::<f32>());
    kani::assume(!(r < 0.0));
    let next = approach(zeta, 1.0 - zeta, r, kani::any());
    kani::cover!((zeta > 0.1) & (next > zeta) & (next < 1.0));
    assert!(zeta <= next && next <= 1.0);
}

/// What `bounded_approach` proves, and no more.
fn any_approach<N: Number>(zeta: N, _: N, r: N, _: N) -> N {
    assert!(!(r.value() < N::Float::from_f64(0.0)));
    any_number(|next| zeta.value() <= next && next <= N::Float::from_f64(1.0))
}

/// K3, bounded. A path above zero ends between its start and 1.
///
/// Assumes: zeta ∈ (0, 1], n ∈ [1, 1e9], any path, any power; the approach as proved by
/// bounded_approach.
#[kani::proof]
#[kani::stub(approach, any_approach)]
fn bounded_loading() {
    let (zeta, n) = (within(0.0, 1.0), within(1.0, 1e9));
    let next = load(zeta, path(), kani::any(), n);
    kani::cover!((next > zeta) & (next < 1.0));
    kani::cover!((zeta < 1.0) & (next == zeta));
    assert!(zeta <= next && next <= 1.0);
}

/// K3, bounded. A path from zero ends within \[0, 1\], including the path of length 1 from which
/// longer paths continue.
///
/// Assumes: n ∈ [1, 1e9], any path that is not below zero (NaN included), any power, any series;
/// the approach as proved by bounded_approach.
#[kani::proof]
#[kani::stub(approach, any_approach)]
#[kani::stub(crate::real::short::coarse_power, stubs::garbage_of_two)]
fn bounded_from_zero() {
    let p: f32 = kani::any();
    kani::assume(!(p < 0.0));
    let next = leave_zero(p, &any_shape());
    kani::cover!((p < 1.0) & (next > 0.0) & (next < p));
    kani::cover!((p > 1.0) & (next < 1.0));
    assert!((0.0..=1.0).contains(&next));
    assert!((0.0..=1.0).contains(&any_series().turned_round(1.0, 1.0)));
}

/// Any share of a path, NaN included.
fn any_share<N: Number>(_: N, _: N) -> N {
    any_number(|_| true)
}

/// The same where the shape is at hand.
fn any_steep_share<N: Number>(_: N, _: &Constants<N>) -> N {
    any_number(|_| true)
}

/// Any two of them.
fn any_shares<N: Number>(_: N, _: N) -> (N, N) {
    (any_number(|_| true), any_number(|_| true))
}

/// K3, bounded. A path below zero ends between its start and zero, and the rest of the path at zero
/// is not negative.
///
/// Assumes: zeta ∈ [-1, 0], c ∈ [0, 2e9], n ∈ [1, 1e9], any path, any power, any length of the path
/// to zero.
#[kani::proof]
#[kani::stub(steep_share, any_steep_share)]
#[kani::stub(flat_share, any_shares)]
#[kani::stub(inverse_power, any_share)]
fn bounded_unloading() {
    let a = within(0.0, 1.0);
    match unload(a, path(), kani::any(), &any_shape()) {
        Ok(forward) => {
            kani::cover!((forward > 0.0) & (forward < a));
            assert!(-a <= forward - a && forward - a <= 0.0);
        }
        Err(left) => {
            kani::cover!(left > 0.0);
            assert!(!(left < 0.0));
        }
    }
}

/// What `bounded_loading` proves, and no more.
fn any_load<N: Number>(zeta: N, _: N, _: N, _: N) -> N {
    any_number(|next| zeta.value() <= next && next <= N::Float::from_f64(1.0))
}

/// What `bounded_unloading` proves, and no more.
fn any_unload<N: Number>(a: N, _: N, _: N, _: &Constants<N>) -> Result<N, N> {
    let zero = N::Float::from_f64(0.0);
    if kani::any() {
        Ok(any_number(|forward| {
            zero <= forward && forward <= a.value()
        }))
    } else {
        Err(any_number(|left| !(left < zero)))
    }
}

/// What `bounded_from_zero` proves, and no more.
fn any_from_zero<N: Number>(p: N, _: &Constants<N>) -> N {
    let (zero, one) = (N::Float::from_f64(0.0), N::Float::from_f64(1.0));
    assert!(!(p.value() < zero));
    any_number(|next| zero <= next && next <= one)
}

/// K3, bounded. The whole step, with its parts joined, ends between its start and 1.
///
/// Assumes: zeta ∈ [-1, 1], any path, any power; the parts as proved by bounded_loading,
/// bounded_unloading and bounded_from_zero.
#[kani::proof]
#[kani::stub(load, any_load)]
#[kani::stub(unload, any_unload)]
#[kani::stub(leave_zero, any_from_zero)]
#[kani::stub(crate::real::short::log2, stubs::garbage)]
#[kani::stub(crate::real::short::exp2, stubs::garbage)]
fn bounded_joined() {
    let zeta = within(-1.0, 1.0);
    let next = follow(zeta, path(), &any_shape());
    kani::cover!((zeta < -0.5) & (next > 0.5) & (next < 1.0));
    kani::cover!((zeta < -0.5) & (next < 0.0) & (next > zeta));
    assert!(zeta <= next && next <= 1.0);
}

/// What `bounded_joined` proves, and no more.
fn any_step<N: Number>(zeta: N, _: N, _: &Constants<N>) -> N {
    any_number(|next| zeta.value() <= next && next <= N::Float::from_f64(1.0))
}

/// K3. The `f32` step with any accepted shape: eta ends within ±1, and a finite change of the input
/// never moves it backwards.
///
/// Assumes: any eta but NaN (an eta beyond ±1 counts as ±1), any change; the step as proved by
/// bounded_joined.
#[kani::proof]
#[kani::stub(follow, any_step)]
fn eta_stays_within_1() {
    let shape = BoucWen::<f32>::try_new(kani::any(), kani::any(), kani::any());
    kani::assume(shape.is_ok());
    if let Ok(shape) = shape {
        let (eta, change): (f32, f32) = (within(-1.0, 1.0), kani::any());
        let next = shape.advance(eta, change);
        kani::cover!((shape.n() == 2.0) & (change < -1.0) & (next < eta));
        kani::cover!((shape.n() > 2.0) & (change > 1.0) & (next > eta));
        assert!(next.abs() <= 1.0);
        assert!(!(change > 0.0) || next >= eta);
        assert!(!(change < 0.0) || next <= eta);
        assert!(change.is_finite() || next == eta);
        let outside = finite();
        assert!(shape.advance(outside, change).abs() <= 1.0 || !change.is_finite());
    }
}

/// The same where the power is known.
fn any_step_powered<N: Number>(zeta: N, p: N, _: N, shape: &Constants<N>) -> N {
    any_step(zeta, p, shape)
}

/// K3. The paths that the inverse tries in `f32`, with any accepted shape: eta ends within ±1 and
/// never moves against the direction of the search.
///
/// Assumes: eta ∈ \[-1, 1\], any direction, any finite change; the step as proved by
/// bounded_joined, any power.
#[kani::proof]
#[kani::stub(follow_powered, any_step_powered)]
#[kani::stub(crate::real::short::log2, stubs::garbage)]
#[kani::stub(crate::real::short::exp2, stubs::garbage)]
fn a_way_stays_within_1() {
    let shape = BoucWen::<f32>::try_new(kani::any(), kani::any(), kani::any());
    kani::assume(shape.is_ok());
    if let Ok(shape) = shape {
        let (eta, direction): (f32, f32) = (within(-1.0, 1.0), kani::any());
        let next = shape.way(eta, direction).after(finite());
        kani::cover!((direction > 0.0) & (next > eta));
        kani::cover!((direction < 0.0) & (next < eta));
        assert!(next.abs() <= 1.0);
        assert!(direction < 0.0 || next >= eta);
        assert!(!(direction < 0.0) || next <= eta);
    }
}
