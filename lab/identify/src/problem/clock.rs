//! The clock that measures a run.
//!
//! `std::time::Instant` panics on `wasm32-unknown-unknown`, which has no clock of its own. There the
//! host supplies one (`set_clock`); without it no time passes, so that no time limit ends a search.

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod source {
    use std::sync::OnceLock;
    use std::time::Instant;

    static BEGUN: OnceLock<Instant> = OnceLock::new();

    /// Seconds since the first call.
    pub(super) fn now() -> f64 {
        BEGUN.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
mod source {
    use std::sync::OnceLock;

    static CLOCK: OnceLock<fn() -> f64> = OnceLock::new();

    /// Seconds on the host's clock; 0 without one.
    pub(super) fn now() -> f64 {
        CLOCK.get().map_or(0.0, |clock| clock())
    }

    /// Sets the clock \[s\]. Only the first call has an effect.
    pub fn set_clock(clock: fn() -> f64) {
        let _ = CLOCK.set(clock);
    }
}

#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub use source::set_clock;

/// A moment on that clock.
#[derive(Debug, Clone, Copy)]
pub struct Moment(f64);

impl Moment {
    /// The present moment.
    #[must_use]
    pub fn now() -> Self {
        Self(source::now())
    }

    /// Time since an earlier moment \[s\].
    #[must_use]
    pub fn since(self, earlier: Self) -> f64 {
        (self.0 - earlier.0).max(0.0)
    }

    /// Time from this moment until now \[s\].
    #[must_use]
    pub fn elapsed(self) -> f64 {
        Self::now().since(self)
    }
}
