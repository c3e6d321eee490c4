//! `bound/`

use crate::control::law;
use crate::{any, never_panics};
use bowden::bound::*;
use bowden::Real;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(bound_plant_exactly, Interval::<T>::exactly(any()));
    never_panics!(bound_plant_between, Interval::<T>::between(any(), any()));
    let interval = black_box(Interval::<T>::exactly(any()));
    never_panics!(bound_plant_magnitude, interval.magnitude());
    never_panics!(bound_plant_furthest_from, interval.furthest_from(any()));
    never_panics!(bound_plant_new, Plant::<T, 2>::new(any(), any()));

    let (law, plant) = (law::<T>()?, black_box(Plant::<T, 2>::new(any(), any())));
    never_panics!(bound_theorem_1_try_new, Theorem1::try_new(&law, &plant));
    never_panics!(bound_rms_try_new, Rms::try_new(&law, &plant));
    never_panics!(bound_peak_try_new, PeakContinuous::try_new(&law, &plant));
    never_panics!(bound_sampled_try_new, PeakSampled::try_new(&law, &plant));
    never_panics!(bound_per_step_try_new, PerStep::try_new(&law, &plant));

    let theorem_1 = black_box(Theorem1::try_new(&law, &plant)).ok()?;
    never_panics!(bound_theorem_1_certificate, theorem_1.certificate());
    let rms = black_box(Rms::try_new(&law, &plant)).ok()?;
    never_panics!(bound_rms_over, rms.over(any(), any()));
    never_panics!(bound_rms_certificate, rms.certificate());
    let continuous = black_box(PeakContinuous::try_new(&law, &plant)).ok()?;
    never_panics!(bound_peak_certificate, continuous.certificate());
    let sampled = black_box(PeakSampled::try_new(&law, &plant)).ok()?;
    never_panics!(bound_sampled_certificate, sampled.certificate());
    let per_step = black_box(PerStep::try_new(&law, &plant)).ok()?;
    never_panics!(bound_per_step_certificate, per_step.certificate());

    let certificate = black_box(rms.certificate());
    never_panics!(bound_certificate_bounds, certificate.bounds());
    never_panics!(bound_certificate_unit, certificate.unit());
    never_panics!(bound_certificate_assumptions, certificate.assumptions());
    Some(())
}
