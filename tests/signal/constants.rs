//! Configurations in flash: one of each compiles, and is what the run time makes.

use super::*;
use bowden::hysteresis::BoucWen;
use bowden::transmission::Transmission;
use bowden::{constant, Constant};

/// Accepted with the same bits, or refused with the same words.
macro_rules! alike {
    ($float:ty: $($kind:ident::$make:ident($($x:expr),+);)+) => {$(
        let constant = Constant::<$kind<$float>>::$make($($x),+);
        assert_eq!(constant, $kind::<$float>::$make($($x),+));
    )+};
}

/// Both floats; a shape that others are made of.
macro_rules! both {
    ($name:ident, $float:ty) => {
        mod $name {
            use super::*;

            static SHAPE: BoucWen<$float> =
                constant!(BoucWen::<$float>::try_new(0.09582, 98.36, 3.871));

            #[test]
            fn a_configuration_in_flash_is_the_one_of_the_run_time() {
                in_flash!($float:
                    BoucWen::try_new(0.09582, 98.36, 3.871);
                    Transmission::torque(0.9978, 7.004, 0.05174, SHAPE);
                    Transmission::displacement(0.9978, 7.004, 0.05174, SHAPE);
                    Derivative::try_new(0.01);
                    Play::try_new(0.2);
                    Ramp::try_new(50.0, 0.02).with_longest_dt(0.005);
                    Rates::for_cutoff(5.0).with_period(4096.0).with_longest_gap(0.1);
                    LowPass::try_new(0.01);
                    Biquad::notch(35.0, 5.0, 0.001);
                    EdgeVelocity::try_new(1.0, 0.01, 0.2).with_period(4096.0);
                    Plausible::try_new(-100.0, 100.0)
                        .with_rate(550.0).with_sample_period(0.01).with_longest_dt(0.005);
                );
            }

            proptest! {
                #[test]
                fn any_arguments_are_judged_alike(a in any_of(), b in any_of(), c in any_of()) {
                    let [a, b, c] = [a, b, c].map(<$float as Real>::from_f64);
                    let ramp = Ramp::try_new(50.0, 0.02).unwrap();
                    let rates = Rates::for_cutoff(5.0).unwrap();
                    let edges = EdgeVelocity::try_new(1.0, 0.01, 0.2).unwrap();
                    let sensor = Plausible::try_new(-100.0, 100.0).unwrap();
                    alike!($float:
                        BoucWen::try_new(a, b, c);
                        Transmission::torque(a, b, c, SHAPE);
                        Transmission::displacement(a, b, c, SHAPE);
                        Derivative::try_new(a);
                        Play::try_new(a);
                        Ramp::try_new(a, b);
                        Ramp::with_longest_dt(ramp, a);
                        Rates::try_new(a);
                        Rates::for_cutoff(a);
                        Rates::with_period(rates, a);
                        Rates::with_longest_gap(rates, a);
                        LowPass::try_new(a);
                        Biquad::low_pass(a, b, c);
                        Biquad::notch(a, b, c);
                        EdgeVelocity::try_new(a, b, c);
                        EdgeVelocity::with_period(edges, a);
                        Plausible::with_sample_period(sensor, a);
                        Plausible::with_longest_dt(sensor, a);
                    );
                }
            }
        }
    };
}
both!(single, f32);
both!(double, f64);

/// Numbers that constructors accept, those at their edges, and any.
fn any_of() -> impl Strategy<Value = f64> {
    prop_oneof![
        3 => 1e-3..10.0_f64,
        1 => prop::sample::select(vec![0.0, -0.0, 0.5, 1.0, -1.0, 1e9, 2e9, f64::NAN, f64::INFINITY]),
        1 => any::<u64>().prop_map(f64::from_bits)
    ]
}
