//! Saturation that keeps NaN visible.

use crate::Real;

/// `x` within `[low, high]`; NaN stays NaN.
///
/// `x.max(low).min(high)` turns NaN into a limit, a command that looks valid.
/// Where `low > high`, `x` below `low` gives `low`, else `x` above `high` gives `high`.
///
/// ```
/// use bowden::signal::clamp;
/// assert_eq!(clamp(3.0, -1.0, 1.0), 1.0);
/// assert_eq!(clamp(f32::NEG_INFINITY, -1.0, 1.0), -1.0);
/// assert!(clamp(f64::NAN, -1.0, 1.0).is_nan());
/// ```
#[inline]
#[must_use]
pub fn clamp<T: Real>(x: T, low: T, high: T) -> T {
    if x < low {
        low
    } else if x > high {
        high
    } else {
        x
    }
}

/// `x` within `[low, high]`, and what is nearest to zero there for NaN.
#[inline]
pub(crate) fn confined<T: Real>(x: T, low: T, high: T) -> T {
    let known = if x.is_nan() { T::ZERO } else { x };
    clamp(known, low, high)
}
