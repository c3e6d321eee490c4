//! `control/`

mod adaptive;
mod compensator;
mod law;
mod learning;
mod observer;
mod pid;
mod relay;

use crate::{any, never_panics};
use bowden::control::{Controller, Fallback, Limits, LoopSample, Pid, PidState, Status};
use bowden::Real;
use std::hint::black_box;

pub use adaptive::law;

pub fn all<T: Real>() -> Option<()> {
    law::all::<T>();
    never_panics!(control_limits_try_new, Limits::<T>::try_new(any(), any()));
    never_panics!(control_limits_unlimited, Limits::<T>::unlimited());
    let limits = black_box(Limits::<T>::unlimited());
    never_panics!(control_limits_with_slew, limits.with_slew(any()));
    never_panics!(control_limits_low, limits.low());
    never_panics!(control_limits_high, limits.high());
    never_panics!(control_limits_slew, limits.slew());
    never_panics!(control_limits_contains, limits.contains(any()));
    never_panics!(control_limits_apply, limits.apply(any(), any(), any()));
    never_panics!(control_limits_clamp, limits.clamp(any()));

    never_panics!(
        control_status_try_new,
        Fallback::<T>::try_new(black_box(3), any())
    );
    never_panics!(
        control_status_hold_indefinitely,
        Fallback::<T>::hold_indefinitely()
    );
    let fallback = black_box(Fallback::<T>::hold_indefinitely());
    never_panics!(
        control_status_with_weight,
        fallback.with_weight(black_box(3))
    );
    never_panics!(control_status_weight, fallback.weight());
    never_panics!(control_status_most, fallback.most());
    never_panics!(control_status_after, fallback.after());
    never_panics!(control_status_command, fallback.command());

    let status = black_box(Status::Good);
    never_panics!(control_status_fault, status.fault());
    let at = LoopSample::new(any(), any(), any());
    never_panics!(
        control_controller_new,
        LoopSample::<T>::new(any(), any(), any())
    );
    let pi = black_box(Pid::<T>::paper_pi());
    let mut state = black_box(PidState::new());
    never_panics!(
        control_controller_step,
        Controller::step(&pi, &mut state, &at)
    );
    never_panics!(
        error_parameter,
        black_box(bowden::Error::Capacity("terms")).parameter()
    );

    pid::all::<T>()?;
    relay::all::<T>()?;
    observer::all::<T>()?;
    learning::all::<T>()?;
    adaptive::all::<T>()?;
    compensator::all::<T>()
}
