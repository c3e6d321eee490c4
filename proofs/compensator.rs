//! K1: any sample to the compensator, whatever model it turns round.

use super::*;
use crate::hysteresis::BoucWen;
use crate::proofs::any::{finite, within};
use crate::proofs::properties::control::compensator_commands_are_finite;

/// Any share of the effects, NaN included.
fn any_share<T: Real, const N: usize>(
    _: &Model<T, N>,
    _: &mut ModelState<T, N>,
    _: &Sample<T>,
    _: (T, T),
    _: impl Fn(usize, &mut Inputs<T>),
) -> T {
    T::from_f64(kani::any())
}

/// Any term, or none, that cannot read what it needs.
fn any_blind_term<T: Real, const N: usize>(_: &Model<T, N>, _: &Sample<T>) -> Option<usize> {
    kani::any::<bool>().then(kani::any)
}

/// Any root of the inverse, NaN included, with an eta as the hysteresis' rows prove of a step.
fn any_root<T: Real>(_: &Inverse<T>, _: T, _: T, _: T, _: T, _: T) -> (T, T) {
    let eta = kani::any_where(|eta: &f64| eta.abs() <= 1.0);
    (T::from_f64(kani::any()), T::from_f64(eta))
}

/// What the hysteresis' rows prove of a step, and no more.
fn any_eta<T: Real>(_: &BoucWen<T>, _: T, _: T) -> T {
    T::from_f64(kani::any_where(|eta: &f64| eta.abs() <= 1.0))
}

/// Any transmission that has an inverse, with any one term.
fn compensator() -> Result<Compensator<f32, 1>, Error> {
    let shape = BoucWen::try_new(kani::any(), kani::any(), kani::any())?;
    let (gain, kappa_eta, offset) = (kani::any(), kani::any(), kani::any());
    let transmission = if kani::any() {
        Transmission::torque(gain, kappa_eta, offset, shape)
    } else {
        Transmission::displacement(gain, kappa_eta, offset, shape)
    }?;
    Compensator::try_new(&Model::try_new(Some(transmission), &[])?)?.with_play(kani::any())
}

/// K1. The compensator: for any sample the command is finite and eta is within ±1; a bad sample
/// changes neither.
///
/// Assumes: nothing about transmission, sample or valid state; any contribution of the effects, any
/// root of the inverse, a step of the hysteresis as proved by the rows of K3.
#[kani::proof]
#[kani::unwind(6)]
#[kani::stub(Model::effects, any_share)]
#[kani::stub(Model::first_blind_term, any_blind_term)]
#[kani::stub(Inverse::solve, any_root)]
#[kani::stub(BoucWen::advance, any_eta)]
#[kani::stub(BoucWen::bounded, any_eta)]
fn compensator_any_sample() {
    let compensator = compensator();
    kani::assume(compensator.is_ok());
    let hysteresis = BoucWenState::with_eta(within(-1.0, 1.0));
    if let (Ok(compensator), Ok(mut hysteresis)) = (compensator, hysteresis) {
        if kani::any() {
            // The first sample is taken over as it is: any input that there can be.
            compensator
                .transmission
                .shape()
                .step(&mut hysteresis, finite());
        }
        let mut state = CompensatorState {
            bad: kani::any(),
            ..CompensatorState::from_hysteresis(hysteresis)
        };
        let motion = || Motion {
            position: kani::any(),
            velocity: kani::any(),
            acceleration: kani::any(),
        };
        let at = CompensatorInput {
            dt: kani::any(),
            desired: kani::any(),
            input: motion(),
            load: kani::any(),
            channels: &[],
        };
        let before = state;
        let kept = compensator_commands_are_finite(&compensator, &mut state, &at);
        kani::cover!(state.bad == 0 && state.eta() != before.eta());
        kani::cover!(at.desired.is_nan() && state.bad > 1);
        assert!(kept);
    }
}
