//! The time since the last usable sample.

use super::clamp;
use crate::Real;

/// The time since the last good sample, after another sample of `dt`.
///
/// The highest float means an unknown time, because `dt` is negative, too long or not finite.
pub(crate) fn gap_after<T: Real>(gap: T, dt: T, longest: T) -> T {
    if dt >= T::ZERO && dt <= longest {
        clamp(gap + dt, T::ZERO, T::HIGHEST)
    } else {
        T::HIGHEST
    }
}
