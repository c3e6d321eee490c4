//! Sine and cosine for `f32`, computed in single precision only. A microcontroller with a
//! single-precision floating-point unit computes double precision in software.
//!
//! The angle is reduced exactly, in integer arithmetic, with the bits of 2/pi that its exponent
//! selects. The error is therefore at most 1.6 units in the last place at every finite argument.
//! `cargo test --test exhaustive -- --ignored` checks this bound at all arguments up to 1e4, and at
//! every sixteenth larger argument.
//!
//! Source: M. H. Payne, R. N. Hanek, "Radian reduction for trigonometric functions",
//! *SIGNUM Newsletter* 18(1), 1983.

use core::f32::consts::FRAC_PI_4;

/// The bits of 2/pi after the binary point, preceded by 32 zeros.
const TWO_OVER_PI: [u32; 8] = [
    0x0000_0000,
    0xa2f9_836e,
    0x4e44_1529,
    0xfc27_57d1,
    0xf534_ddc0,
    0xdb62_9599,
    0x3c43_9041,
    0xfe51_63ab,
];
/// pi/4 in units of 2^-32.
const QUARTER: i64 = 0xc90f_daa2;
const MANTISSA: u32 = 23;
/// The exponent bits of 1.
const BIAS: u32 = 127;

/// Sine of an angle in radians; NaN for NaN and infinities.
#[inline]
pub(super) fn sin(x: f32) -> f32 {
    let (quadrant, rest) = reduce(x);
    at_quadrant(quadrant, rest)
}

/// Cosine of an angle in radians; NaN for NaN and infinities.
#[inline]
pub(super) fn cos(x: f32) -> f32 {
    let (quadrant, rest) = reduce(x);
    at_quadrant(quadrant.wrapping_add(1), rest)
}

/// `sin(quadrant·pi/2 + rest)`, with `rest` within ±pi/4.
#[inline]
fn at_quadrant(quadrant: u32, rest: f32) -> f32 {
    let square = rest * rest;
    let value = if quadrant & 1 == 0 {
        let series = square * (0.008_332_178 - 0.000_195_172_34 * square);
        rest + rest * square * (series - 0.166_666_55)
    } else {
        let series =
            square * (0.041_666_646 + square * (0.000_024_438_38 * square - 0.001_388_736_7));
        1.0 + square * (series - 0.5)
    };
    if quadrant & 2 == 0 {
        value
    } else {
        -value
    }
}

/// The nearest multiple of pi/2, modulo 4, and the residual angle.
fn reduce(x: f32) -> (u32, f32) {
    let size = f32::from_bits(x.to_bits() & 0x7fff_ffff);
    if size <= FRAC_PI_4 {
        return (0, x);
    }
    if !x.is_finite() {
        return (0, f32::NAN);
    }
    // |x| = mantissa·2^(exponent - 150), and 2/pi from the bit that counts four turns of pi/2.
    let exponent = size.to_bits() >> MANTISSA;
    let mantissa = u64::from(size.to_bits() & 0x007f_ffff | 0x0080_0000);
    let from = exponent.wrapping_sub(BIAS - 7);
    let word = |index: u32| {
        let place = |at: u32| TWO_OVER_PI[(at & 7) as usize];
        let at = (from >> 5).wrapping_add(index);
        let shift = from & 31;
        u64::from(place(at) << shift | place(at.wrapping_add(1)) >> 1 >> (31 - shift))
    };
    // In units of 2^-62 quarter turns; what overflows is whole turns.
    let turns = (mantissa.wrapping_mul(word(0)) << 32)
        .wrapping_add(mantissa.wrapping_mul(word(1)))
        .wrapping_add(mantissa.wrapping_mul(word(2)) >> 32);
    let quadrant = (turns.wrapping_add(1 << 61) >> 62) as u32;
    let rest = turns.wrapping_sub(u64::from(quadrant) << 62) as i64;
    // The 31 leading bits of the rest, times pi/4: one rounding.
    let zeros = rest.unsigned_abs().leading_zeros();
    let leading = (rest << (zeros.saturating_sub(1) & 63)) >> 32;
    let product = ((leading * QUARTER) >> 32) as i32;
    let scale = f32::from_bits((BIAS + 1 - 30).wrapping_sub(zeros.saturating_sub(1)) << MANTISSA);
    let angle = product as f32 * scale;
    if x < 0.0 {
        (quadrant.wrapping_neg(), -angle)
    } else {
        (quadrant, angle)
    }
}
