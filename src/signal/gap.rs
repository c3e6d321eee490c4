//! The time since a sample that could be used.

use super::clamp;
use crate::Real;

/// The time since the last good sample, one sample of `dt` later.
///
/// The highest float where that time is unknown (`dt` is negative, longer than the longest, or
/// not finite): a signal that has moved since has no rate then.
pub(crate) fn gap_after<T: Real>(gap: T, dt: T, longest: T) -> T {
    if dt >= T::ZERO && dt <= longest {
        clamp(gap + dt, T::ZERO, T::HIGHEST)
    } else {
        T::HIGHEST
    }
}
