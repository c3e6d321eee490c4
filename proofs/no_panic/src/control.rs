//! `control/`

mod adaptive;
mod compensator;
mod pid;

use crate::{any, never_panics};
use bowden::control::{Fallback, Limits};
use bowden::Real;
use std::hint::black_box;

pub use adaptive::law;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(control_limits_try_new, Limits::<T>::try_new(any(), any()));
    never_panics!(control_limits_none, Limits::<T>::none());
    let limits = black_box(Limits::<T>::none());
    never_panics!(control_limits_with_slew, limits.with_slew(any()));
    never_panics!(control_limits_low, limits.low());
    never_panics!(control_limits_high, limits.high());
    never_panics!(control_limits_slew, limits.slew());
    never_panics!(control_limits_contains, limits.contains(any()));
    never_panics!(control_limits_apply, limits.apply(any(), any(), any()));

    never_panics!(
        control_status_try_new,
        Fallback::<T>::try_new(black_box(3), any())
    );
    never_panics!(control_status_hold, Fallback::<T>::hold());
    let fallback = black_box(Fallback::<T>::hold());
    never_panics!(control_status_after, fallback.after());
    never_panics!(control_status_command, fallback.command());

    pid::all::<T>()?;
    adaptive::all::<T>()?;
    compensator::all::<T>()
}
