//! The time since the last usable sample.

use super::clamp;
use crate::Real;

/// The time since the last good sample, one sample of `dt` later.
///
/// The highest float means an unknown time (`dt` is negative, too long, or not finite): the
/// rate of a signal over this time is unknown.
pub(crate) fn gap_after<T: Real>(gap: T, dt: T, longest: T) -> T {
    if dt >= T::ZERO && dt <= longest {
        clamp(gap + dt, T::ZERO, T::HIGHEST)
    } else {
        T::HIGHEST
    }
}
