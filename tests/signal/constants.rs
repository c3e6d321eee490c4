//! Configurations in flash: one of each compiles, and is what the run time makes.
#![allow(clippy::unnecessary_cast)]

use super::*;
use bowden::hysteresis::BoucWen;
use bowden::transmission::Transmission;
use bowden::{constant, Constant};
use std::fmt::Debug;

/// The same statics and the same comparisons in both floats.
macro_rules! statics {
    ($name:ident, $float:ty) => {
        mod $name {
            use super::*;

            static SHAPE: BoucWen<$float> =
                constant!(BoucWen::<$float>::try_new(0.09582, 98.36, 3.871));
            static CABLE: Transmission<$float> = constant!(Transmission::<$float>::torque(
                0.9978, 7.004, 0.05174, SHAPE
            ));
            static SPRING: Transmission<$float> = constant!(
                Transmission::<$float>::displacement(0.9978, 7.004, 0.05174, SHAPE)
            );
            static DERIVATIVE: Derivative<$float> =
                constant!(Derivative::<$float>::try_new(0.01));
            static PLAY: Play<$float> = constant!(Play::<$float>::try_new(0.2));
            static RAMP: Ramp<$float> = constant!(Ramp::<$float>::try_new(50.0, 0.02).with_longest_dt(0.005)
            );
            static RATES: Rates<$float> = constant!(Rates::<$float>::for_cutoff(5.0)
            .with_period(4096.0)
            .with_longest_gap(0.1));
            static LOW_PASS: LowPass<$float> = constant!(LowPass::<$float>::try_new(0.01));
            static NOTCH: Biquad<$float> =
                constant!(Biquad::<$float>::notch(35.0, 5.0, 0.001));
            static EDGES: EdgeVelocity<$float> =
                constant!(EdgeVelocity::<$float>::try_new(1.0, 0.01, 0.2)
                    .with_period(4096.0));
            static SENSOR: Plausible<$float> = constant!(Plausible::<$float>::try_new(-100.0, 100.0)
            .with_rate(550.0)
            .with_sample_period(0.01)
            .with_longest_dt(0.005))
            .with_stuck_after(50);

            #[test]
            fn a_configuration_in_flash_is_the_one_of_the_run_time() {
                let shape = BoucWen::try_new(0.09582, 98.36, 3.871);
                assert_eq!(Ok(SHAPE), shape);
                assert_eq!(
                    Ok(CABLE),
                    Transmission::torque(0.9978, 7.004, 0.05174, SHAPE)
                );
                assert_eq!(
                    Ok(SPRING),
                    Transmission::displacement(0.9978, 7.004, 0.05174, SHAPE)
                );
                assert_eq!(Ok(DERIVATIVE), Derivative::try_new(0.01));
                assert_eq!(Ok(PLAY), Play::try_new(0.2));
                let ramp = Ramp::try_new(50.0, 0.02).and_then(|ramp| ramp.with_longest_dt(0.005));
                assert_eq!(Ok(RAMP), ramp);
                let rates = Rates::for_cutoff(5.0)
                    .and_then(|rates| rates.with_period(4096.0))
                    .and_then(|rates| rates.with_longest_gap(0.1));
                assert_eq!(Ok(RATES), rates);
                assert_eq!(Ok(LOW_PASS), LowPass::try_new(0.01));
                assert_eq!(Ok(NOTCH), Biquad::notch(35.0, 5.0, 0.001));
                let edges = EdgeVelocity::try_new(1.0, 0.01, 0.2)
                    .and_then(|edges| edges.with_period(4096.0));
                assert_eq!(Ok(EDGES), edges);
                let sensor = Plausible::try_new(-100.0, 100.0)
                    .and_then(|sensor| sensor.with_rate(550.0))
                    .and_then(|sensor| sensor.with_sample_period(0.01))
                    .and_then(|sensor| sensor.with_longest_dt(0.005))
                    .map(|sensor| sensor.with_stuck_after(50));
                assert_eq!(Ok(SENSOR), sensor);
            }

            proptest! {
                /// Accepted with the same bits, or refused with the same words.
                #[test]
                fn any_arguments_are_judged_alike(a in any_of(), b in any_of(), c in any_of()) {
                    type F = $float;
                    let [a, b, c] = [a as F, b as F, c as F];
                    alike(Constant::<BoucWen<F>>::try_new(a, b, c), BoucWen::try_new(a, b, c));
                    alike(
                        Constant::<Transmission<F>>::torque(a, b, c, SHAPE),
                        Transmission::torque(a, b, c, SHAPE),
                    );
                    alike(
                        Constant::<Transmission<F>>::displacement(a, b, c, SHAPE),
                        Transmission::displacement(a, b, c, SHAPE),
                    );
                    alike(Constant::<Derivative<F>>::try_new(a), Derivative::try_new(a));
                    alike(Constant::<Play<F>>::try_new(a), Play::try_new(a));
                    alike(Constant::<Ramp<F>>::try_new(a, b), Ramp::try_new(a, b));
                    alike(Constant::<Ramp<F>>::with_longest_dt(RAMP, a), RAMP.with_longest_dt(a));
                    alike(Constant::<Rates<F>>::try_new(a), Rates::try_new(a));
                    alike(Constant::<Rates<F>>::for_cutoff(a), Rates::for_cutoff(a));
                    alike(Constant::<Rates<F>>::with_period(RATES, a), RATES.with_period(a));
                    alike(Constant::<Rates<F>>::with_longest_gap(RATES, a), RATES.with_longest_gap(a));
                    alike(Constant::<LowPass<F>>::try_new(a), LowPass::try_new(a));
                    alike(Constant::<Biquad<F>>::low_pass(a, b, c), Biquad::low_pass(a, b, c));
                    alike(Constant::<Biquad<F>>::notch(a, b, c), Biquad::notch(a, b, c));
                    alike(Constant::<EdgeVelocity<F>>::try_new(a, b, c), EdgeVelocity::try_new(a, b, c));
                    alike(Constant::<EdgeVelocity<F>>::with_period(EDGES, a), EDGES.with_period(a));
                    alike(Constant::<Plausible<F>>::with_sample_period(SENSOR, a), SENSOR.with_sample_period(a));
                    alike(Constant::<Plausible<F>>::with_longest_dt(SENSOR, a), SENSOR.with_longest_dt(a));
                }
            }
        }
    };
}
statics!(single, f32);
statics!(double, f64);

fn alike<C: Debug + PartialEq>(constant: Result<C, Error>, checked: Result<C, Error>) {
    assert_eq!(constant, checked);
}

/// Numbers that constructors accept, those at their edges, and any.
fn any_of() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 1e-3..10.0_f64,
        1 => prop::sample::select(vec![0.0, -0.0, 0.5, 1.0, -1.0, 1e9, 2e9, f64::NAN, f64::INFINITY]),
        1 => any::<u64>().prop_map(f64::from_bits)
    ]
}
