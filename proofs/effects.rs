//! K14: regressors are finite, and so are their memories, for any sample.
//!
//! `Effect::regressor` chooses the effect and calls `evaluate`; to call that spares the
//! solver the other forty effects.

use super::info::sealed::Sealed;
use super::*;
use crate::proofs::any::finite;
use crate::proofs::properties::effect::a_late_output_is_finite;
use crate::proofs::stubs;

/// All bit patterns.
fn situation() -> Inputs<f32> {
    let motion = || Motion {
        position: kani::any(),
        velocity: kani::any(),
        acceleration: kani::any(),
    };
    Inputs {
        dt: kani::any(),
        time: kani::any(),
        motion: motion(),
        input: motion(),
        load: kani::any(),
        eta: kani::any(),
        output: kani::any(),
    }
}

/// No sample yet, or a memory of any finite numbers.
fn state() -> EffectState<f32> {
    let memory = [finite(), finite(), finite(), finite()];
    EffectState {
        memory: kani::any::<bool>().then_some(memory),
    }
}

/// A tuple: to compare arrays is a loop for the solver.
fn bits(state: &EffectState<f32>) -> Option<(u32, u32, u32, u32)> {
    let bits = |[a, b, c, d]: [f32; 4]| (a.to_bits(), b.to_bits(), c.to_bits(), d.to_bits());
    state.memory.map(bits)
}

fn remembers_finite_numbers(state: &EffectState<f32>) -> bool {
    state
        .memory
        .is_none_or(|[a, b, c, d]| a.is_finite() && b.is_finite() && c.is_finite() && d.is_finite())
}

/// Whatever the sample, the regressor and the memory are finite; where a number that it
/// reads is not, it is zero and the memory stays.
fn any_sample<R: Regressor<f32>>(effect: Result<R, Error>) {
    kani::assume(effect.is_ok());
    if let Ok(effect) = effect {
        let (mut state, at) = (state(), situation());
        let before = bits(&state);
        let value = evaluate(&effect, &mut state, &at);
        kani::cover!(before.is_some() && before != bits(&state));
        assert!(value.is_finite() && remembers_finite_numbers(&state));
        assert!(at.is_usable(R::INFO.reads) || (value == 0.0 && before == bits(&state)));
    }
}

/// An effect that reads everything and whose formula gives any float.
struct Anything;

impl Sealed for Anything {}

impl Regressor<f32> for Anything {
    const INFO: &'static Info = &Info {
        reads: &[
            Quantity::Dt,
            Quantity::Time,
            Quantity::Position,
            Quantity::Velocity,
            Quantity::Acceleration,
            Quantity::Input,
            Quantity::Load,
            Quantity::Eta,
            Quantity::Output,
        ],
        ..*<Offset as Regressor<f32>>::INFO
    };

    fn shape(&self, _: usize) -> Option<f32> {
        None
    }

    fn try_from_shapes(_: &[f32]) -> Result<Self, Error> {
        Ok(Self)
    }

    fn value(&self, _: &mut EffectState<f32>, _: &Inputs<f32>) -> f32 {
        kani::any()
    }
}

/// K14. A regressor without memory is finite for any sample, whatever its formula returns; if a
/// number that it reads is not finite, it is zero.
#[kani::proof]
#[kani::unwind(10)]
fn any_formula_is_finite() {
    let (mut state, at) = (state(), situation());
    let value = evaluate(&Anything, &mut state, &at);
    kani::cover!(value > 1.0);
    assert!(value.is_finite());
    assert!(at.is_usable(<Anything as Regressor<f32>>::INFO.reads) || value == 0.0);
}

/// K14. Backlash: its regressor and its memory are finite for any sample; a bad sample changes
/// neither.
#[kani::proof]
#[kani::unwind(10)]
fn backlash_is_finite() {
    any_sample(Backlash::try_new(kani::any()));
}

/// K14. The same for the play in series.
#[kani::proof]
#[kani::unwind(10)]
fn play_in_series_is_finite() {
    any_sample(PlayInSeries::try_new(kani::any()));
}

/// K14. The same for presliding.
#[kani::proof]
#[kani::unwind(10)]
fn presliding_is_finite() {
    any_sample(Presliding::try_new(kani::any()));
}

/// K14. The same for creep.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn creep_is_finite() {
    any_sample(Creep::try_new(kani::any()));
}

/// K14. The same for the lag.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
fn lag_effect_is_finite() {
    any_sample(Lag::try_new(kani::any()));
}

/// K14. The same for the delay.
#[kani::proof]
#[kani::unwind(10)]
fn delay_is_finite() {
    any_sample(Ok(Delay));
}

/// K14. The contribution of a delay of any length to the output, and its memory, are finite for any
/// sample; on an unreadable sample it adds zero and keeps its memory.
#[kani::proof]
#[kani::unwind(10)]
fn late_output_is_finite() {
    let (gain, mut state, at) = (finite(), state(), situation());
    let before = bits(&state);
    let kept = a_late_output_is_finite(gain, &mut state, &at);
    kani::cover!(gain > 0.0 && before.is_some() && before != bits(&state));
    assert!(kept && remembers_finite_numbers(&state));
}

/// K14. A segment of a curve is within 0 and 1 for any finite input: a curve stays between its
/// smallest and its largest point.
#[kani::proof]
#[kani::unwind(10)]
fn curve_is_within_its_points() {
    let effect = CurveVelocity::<f32>::try_new(kani::any(), kani::any());
    kani::assume(effect.is_ok());
    if let Ok(effect) = effect {
        let value = evaluate(&effect, &mut state(), &situation());
        kani::cover!(0.0 < value && value < 1.0);
        assert!((0.0..=1.0).contains(&value));
    }
}

/// What `sum_is_finite` proves of a step of the sum, and no more.
fn any_sum<T: Real>([sum, carry]: [T; 2], step: T) -> [T; 2] {
    let [total, lost] = [T::from_f64(kani::any()), T::from_f64(kani::any())];
    let finite = sum.is_finite() && carry.is_finite() && step.is_finite();
    kani::assume(!finite || (total.is_finite() && lost.is_finite()));
    [total, lost]
}

/// K14. The compensated sum that is an effect's memory is finite after any finite step.
#[kani::proof]
fn sum_is_finite() {
    let (before, step) = ([finite(), finite()], finite());
    let [total, carry] = bounds::add(before, step);
    kani::cover!(total == f32::MAX && carry == 0.0);
    assert!(total.is_finite() && carry.is_finite());
}

/// K14. The same as backlash above for Dahl's curve.
///
/// Assumes: nothing about sample or memory; the sum as proved by sum_is_finite.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(bounds::add, any_sum)]
fn dahl_is_finite() {
    any_sample(PreslidingDahl::try_new(kani::any()));
}

/// K14. The same as backlash above for degradation, including the accumulated work.
///
/// Assumes: nothing about sample or memory; the sum as proved by sum_is_finite.
#[kani::proof]
#[kani::unwind(10)]
#[kani::stub(libm::expm1f, stubs::expm1f)]
#[kani::stub(bounds::add, any_sum)]
fn degradation_is_finite() {
    any_sample(Degradation::try_new(kani::any()));
}

/// K14. The contract of saturation: for any input the output is finite.
#[kani::proof_for_contract(saturate)]
fn saturate_contract() {
    let x: f32 = kani::any();
    kani::cover!(saturate(x) != x && !x.is_nan());
}
