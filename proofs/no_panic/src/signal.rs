//! `signal/`

use crate::{any, never_panics};
use bowden::signal::*;
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(signal_clamp_clamp, clamp::<T>(any(), any(), any()));

    never_panics!(
        signal_plausible_try_new,
        Plausible::<T>::try_new(any(), any())
    );
    let plausible = black_box(Plausible::<T>::try_new(any(), any())).ok()?;
    never_panics!(signal_plausible_with_rate, plausible.with_rate(any()));
    let plausible = black_box(plausible.with_rate(any())).ok()?;
    never_panics!(
        signal_plausible_with_sample_period,
        plausible.with_sample_period(any())
    );
    let plausible = black_box(plausible.with_sample_period(any())).ok()?;
    never_panics!(
        signal_plausible_with_stuck_after,
        plausible.with_stuck_after(black_box(3))
    );
    never_panics!(signal_plausible_new, PlausibleState::<T>::new());
    let mut state = black_box(PlausibleState::<T>::new());
    never_panics!(
        signal_plausible_with_longest_dt,
        plausible.with_longest_dt(any())
    );
    never_panics!(
        signal_plausible_step,
        plausible.step(&mut state, any(), any(), black_box(true))
    );
    never_panics!(signal_plausible_last, state.last());

    never_panics!(signal_ramp_try_new, Ramp::<T>::try_new(any(), any()));
    let ramp = black_box(Ramp::<T>::try_new(any(), any())).ok()?;
    never_panics!(signal_ramp_with_longest_dt, ramp.with_longest_dt(any()));
    never_panics!(signal_ramp_at, RampState::<T>::at(any()));
    let mut state = black_box(RampState::<T>::at(any()));
    never_panics!(signal_ramp_step, ramp.step(&mut state, any(), any()));
    never_panics!(signal_ramp_value, state.value());

    never_panics!(signal_play_try_new, Play::<T>::try_new(any()));
    let play = black_box(Play::<T>::try_new(any())).ok()?;
    never_panics!(signal_play_new, PlayState::<T>::new());
    let mut state = black_box(PlayState::<T>::new());
    never_panics!(signal_play_half_width, play.half_width());
    never_panics!(signal_play_step, play.step(&mut state, any()));
    never_panics!(signal_play_output, state.output());

    never_panics!(signal_derivative_try_new, Derivative::<T>::try_new(any()));
    let rate = black_box(Derivative::<T>::try_new(any())).ok()?;
    never_panics!(signal_derivative_new, DerivativeState::<T>::new());
    let mut state = black_box(DerivativeState::<T>::new());
    never_panics!(signal_derivative_step, rate.step(&mut state, any(), any()));
    never_panics!(signal_derivative_rate, state.rate());

    never_panics!(signal_rates_try_new, Rates::<T>::try_new(any()));
    never_panics!(signal_rates_for_cutoff, Rates::<T>::for_cutoff(any()));
    let rates = black_box(Rates::<T>::try_new(any())).ok()?;
    never_panics!(signal_rates_with_period, rates.with_period(any()));
    never_panics!(signal_rates_with_longest_gap, rates.with_longest_gap(any()));
    let rates = black_box(rates.with_period(any())).ok()?;
    never_panics!(signal_rates_time_constant, rates.time_constant());
    never_panics!(signal_rates_new, RatesState::<T>::new());
    let mut state = black_box(RatesState::<T>::new());
    never_panics!(signal_rates_step, rates.step(&mut state, any(), any()));
    never_panics!(signal_rates_motion, state.motion());
    never_panics!(signal_rates_gap, state.gap());
    filters::<T>()?;
    edges::<T>()
}

fn filters<T: Real>() -> Option<()> {
    never_panics!(signal_low_pass_try_new, LowPass::<T>::try_new(any()));
    let low_pass = black_box(LowPass::<T>::try_new(any())).ok()?;
    never_panics!(signal_low_pass_new, LowPassState::<T>::new());
    never_panics!(signal_low_pass_at, LowPassState::<T>::at(any()));
    let mut state = black_box(LowPassState::<T>::at(any()));
    never_panics!(
        signal_low_pass_step,
        low_pass.step(&mut state, any(), any())
    );
    never_panics!(signal_low_pass_value, state.value());

    never_panics!(
        signal_biquad_low_pass,
        Biquad::<T>::low_pass(any(), any(), any())
    );
    never_panics!(signal_biquad_notch, Biquad::<T>::notch(any(), any(), any()));
    let biquad = black_box(Biquad::<T>::notch(any(), any(), any())).ok()?;
    never_panics!(signal_biquad_new, BiquadState::<T>::new());
    never_panics!(signal_biquad_at, BiquadState::<T>::at(any()));
    let mut state = black_box(BiquadState::<T>::at(any()));
    never_panics!(signal_biquad_step, biquad.step(&mut state, any(), any()));
    never_panics!(signal_biquad_value, state.value());
    Some(())
}

fn edges<T: Real>() -> Option<()> {
    never_panics!(
        signal_edges_try_new,
        EdgeVelocity::<T>::try_new(any(), any(), any())
    );
    let edges = black_box(EdgeVelocity::<T>::try_new(any(), any(), any())).ok()?;
    never_panics!(signal_edges_with_period, edges.with_period(any()));
    let edges = black_box(edges.with_period(any())).ok()?;
    never_panics!(signal_edges_new, EdgeVelocityState::<T>::new());
    let mut state = black_box(EdgeVelocityState::<T>::new());
    never_panics!(signal_edges_step, edges.step(&mut state, any(), any()));
    never_panics!(signal_edges_velocity, state.velocity());
    Some(())
}
