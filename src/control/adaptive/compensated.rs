//! A sum that keeps what rounding would drop.

use crate::signal::clamp;
use crate::Real;

/// A running sum with the part that the last addition lost to rounding (Kahan's sum).
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
        let sum = self.value + wanted;
        if !sum.is_finite() {
            return None;
        }
        let value = clamp(sum, low, high);
        let lost = wanted - (sum - self.value);
        // At an edge of the box nothing is owed; `sum - value` may overflow.
        let carry = if value == sum && lost.is_finite() {
            lost
        } else {
            T::zero()
        };
        Some(Self { value, carry })
    }
}
