//! Compensated summation.

use super::clamp;
use crate::error::rarely;
use crate::Real;

crate::checked::stored! {
    /// A running sum with the rounding error of its last addition.
    ///
    /// Integrals and estimates change by a small increment in each sample. In an `f32` sum, an
    /// increment below half an ulp of the sum would have no effect. For example, a leakage of
    /// 0.001/s at 20 kHz changes an estimate by the fraction 5e-8, but the resolution of `f32` is
    /// 6e-8.
    #[derive(Default)]
    pub(crate) struct Compensated<T> {
        /// The sum.
        pub(crate) value: T,
        /// The carry (rounding error), which is added together with the next increment.
        pub(crate) carry: T,
    }
    => {
        Ok(Self { value, carry })
    }
}

impl<T: Real> Compensated<T> {
    /// A sum with a carry of zero.
    pub(crate) const fn new(value: T) -> Self {
        Self {
            value,
            carry: T::ZERO,
        }
    }

    /// The sum after `increment`. If the sum is finite, the carry may still be NaN.
    #[inline]
    #[must_use]
    pub(crate) fn plus(self, increment: T) -> Self {
        let (value, carry) = two_sum(self.value, increment + self.carry);
        Self { value, carry }
    }

    /// The sum, clamped to `[low, high]`. At a limit, the carry is zero.
    ///
    /// The carry of a sum that overflowed is NaN, and stays NaN.
    #[inline]
    pub(crate) fn within(self, low: T, high: T) -> Self {
        if low <= self.value && self.value <= high {
            return self;
        }
        rarely();
        Self {
            value: clamp(self.value, low, high),
            // Zero, or NaN of a carry that is not finite.
            carry: self.carry * T::ZERO,
        }
    }
}

/// A sum and its exact rounding error, whatever the order of the magnitudes (D. Knuth, *The Art of
/// Computer Programming*, vol. 2, 4.2.2, Theorem B).
#[inline]
pub(crate) fn two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let moved = sum - a;
    (sum, (a - (sum - moved)) + (b - moved))
}

#[cfg(test)]
mod tests {
    use super::{two_sum, Compensated};
    use proptest::prelude::*;

    #[test]
    fn a_million_small_increments_are_kept() {
        let (mut plain, mut sum) = (1.0_f32, Compensated::new(1.0_f32));
        for _ in 0..1_000_000 {
            plain += 1e-8;
            sum = sum.plus(1e-8);
        }
        assert_eq!(plain, 1.0);
        assert!((sum.value - 1.01).abs() < 1e-6);
    }

    proptest! {
        /// f64 gives the same rounding error as `two_sum`: between these exponents it holds the
        /// sum of two f32 without rounding.
        #[test]
        fn what_a_sum_loses_is_exact(
            a in -1000.0_f32..1000.0, b in -1000.0_f32..1000.0, down in 0_i32..12, swap: bool
        ) {
            let b = b * 2.0_f32.powi(-down);
            let (a, b) = if swap { (b, a) } else { (a, b) };
            prop_assume!(a.abs() > 1e-3 && b.abs() > 1e-3);
            let (sum, lost) = two_sum(a, b);
            prop_assert_eq!(f64::from(sum) + f64::from(lost), f64::from(a) + f64::from(b));
            prop_assert_eq!(sum + lost, sum);
        }
    }
}
