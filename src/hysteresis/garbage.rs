//! The bounds of the step must not rest on the power function: here it lies.

use super::number::Number;
use super::path::follow;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A float whose exponential returns whatever the bits of its argument hash to.
#[derive(Debug, Clone, Copy)]
struct Lying(f32);

impl Add for Lying {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Sub for Lying {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(self.0 - other.0)
    }
}

impl Mul for Lying {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(self.0 * other.0)
    }
}

impl Div for Lying {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        Self(self.0 / other.0)
    }
}

impl Neg for Lying {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl Number for Lying {
    type Float = f32;
    fn constant(value: f32) -> Self {
        Self(value)
    }
    fn value(self) -> f32 {
        self.0
    }
    fn scale(self, by: f32) -> Self {
        Self(self.0 * by)
    }
    fn shift(self, by: f32) -> Self {
        Self(self.0 + by)
    }
    fn exp(self) -> Self {
        let bits = self.0.to_bits().wrapping_mul(2_654_435_769);
        Self(match bits % 5 {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => -3.0,
            // Any bit pattern, subnormals and more NaNs included.
            3 => f32::from_bits(bits),
            _ => libm::expf(self.0),
        })
    }
    fn ln(self) -> Self {
        Self(libm::logf(self.0))
    }
    fn sqrt(self) -> Self {
        Self(libm::sqrtf(self.0))
    }
}

#[test]
fn a_lying_power_function_cannot_push_the_state_out_or_back() {
    let mut bits = 1_u32;
    let mut uniform = || {
        bits = bits.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (bits >> 8) as f32 / (1 << 24) as f32
    };
    for _ in 0..30_000 {
        let zeta = 2.0 * uniform() - 1.0;
        // From 1e-8 to 1e2: below, at and above the saturating path.
        let p = libm::powf(10.0, 10.0 * uniform() - 8.0);
        let c = libm::powf(10.0, 8.0 * uniform() - 2.0);
        let n = 1.0 + 9.0 * uniform();
        let next = follow(Lying(zeta), Lying(p), Lying(c), Lying(n)).0;
        assert!(
            next >= zeta && next <= 1.0,
            "{zeta} went to {next} over {p}, c {c}, n {n}"
        );
    }
}
