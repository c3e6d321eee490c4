//! The clock that measures a run.
//!
//! `std::time::Instant` panics on `wasm32-unknown-unknown`, which has no clock. There the host
//! supplies a clock (`set_clock`); without it no time passes, so no time limit ends a search.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod source {
    use std::sync::OnceLock;
    use std::time::{Duration, Instant};

    static BEGUN: OnceLock<Instant> = OnceLock::new();

    /// Time since the first call.
    pub(super) fn now() -> Duration {
        BEGUN.get_or_init(Instant::now).elapsed()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod source {
    use std::sync::OnceLock;
    use std::time::Duration;

    static CLOCK: OnceLock<fn() -> f64> = OnceLock::new();

    /// Time on the host's clock; zero without one.
    pub(super) fn now() -> Duration {
        let seconds = CLOCK.get().map_or(0.0, |clock| clock());
        Duration::try_from_secs_f64(seconds).unwrap_or_default()
    }

    /// Sets the clock \[s\]. Only the first call has an effect.
    pub fn set_clock(clock: fn() -> f64) {
        let _ = CLOCK.set(clock);
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use source::set_clock;

use std::time::Duration;

/// A moment on that clock.
#[derive(Debug, Clone, Copy)]
pub struct Moment(Duration);

impl Moment {
    /// The present moment.
    #[must_use]
    pub fn now() -> Self {
        Self(source::now())
    }

    /// Time since an earlier moment \[s\].
    #[must_use]
    pub fn since(self, earlier: Self) -> f64 {
        self.0.saturating_sub(earlier.0).as_secs_f64()
    }

    /// Time from this moment until now \[s\].
    #[must_use]
    pub fn elapsed(self) -> f64 {
        Self::now().since(self)
    }
}
