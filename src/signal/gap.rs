//! The time since the last usable sample.

use super::clamp;
use crate::Real;

/// The time since the last good sample, after another sample of `dt`.
///
/// The highest float means an unknown time: `dt` is negative, too long or not finite, or the time is
/// so long that adding `dt` no longer changes it. In `f32`, this is after 2²⁴ samples.
pub(crate) fn gap_after<T: Real>(gap: T, dt: T, longest: T) -> T {
    let sum = gap + dt;
    if dt >= T::ZERO && dt <= longest && (sum != gap || dt == T::ZERO) {
        clamp(sum, T::ZERO, T::HIGHEST)
    } else {
        T::HIGHEST
    }
}
