//! The tangent for the prewarping, as a `const fn`.

use core::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// `tan(π·frequency·T)/T` for `frequency·T` below 1/2. For a small product the result is
/// `π·frequency`.
///
/// The computation is in `f64` for every float. It does not call libm, because a `const fn` cannot.
/// A filter in flash is therefore equal to a filter made at run time.
pub(super) const fn slope(frequency: f64, sample_time: f64) -> f64 {
    let x = PI * (frequency * sample_time);
    if x <= FRAC_PI_4 {
        PI * frequency * (sine_over(x * x) / cosine(x * x))
    } else {
        let rest = FRAC_PI_2 - x;
        let square = rest * rest;
        cosine(square) / (rest * sine_over(square) * sample_time)
    }
}

/// `sin(x)/x` as a series in `x²`, for x up to π/4. The next term is below 1e-17.
const fn sine_over(square: f64) -> f64 {
    series(square, 1.0)
}

/// `cos(x)` as a series in `x²`, for x up to π/4.
const fn cosine(square: f64) -> f64 {
    series(square, -1.0)
}

/// `1 − square/(2·(2 + shift))·(1 − square/(4·(4 + shift))·(…))`
const fn series(square: f64, shift: f64) -> f64 {
    let mut sum = 1.0;
    let mut k = 8.0;
    while k > 0.0 {
        sum = 1.0 - square / (2.0 * k * (2.0 * k + shift)) * sum;
        k -= 1.0;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::slope;
    use core::f64::consts::PI;

    /// Near half the sample rate the tangent magnifies the rounding of its argument by
    /// `x·(1 + tan²)/tan`; elsewhere it is a few units in the last place.
    #[test]
    fn the_slope_is_the_tangent_over_the_sample_time() {
        for step in 1..1000_u32 {
            let (product, time) = (f64::from(step) / 2000.0, 0.00125);
            let x = PI * product;
            let expected = libm::tan(x) / time;
            let magnified = 1.0 + x * (x.tan() + 1.0 / x.tan());
            let error = (slope(product / time, time) - expected).abs() / expected;
            assert!(
                error <= 4.0 * f64::EPSILON * magnified,
                "{product}: {error:e}"
            );
        }
        assert_eq!(slope(1e-300, 1e-300), PI * 1e-300);
    }
}
