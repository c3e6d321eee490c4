//! `bound/`

use crate::control::law;
use crate::{any, never_panics};
use bowden::control::{DisturbanceObserver, IterativeLearning, NominalPlant, Pid};
use bowden::Real;
use bowden_bound::*;
use std::hint::black_box;

pub fn all<T: Real>() -> Option<()> {
    never_panics!(bound_interval_exactly, Interval::<T>::exactly(any()));
    never_panics!(bound_interval_between, Interval::<T>::between(any(), any()));
    let interval = black_box(Interval::<T>::exactly(any()));
    never_panics!(bound_interval_magnitude, interval.magnitude());
    never_panics!(
        bound_interval_max_distance_from,
        interval.max_distance_from(any())
    );
    never_panics!(bound_plant_new, Plant::<T, 2>::new(any(), any()));

    let (law, plant) = (law::<T>()?, black_box(Plant::<T, 2>::new(any(), any())));
    never_panics!(bound_theorem_1_try_new, Theorem1::try_new(&law, &plant));
    never_panics!(bound_rms_try_new, Rms::try_new(&law, &plant));
    never_panics!(bound_peak_try_new, PeakContinuous::try_new(&law, &plant));
    never_panics!(bound_sampled_try_new, PeakSampled::try_new(&law, &plant));
    never_panics!(bound_per_step_try_new, PerStep::try_new(&law, &plant));

    never_panics!(bound_rms_sampled_try_new, RmsSampled::try_new(&law, &plant));
    let rms_sampled = black_box(RmsSampled::try_new(&law, &plant)).ok()?;
    never_panics!(bound_rms_sampled_over, rms_sampled.over(any(), any()));
    never_panics!(bound_rms_sampled_certificate, rms_sampled.certificate());
    never_panics!(bound_tightest_try_new, Tightest::try_new(&law, &plant));
    let tightest = black_box(Tightest::try_new(&law, &plant)).ok()?;
    never_panics!(bound_tightest_dominant_term, tightest.dominant_term());
    never_panics!(bound_tightest_certificate, tightest.certificate());
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

    observer::<T>();
    learning::<T>();
    dyadic::<T>();
    rounded::<T>()?;
    let certificate = black_box(rms.certificate());
    never_panics!(bound_certificate_bounds, certificate.bounds());
    never_panics!(bound_certificate_unit, certificate.unit());
    never_panics!(bound_certificate_assumptions, certificate.assumptions());
    Some(())
}

fn dyadic<T: Real>() {
    never_panics!(bound_dyadic_of, Dyadic::of::<T>(any()));
    let number = black_box(Dyadic::of::<T>(any()));
    never_panics!(bound_dyadic_as_f64, number.as_f64());
    never_panics!(bound_dyadic_parts, number.parts());
    let bits = black_box(any::<f32>().to_bits());
    never_panics!(bound_dyadic_shortened, number.shortened(bits));
    never_panics!(bound_dyadic_of, Enclosure::of::<T>(any()));
    never_panics!(bound_interval_exactly, Enclosure::exactly(number));
    let (a, b) = (
        black_box(Enclosure::of::<T>(any())),
        black_box(Enclosure::of::<T>(any())),
    );
    never_panics!(bound_dyadic_is_at_most, a.is_at_most(b));
    never_panics!(bound_dyadic_abs, a.abs());
    never_panics!(bound_dyadic_max, a.max(b));
}

fn rounded<T: Real>() -> Option<()> {
    let (law, plant) = (law::<T>()?, black_box(Plant::<f64, 2>::new(any(), any())));
    never_panics!(bound_rounded_try_new, PeakRounded::try_new(&law, &plant));
    let settings = law.settings();
    never_panics!(
        bound_rounded_examine,
        PeakRounded::examine(settings, &plant)
    );
    let peak = black_box(PeakRounded::examine(settings, &plant)).ok()?;
    never_panics!(bound_rounded_bound, peak.bound());
    never_panics!(bound_rounded_certificate, peak.certificate());
    never_panics!(bound_rounded_is_proved, peak.is_proved());
    never_panics!(bound_rounded_may_meet_the_limit, peak.may_meet_the_limit());
    never_panics!(bound_rounded_refused, peak.refused());
    let inequality = black_box(peak.inequalities).first().copied()?;
    never_panics!(bound_rounded_inequalities_holds, inequality.holds());
    never_panics!(bound_rounded_inequalities_text, inequality.name.text());
    Some(())
}

/// Any range of plants.
fn plants() -> PlantRange {
    let interval = || Interval::<f64>::between(any(), any());
    black_box(PlantRange {
        gain: interval(),
        natural_frequency: interval(),
        damping_ratio: interval(),
        joint: interval(),
        slope: interval(),
        latency: interval(),
    })
}

/// Stability with an observer.
fn observer<T: Real>() -> Option<()> {
    let plant = black_box(NominalPlant::<T>::try_new(any(), any(), any())).ok()?;
    let observer = black_box(DisturbanceObserver::try_new(plant, any(), any(), any())).ok()?;
    let law = black_box(Pid::<T>::paper_pi());
    let plants = plants();
    never_panics!(
        bound_observer_try_new,
        ObserverStability::try_new(&observer, &law, &plants)
    );
    Some(())
}

/// Convergence of a learning.
fn learning<T: Real>() -> Option<()> {
    let number = || black_box(2_u16);
    let learning = IterativeLearning::<T>::try_new(any(), any(), number(), number());
    let learning = black_box(learning).ok()?;
    let law = black_box(Pid::<T>::paper_pi());
    let cycle = black_box(Interval::<f64>::between(any(), any()));
    let (plants, cells) = (plants(), black_box(250));
    never_panics!(
        bound_learning_try_new,
        IterativeLearningConvergence::try_new(&learning, cells, &cycle, &law, &plants, any())
    );
    Some(())
}
