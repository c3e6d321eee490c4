//! Signal conditioning: filters, rates, ramps and checks of sensors.
#![allow(clippy::unwrap_used, clippy::cast_possible_truncation)]

mod arrives;
mod basics;
mod constants;
mod edges;
mod filters;
mod plausible;
mod rates;
#[path = "../shared/mod.rs"]
mod shared;

use bowden::control::Fault;
use bowden::signal::*;
use bowden::{Error, Real};
use proptest::prelude::*;
use shared::*;
use std::f64::consts::{PI, TAU};

const DT: f64 = 1e-3;

/// Any bit pattern, and often enough one that a sensor could give.
fn any_float() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => -5.0..5.0_f32,
        3 => Just(0.001_f32),
        2 => any::<u32>().prop_map(f32::from_bits)
    ]
}

proptest! {
    /// Samples of any signal and any times: each block gives numbers.
    #[test]
    fn no_sequence_of_floats_makes_a_signal_bad(
        settings in (any_float(), any_float(), any_float(), any_float()),
        samples in prop::collection::vec((any_float(), any_float()), 1..60),
        is_notch: bool,
    ) {
        let (a, b, c, period) = settings;
        let design = if is_notch { Biquad::notch } else { Biquad::low_pass };
        let biquad = design(a.abs(), b.abs(), c.abs()).ok();
        let low_pass = LowPass::try_new(c.abs()).ok();
        let derivative = Derivative::try_new(0.01_f32).unwrap();
        let edges = EdgeVelocity::try_new(a.abs(), b.abs(), c.abs()).ok();
        let edges = edges.map(|own| own.with_period(period).unwrap_or(own));
        let rates = Rates::try_new(a.abs()).ok();
        let with_period = rates.map(|own| own.with_period(period));
        let rates = rates.map(|own| own.with_period(period).unwrap_or(own));
        let rates = rates.map(|own| own.with_longest_gap(c).unwrap_or(own));
        let (mut rate, mut lag, mut section) = (DerivativeState::new(), LowPassState::new(), BiquadState::new());
        let (mut counted, mut moved) = (EdgeVelocityState::new(), RatesState::new());
        for (x, dt) in samples {
            prop_assert!(derivative.step(&mut rate, x, dt).is_finite());
            prop_assert!(low_pass.is_none_or(|own| own.step(&mut lag, x, dt).is_finite()));
            prop_assert!(biquad.is_none_or(|own| own.step(&mut section, x, dt).is_finite()));
            if let Some(edges) = &edges {
                let velocity = edges.step(&mut counted, x, dt).velocity;
                prop_assert!(velocity.is_finite() && velocity == counted.velocity());
            }
            let Some(rates) = &rates else { continue };
            let before = moved.motion();
            let out = rates.step(&mut moved, x, dt);
            let motion = out.motion;
            prop_assert!(motion.position.is_finite() && motion.velocity.is_finite());
            prop_assert!(motion.acceleration.is_finite() && moved.gap().is_finite());
            prop_assert!(moved.gap() >= 0.0 && moved.motion() == motion);
            if matches!(out.status, RateStatus::Held(_)) {
                prop_assert_eq!(motion, before);
            } else {
                prop_assert!(x.is_finite() && dt > 0.0 && dt.is_finite());
                prop_assert!(matches!(with_period, Some(Ok(_))) || motion.position == x);
            }
        }
    }
}
