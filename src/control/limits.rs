//! Limits of a command: a range and an optional slew-rate limit.

use crate::error::{above_zero, ordered};
use crate::signal::{clamp, confined};
use crate::{Error, Real};

crate::checked::stored! {
    /// Range \[command unit\] and slew-rate limit \[command unit/s\] of a command.
    ///
    /// The range need not be symmetric. In the serialised form, a missing `slew` means no slew-rate
    /// limit.
    ///
    /// ```
    /// use bowden::control::Limits;
    /// let limits = Limits::try_new(-5.0, 20.0)?.with_slew(1000.0)?;
    /// assert_eq!(limits.apply(0.0, 9.0, 0.001), 1.0); // 1000/s for 1 ms
    /// assert_eq!(limits.apply(19.5, 90.0, 0.001), 20.0);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct Limits<T> {
        low: T,
        high: T,
        slew: Option<T>,
    }
    => {
        let limits = Self::try_new(low, high)?;
        slew.map_or(Ok(limits), |slew| limits.with_slew(slew))
    }
}

crate::checked! {
    Limits<T>;

    /// The range `low..=high` \[command unit\], without a slew-rate limit.
    ///
    /// # Errors
    /// [`Error::NonFinite`] with `"low"` or `"high"`; [`Error::Inadmissible`] unless
    /// `low < high`.
    pub fn try_new(low: T, high: T) {
        ordered!(low, high);
        let slew = None;
        Ok(Limits { low, high, slew })
    }

    /// Sets the slew-rate limit \[command unit/s\], which must be positive.
    ///
    /// A slew-rate limit below `2·k_p·noise·rate` also limits the response to noise. The loop may
    /// then oscillate. Here, `noise` is the largest change in the measured output between two
    /// samples, and `rate` is the sampling rate \[Hz\]. Choose a higher slew-rate limit or a
    /// smaller gain.
    ///
    /// In `f32`, the spacing of neighbouring floats is up to 1.2e-7 of the command. If `slew·dt` is
    /// smaller than this spacing, a sample moves the command by one spacing or not at all.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"slew"`.
    pub fn with_slew[self limits](slew: T) {
        above_zero!(slew, "slew");
        let slew = Some(slew);
        Ok(Limits { slew, ..limits })
    }
}

impl<T: Real> Limits<T> {
    /// The range of all finite commands, for simulation only.
    pub const fn unlimited() -> Self {
        Self {
            low: T::LOWEST,
            high: T::HIGHEST,
            slew: None,
        }
    }

    /// Lower limit of the command \[command unit\].
    pub const fn low(&self) -> T {
        self.low
    }

    /// Upper limit of the command \[command unit\].
    pub const fn high(&self) -> T {
        self.high
    }

    /// Slew-rate limit \[command unit/s\], if there is one.
    pub const fn slew(&self) -> Option<T> {
        self.slew
    }

    /// Whether a command lies within the range.
    #[must_use]
    pub fn contains(&self, command: T) -> bool {
        self.low <= command && command <= self.high
    }

    /// The command nearest to `wanted` that is reachable from `last` within `dt` \[s\].
    ///
    /// The result lies within the range, even if `last` does not, and within `slew·dt` of `last` if
    /// the range permits. If `wanted` is NaN, the result is NaN. If `last` is NaN, the slew-rate
    /// limit has no effect.
    #[inline]
    #[must_use]
    pub fn apply(&self, last: T, wanted: T, dt: T) -> T {
        let reachable = match self.slew {
            Some(slew) => {
                let (low, high) = around(last, slew * dt);
                clamp(wanted, low, high)
            }
            None => wanted,
        };
        clamp(reachable, self.low, self.high)
    }

    /// The value within the range that is nearest to `command`. For NaN, it is the value nearest to
    /// zero.
    #[inline]
    #[must_use]
    pub fn clamp(&self, command: T) -> T {
        confined(command, self.low, self.high)
    }
}

/// The interval that is reachable from `last` within `reach`.
#[inline]
pub(crate) fn around<T: Real>(last: T, reach: T) -> (T, T) {
    (last - reach, last + reach)
}
