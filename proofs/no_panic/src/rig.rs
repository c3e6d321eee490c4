//! `lab/rig/`

use crate::model::term;
use crate::{any, never_panics};
use bowden::Real;
use bowden_rig::*;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(rig_config_reference, RigConfig::<T>::reference());
    never_panics!(rig_config_varying, RigConfig::<T>::varying());
    never_panics!(rig_drift_reference, Drift::<T>::reference());

    never_panics!(rig_reference_paper, Reference::<T>::paper());
    never_panics!(rig_reference_gait, Reference::<T>::gait());
    let reference = black_box(Reference::<T>::paper());
    never_panics!(rig_reference_period, reference.period());
    never_panics!(rig_reference_with_ramp, reference.with_ramp(any()));
    never_panics!(rig_reference_between, reference.between(any(), any()));
    never_panics!(rig_reference_maximum, reference.maximum());
    never_panics!(rig_reference_magnitude, reference.magnitude());
    never_panics!(rig_reference_at, reference.at(any()));
    never_panics!(rig_reference_motion, reference.motion(any()));

    never_panics!(rig_noise_new, Noise::new(black_box(1)));
    let mut noise = black_box(Noise::new(1));
    never_panics!(rig_noise_bits, black_box(&mut noise).bits());
    never_panics!(rig_noise_uniform, black_box(&mut noise).uniform());
    never_panics!(rig_noise_normal, black_box(&mut noise).normal::<T>());

    let config = black_box(RigConfig::<T>::varying());
    let terms = [term::<T>(), term()];
    let terms = black_box(&terms[..]);
    never_panics!(rig_try_new, Rig::<T, 2>::try_new(config, terms));
    let rig = black_box(Rig::<T, 2>::try_new(config, terms)).ok()?;
    never_panics!(rig_config, *rig.config());
    never_panics!(rig_undeclared, rig.undeclared());
    never_panics!(rig_start, rig.start(black_box(1)));
    let mut state = black_box(rig.start(1));
    never_panics!(rig_step, rig.step(&mut state, any(), any()));
    never_panics!(
        rig_step_with_load,
        rig.step_with_load(&mut state, any(), any(), any())
    );
    never_panics!(rig_sample, state.sample());
    never_panics!(rig_proximal, state.proximal());
    never_panics!(rig_distal, state.distal());
    Some(())
}
