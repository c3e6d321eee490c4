//! `transmission.rs`

use crate::{any, never_panics};
use bowden::hysteresis::{BoucWen, BoucWenState};
use bowden::transmission::Transmission;
use bowden::Real;
use std::hint::black_box;

/// Any transmission.
pub fn transmission<T: Real>() -> Option<Transmission<T>> {
    let shape = black_box(BoucWen::try_new(any(), any(), any())).ok()?;
    black_box(Transmission::torque(any(), any(), any(), shape)).ok()
}

pub fn all<T: Real>() -> Option<()> {
    let shape = black_box(BoucWen::<T>::try_new(any(), any(), any())).ok()?;
    never_panics!(
        transmission_torque,
        Transmission::torque(any(), any(), any(), shape)
    );
    never_panics!(
        transmission_displacement,
        Transmission::displacement(any(), any(), any(), shape)
    );
    let cable = transmission::<T>()?;
    let mut state = black_box(BoucWenState::new());
    never_panics!(transmission_mode, cable.mode());
    never_panics!(transmission_gain, cable.gain());
    never_panics!(transmission_kappa_eta, cable.kappa_eta());
    never_panics!(transmission_offset, cable.offset());
    never_panics!(transmission_shape, *cable.shape());
    never_panics!(transmission_output, cable.output(any(), any()));
    never_panics!(transmission_step, cable.step(&mut state, any()));
    never_panics!(
        transmission_greatest_invertible_sigma,
        cable.greatest_invertible_sigma()
    );
    never_panics!(transmission_nearest_invertible, cable.nearest_invertible());
    never_panics!(transmission_inverse, cable.inverse());
    let inverse = black_box(cable.inverse()).ok()?;
    never_panics!(transmission_inverse_step, inverse.step(&mut state, any()));
    Some(())
}
