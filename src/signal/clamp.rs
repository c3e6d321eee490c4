//! Saturation that preserves NaN.

use crate::Real;

/// `x` within `[low, high]`; NaN stays NaN.
///
/// `x.max(low).min(high)` turns NaN into a limit, which looks like a valid command. If
/// `low > high`, `x` below `low` gives `low`; otherwise `x` above `high` gives `high`.
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

/// `x` clamped to `[low, high]`; for NaN the value there nearest to zero.
#[inline]
pub(crate) fn confined<T: Real>(x: T, low: T, high: T) -> T {
    let known = if x.is_nan() { T::ZERO } else { x };
    clamp(known, low, high)
}

/// The lesser of two numbers.
#[inline]
pub(crate) fn least<T: Real>(a: T, b: T) -> T {
    if b < a {
        b
    } else {
        a
    }
}

/// The greater of two numbers.
#[inline]
pub(crate) fn greatest<T: Real>(a: T, b: T) -> T {
    if b > a {
        b
    } else {
        a
    }
}

/// A difference on a circle of this period, along the shorter way round: within half a period.
#[inline]
pub(crate) fn wrapped<T: Real>(difference: T, period: T) -> T {
    // A float of 1.5/epsilon has no room for a fraction: the sum rounds to whole turns.
    let whole = T::from_f64(1.5) / T::epsilon();
    difference - period * ((difference / period + whole) - whole)
}
