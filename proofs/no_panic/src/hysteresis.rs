//! `hysteresis/`

use crate::{any, never_panics};
use bowden::hysteresis::*;
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(hysteresis_state_new, BoucWenState::<T>::new());
    never_panics!(
        hysteresis_state_with_eta,
        BoucWenState::<T>::with_eta(any())
    );
    let mut state = black_box(BoucWenState::<T>::new());
    never_panics!(hysteresis_state_eta, state.eta());
    never_panics!(hysteresis_state_input, state.input());
    never_panics!(hysteresis_state_start, Sensitivity::<T>::start(any()));

    never_panics!(
        hysteresis_shape_try_new,
        BoucWen::<T>::try_new(any(), any(), any())
    );
    let shape = black_box(BoucWen::<T>::try_new(any(), any(), any())).ok()?;
    never_panics!(hysteresis_shape_rho, shape.rho());
    never_panics!(hysteresis_shape_sigma, shape.sigma());
    never_panics!(hysteresis_shape_n, shape.n());
    never_panics!(hysteresis_shape_advance, shape.advance(any(), any()));
    never_panics!(
        hysteresis_shape_advance_bounded,
        shape.advance_bounded(any(), any())
    );
    never_panics!(
        hysteresis_shape_advance_split,
        shape.advance_split(any(), any())
    );
    let sensitivity = black_box(Sensitivity::start(any()));
    never_panics!(
        hysteresis_shape_advance_with_sensitivity,
        shape.advance_with_sensitivity(sensitivity, any())
    );
    never_panics!(hysteresis_shape_slope, shape.slope(any(), any()));
    never_panics!(hysteresis_shape_step, shape.step(&mut state, any()));

    never_panics!(
        hysteresis_law_eta_rate,
        law::eta_rate::<T>(any(), any(), any(), any(), any())
    );
    never_panics!(hysteresis_law_f, law::f::<T>(any(), any(), any()));
    Some(())
}
