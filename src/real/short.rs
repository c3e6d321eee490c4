//! Elementary functions for `f32` with few instructions, for a control loop.
//!
//! The base-2 logarithm and exponential take about 20 instructions each on a Cortex-M4F, with at
//! most one division and no table. The hysteresis uses them to compute its powers. The bound |eta|
//! <= 1 holds for any power function.
//!
//! | function | arguments | largest error |
//! |---|---|---|
//! | [`log2`] | every positive normal number | 3.7e-7 of the result |
//! | [`exp2`] | -126 to 127 | 2.9e-7 of the result |
//! | [`coarse_log2`] | every positive normal number | 0.0861 |
//! | [`coarse_power`] | 0 to 1 to the power of 0 to 30 | 0.112 |
//! | [`exp`] | -87 to 88 | 8e-8·abs(x) + 3e-7 of the result |
//! | [`tanh`] | all | 4e-7 of the result |
//!
//! `cargo test --test exhaustive -- --ignored` checks the errors in this table at all arguments,
//! and the error of the power at every eighth argument. For an argument outside these ranges, the
//! result is arbitrary.

use core::f32::consts::{LN_2, LOG2_E};

/// The bits of 1.
const ONE: i32 = 0x3f80_0000;
/// The bits of sqrt(1/2), the smallest mantissa, so that the logarithm has no jump at 1.
const LEAST: i32 = 0x3f35_04f3;
/// Bits of a mantissa.
const MANTISSA: u32 = 23;
/// 1.5·2²³: in the sum with a number within ±2²², the low bits are the nearest integer.
const ROUND: f32 = 12_582_912.0;

/// Base-2 logarithm of a positive normal number.
///
/// `x = 2^k·m` with `m` in `[sqrt(1/2), sqrt(2))`. An odd series of `(m - 1)/(m + 1)` gives
/// `log2(m)`, with a small relative error near 1 as well.
#[inline]
pub(super) fn log2(x: f32) -> f32 {
    let bits = x.to_bits() as i32;
    let exponent = bits.wrapping_sub(LEAST) >> MANTISSA;
    let mantissa = f32::from_bits(bits.wrapping_sub(exponent << MANTISSA) as u32);
    let s = (mantissa - 1.0) / (mantissa + 1.0);
    let square = s * s;
    let series = 2.885_390_4 + square * (0.961_588_9 + square * 0.595_759_6);
    exponent as f32 + s * series
}

/// 2 to the power of `y`; the value at -126 for `y` below -126.
///
/// The nearest integer goes into the exponent. A polynomial that is 1 at zero computes the power of
/// the remainder.
#[inline]
pub(super) fn exp2(y: f32) -> f32 {
    let y = if y > -126.0 { y } else { -126.0 };
    let rounded = y + ROUND;
    let rest = y - (rounded - ROUND);
    let series = 1.0
        + rest
            * (LN_2
                + rest
                    * (0.240_223_5
                        + rest * (0.055_503_81 + rest * (0.009_666_368 + rest * 0.001_338_130_3))));
    // The low bits of `rounded` are the integer; the others are shifted out.
    let exponent = rounded.to_bits() << MANTISSA;
    f32::from_bits(series.to_bits().wrapping_add(exponent))
}

/// e to the power of `x`; the value at 88 for `x` above 88 and for NaN.
#[inline]
pub(super) fn exp(x: f32) -> f32 {
    let x = if x < 88.0 { x } else { 88.0 };
    exp2(x * LOG2_E)
}

/// A non-negative number to a positive power.
#[inline]
pub(super) fn pow(x: f32, exponent: f32) -> f32 {
    if x > 0.0 {
        let y = exponent * log2(x);
        exp2(if y < 127.0 { y } else { 127.0 })
    } else {
        0.0
    }
}

/// Hyperbolic tangent, by its series if |x| is below 0.3, otherwise by the exponential.
#[inline]
pub(super) fn tanh(x: f32) -> f32 {
    let size = f32::from_bits(x.to_bits() & 0x7fff_ffff);
    if size < 0.3 {
        let square = x * x;
        let series = square * (0.133_333_33 + square * (-0.053_968_254 + square * 0.021_869_488));
        return x + x * square * (series - 0.333_333_33);
    }
    let value = 1.0 - 2.0 / (exp(2.0 * size) + 1.0);
    f32::from_bits(value.to_bits() | (x.to_bits() & 0x8000_0000))
}

/// Base-2 logarithm, linear between the powers of 2.
#[inline]
pub(super) fn coarse_log2(x: f32) -> f32 {
    (x.to_bits() as i32).wrapping_sub(ONE) as f32 * (1.0 / 8_388_608.0)
}

/// `x` to the power of `exponent`, linear between the powers of 2. The result is 1 if the exponent
/// is 0, and `x` up to a rounding error if the exponent is 1. A result that would be below 2^-127
/// is not positive.
#[inline]
pub(super) fn coarse_power(x: f32, exponent: f32) -> f32 {
    let log = (x.to_bits() as i32).wrapping_sub(ONE) as f32;
    f32::from_bits(((exponent * log) as i32).wrapping_add(ONE) as u32)
}
