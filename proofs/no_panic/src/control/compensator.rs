//! `control/compensator.rs`

use crate::effect::motion;
use crate::model::model;
use crate::{any, never_panics};
use bowden::control::{Applied, BenchRange, Compensator, CompensatorInput, CompensatorState};
use bowden::effect::Motion;
use bowden::model::Source;
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    let model = model::<T>()?;
    never_panics!(control_compensator_try_new, Compensator::try_new(&model));
    never_panics!(
        control_compensator_nearest_try_nearest,
        Compensator::try_nearest(&model)
    );
    let (_, changed) = black_box(Compensator::try_nearest(&model)).ok()?;
    never_panics!(control_compensator_nearest_is_nothing, changed.is_nothing());
    never_panics!(
        control_compensator_nearest_left_out,
        changed.left_out().last()
    );
    let compensator = black_box(Compensator::try_new(&model)).ok()?;
    let range = BenchRange {
        source: black_box(Source::Input),
        low: motion(),
        high: motion(),
    };
    let ranges = [range, range];
    let ranges = black_box(&ranges[..]);
    never_panics!(
        control_compensator_with_ranges,
        compensator.with_ranges(ranges)
    );
    never_panics!(control_compensator_with_play, compensator.with_play(any()));
    let compensator = black_box(compensator.with_play(any())).ok()?;
    never_panics!(
        control_compensator_transmission,
        *compensator.transmission()
    );
    never_panics!(
        control_compensator_new,
        CompensatorInput::<T>::new(any(), any())
    );
    never_panics!(control_compensator_new, CompensatorState::<T, 2>::new());
    never_panics!(
        control_compensator_with_eta,
        CompensatorState::<T, 2>::with_eta(any())
    );
    let channels: [Motion<T>; 2] = [motion(), motion()];
    let at = CompensatorInput {
        dt: any(),
        desired: any(),
        input: motion(),
        load: any(),
        channels: black_box(&channels[..]),
    };
    let compensator = black_box(compensator.with_ranges(ranges)).ok()?;
    let mut state = black_box(CompensatorState::new());
    never_panics!(
        control_compensator_with_longest_dt,
        compensator.with_longest_dt(any())
    );
    never_panics!(control_compensator_step, compensator.step(&mut state, &at));
    never_panics!(
        control_compensator_applied_applied,
        compensator.applied(&mut state, black_box(Applied::Command(any())))
    );
    never_panics!(control_compensator_command, state.command());
    never_panics!(control_compensator_eta, state.eta());
    never_panics!(control_compensator_consecutive_bad, state.consecutive_bad());
    Some(())
}
