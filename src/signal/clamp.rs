//! Saturation that preserves NaN.

use crate::Real;

/// Clamps `x` to `[low, high]`. NaN stays NaN.
///
/// If `low > high`, the result is `low` for `x < low` and `high` for all other x.
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

/// Clamps `x` to `[low, high]`. For NaN, the result is the value in this range nearest to zero.
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

/// A difference on a circle with this period, along the shorter arc: at most half a period.
#[inline]
pub(crate) fn wrapped<T: Real>(difference: T, period: T) -> T {
    // A float of 1.5/epsilon has no room for a fraction: the sum rounds to whole turns.
    let whole = T::from_f64(1.5) / T::epsilon();
    difference - period * ((difference / period + whole) - whole)
}
