//! The controllers: closed forms, windup, bad samples, bumpless changes, peers.

// Clippy's allowance covers the test functions, not what they share.
#![allow(clippy::unwrap_used)]

mod bad_samples;
mod bumpless;
mod compensator;
mod drive;
mod learning;
mod liveness;
mod observer;
mod options;
mod peers;
mod pid;
mod properties;
mod relay;
mod returns;
mod told;
mod windup;

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
