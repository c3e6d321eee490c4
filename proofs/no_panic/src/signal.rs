//! `signal/`

use crate::{any, never_panics};
use bowden::signal::*;
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(signal_clamp_clamp, clamp::<T>(any(), any(), any()));

    never_panics!(signal_play_try_new, Play::<T>::try_new(any()));
    let play = black_box(Play::<T>::try_new(any())).ok()?;
    never_panics!(signal_play_new, PlayState::<T>::new());
    let mut state = black_box(PlayState::<T>::new());
    never_panics!(signal_play_half_width, play.half_width());
    never_panics!(signal_play_step, play.step(&mut state, any()));
    never_panics!(signal_play_output, state.output());

    never_panics!(signal_guard_try_new, Guard::<T>::try_new(any()));
    let held = black_box(Guard::<T>::try_new(any())).ok()?;
    never_panics!(signal_guard_new, GuardState::<T>::new(any()));
    let mut state = black_box(GuardState::<T>::new(any()));
    never_panics!(signal_guard_limit, held.limit());
    never_panics!(signal_guard_step, held.step(&mut state, any()));
    never_panics!(signal_guard_consecutive_bad, state.consecutive_bad());
    never_panics!(signal_guard_good, state.good());

    never_panics!(signal_derivative_try_new, Derivative::<T>::try_new(any()));
    let rate = black_box(Derivative::<T>::try_new(any())).ok()?;
    never_panics!(signal_derivative_new, DerivativeState::<T>::new());
    let mut state = black_box(DerivativeState::<T>::new());
    never_panics!(signal_derivative_time_constant, rate.time_constant());
    never_panics!(signal_derivative_step, rate.step(&mut state, any(), any()));
    never_panics!(signal_derivative_rate, state.rate());

    never_panics!(signal_rates_try_new, Rates::<T>::try_new(any()));
    never_panics!(signal_rates_for_cutoff, Rates::<T>::for_cutoff(any()));
    let rates = black_box(Rates::<T>::try_new(any())).ok()?;
    never_panics!(signal_rates_with_period, rates.with_period(any()));
    never_panics!(signal_rates_with_longest_gap, rates.with_longest_gap(any()));
    let rates = black_box(rates.with_period(any())).ok()?;
    never_panics!(signal_rates_time_constant, rates.time_constant());
    never_panics!(signal_rates_longest_gap, rates.longest_gap());
    never_panics!(signal_rates_period, rates.period());
    never_panics!(signal_rates_new, RatesState::<T>::new());
    let mut state = black_box(RatesState::<T>::new());
    never_panics!(signal_rates_step, rates.step(&mut state, any(), any()));
    never_panics!(signal_rates_motion, state.motion());
    never_panics!(signal_rates_gap, state.gap());
    Some(())
}
