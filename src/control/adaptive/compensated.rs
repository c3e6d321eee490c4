//! A sum that keeps what rounding would drop.

use crate::signal::clamp;
use crate::Real;

/// A running sum with the part that the last addition lost to rounding.
///
/// Estimates and the accumulated error move by `h` times something small each sample.
/// In f32 an increment below half an ulp of the sum would vanish, for ever: a leakage of
/// 0.001/s at 20 kHz moves an estimate by 5e-8 of itself, and f32 has 6e-8.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Compensated<T> {
    pub(crate) value: T,
    pub(crate) carry: T,
}

impl<T: Real> Compensated<T> {
    pub(crate) fn new(value: T) -> Self {
        Self {
            value,
            carry: T::zero(),
        }
    }

    /// The sum after `increment`, within `[low, high]`.
    ///
    /// `None` where it is not finite before it is clamped: an overflow, or NaN.
    #[inline]
    pub(crate) fn add(self, increment: T, low: T, high: T) -> Option<Self> {
        let wanted = increment + self.carry;
        let (sum, lost) = two_sum(self.value, wanted);
        if !sum.is_finite() {
            return None;
        }
        let value = clamp(sum, low, high);
        // At an edge of the box nothing is owed; the way to `lost` may overflow.
        let carry = if value == sum && lost.is_finite() {
            lost
        } else {
            T::zero()
        };
        Some(Self { value, carry })
    }
}

/// A sum and what rounding lost of it: exactly that, also where the second number is the
/// larger one (D. Knuth, *The Art of Computer Programming*, vol. 2, 4.2.2, Theorem B).
#[inline]
pub(crate) fn two_sum<T: Real>(a: T, b: T) -> (T, T) {
    let sum = a + b;
    let moved = sum - a;
    (sum, (a - (sum - moved)) + (b - moved))
}

#[cfg(test)]
mod tests {
    use super::two_sum;
    use proptest::prelude::*;

    proptest! {
        /// What `two_sum` says was lost, f64 finds too: between these exponents it holds the
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
