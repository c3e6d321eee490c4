//! Signal conditioning: filters, rates, ramps and checks of sensors.
#![allow(clippy::unwrap_used, clippy::cast_possible_truncation)]

mod arrives;
mod basics;
mod constants;
mod edges;
mod filters;
mod plausible;
mod rates;

use proptest::prelude::*;

/// Any bit pattern, and often enough one that a sensor could give.
fn any_float() -> impl Strategy<Value = f32> {
    prop_oneof![
        3 => -5.0..5.0_f32,
        3 => Just(0.001_f32),
        2 => any::<u32>().prop_map(f32::from_bits)
    ]
}

/// Reads back what was stored, and refuses it with one of these texts changed.
#[cfg(feature = "serde")]
fn reads_back<T>(value: &T, changed: &[(&str, &str)])
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
