//! What the tests of several binaries share.

// Each binary uses some of it.
#![allow(dead_code, clippy::unwrap_used)]

use bowden::effect::Effect;
use bowden::hysteresis::BoucWen;
use bowden::transmission::Transmission;
use bowden::Real;
use proptest::prelude::*;

/// The same with a change.
pub fn with<S>(mut of: S, change: impl FnOnce(&mut S)) -> S {
    change(&mut of);
    of
}

/// Fails where two numbers are as far apart as this, or further.
#[track_caller]
pub fn near(got: f64, expected: f64, within: f64) {
    let error = (got - expected).abs();
    assert!(error < within, "{got} instead of {expected}, by {error:e}");
}

/// The paper's first cable with a knee of this sigma.
pub fn paper<T: Real>(sigma: f64) -> Transmission<T> {
    let [rho, sigma, n] = [0.095_82, sigma, 3.871].map(T::from_f64);
    let [b, kappa_eta, t0] = [0.9978, 7.004, 0.051_74].map(T::from_f64);
    Transmission::torque(b, kappa_eta, t0, BoucWen::try_new(rho, sigma, n).unwrap()).unwrap()
}

/// An effect with plausible shapes, none of them round.
pub fn make<T: Real>(name: &str) -> Effect<T> {
    let shapes: &[f64] = match name {
        "stribeck" => &[0.6, 1.7],
        "capstan" => &[0.7, 0.3],
        "ripple" => &[3.3, 0.4],
        "tone" => &[1.9, 0.8],
        "hardening" | "curve-position" | "curve-velocity" => &[0.7, 0.4],
        _ => &[0.7],
    };
    let shapes: Vec<T> = shapes.iter().map(|&shape| T::from_f64(shape)).collect();
    let shaped = Effect::try_from_name(name, &shapes);
    shaped.unwrap_or_else(|_| Effect::try_from_name(name, &[]).unwrap())
}

/// A number between two, spread evenly over its logarithm.
pub fn over_decades(from: f64, to: f64) -> impl Strategy<Value = f64> {
    (from.ln()..to.ln()).prop_map(f64::exp)
}

/// Any bit pattern, and often enough one that a sensor could give.
pub fn any32() -> impl Strategy<Value = f32> {
    prop_oneof![2 => -100.0..100.0_f32, 1 => any::<u32>().prop_map(f32::from_bits)]
}

/// The same number of cases, from the same seed in every run.
pub fn seeded(cases: u32, seed: u64) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_seed: proptest::test_runner::RngSeed::Fixed(seed),
        ..ProptestConfig::with_cases(cases)
    }
}

/// Knuth's linear congruence: the same sequence in every run.
pub struct Random(pub u64);

impl Random {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.next()
    }
}

/// Reads back what was stored, and refuses it with one of these texts changed.
#[cfg(feature = "serde")]
pub fn reads_back<T>(value: &T, changed: &[(&str, &str)])
where
    T: serde::Serialize + serde::de::DeserializeOwned + PartialEq + std::fmt::Debug,
{
    let stored = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<T>(&stored).unwrap(), value);
    for (from, to) in changed {
        let bad = stored.replacen(from, to, 1);
        assert_ne!(bad, stored);
        assert!(serde_json::from_str::<T>(&bad).is_err(), "{bad}");
    }
}

/// Each of these configurations compiles as a static, and is what the run time makes.
#[allow(unused_macros)]
macro_rules! in_flash {
    ($float:ty: $($kind:ident::$make:ident($($x:expr),*)$(.$more:ident($y:expr))*;)+) => {$({
        static OWN: $kind<$float> =
            bowden::constant!($kind::<$float>::$make($($x),*)$(.$more($y))*);
        let made = $kind::<$float>::$make($($x),*)$(.and_then(|own| own.$more($y)))*;
        assert_eq!(Ok(OWN), made);
    })+};
}
#[allow(unused_imports)]
pub(crate) use in_flash;
