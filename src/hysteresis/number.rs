//! Number type of the step: a float, or a float with four derivatives ([`Dual`]).
//!
//! With [`Dual`], the same code computes the exact derivatives of the step, including its branches.

use crate::real::calls;
use crate::real::sealed::Sealed;
use crate::Real;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A float or a dual number over it.
pub(super) trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    type Float: Real;
    /// A number without derivatives.
    fn constant(value: Self::Float) -> Self;
    /// The number without its derivatives.
    fn value(self) -> Self::Float;
    fn scale(self, by: Self::Float) -> Self;
    fn shift(self, by: Self::Float) -> Self;
    fn abs(self) -> Self;
    fn exp(self) -> Self;
    fn ln(self) -> Self;
    fn sqrt(self) -> Self;
    fn log2(self) -> Self;
    fn exp2(self) -> Self;
    /// Base-2 logarithm, linearly interpolated between the powers of 2.
    fn coarse_log2(self) -> Self;
    /// A power from the same interpolation.
    fn coarse_power(self, exponent: Self) -> Self;
}

impl<T: Real> Number for T {
    type Float = T;
    #[inline]
    fn constant(value: T) -> T {
        value
    }
    #[inline]
    fn value(self) -> T {
        self
    }
    #[inline]
    fn scale(self, by: T) -> T {
        self * by
    }
    #[inline]
    fn shift(self, by: T) -> T {
        self + by
    }
    calls! {
        abs() = num_traits::float::FloatCore::abs;
        exp() = Real::exp;
        ln() = Real::ln;
        sqrt() = Real::sqrt;
        log2() = Sealed::log2;
        exp2() = Sealed::exp2;
        coarse_log2() = Sealed::coarse_log2;
        coarse_power(exponent) = Sealed::coarse_power;
    }
}

/// A value and its derivatives with respect to rho, sigma, n and the initial state.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dual<T> {
    pub value: T,
    pub by: [T; 4],
}

impl<T: Real> Dual<T> {
    /// A function of two numbers, from its value and its two partial derivatives.
    #[inline]
    fn join(self, other: Self, value: T, by_self: T, by_other: T) -> Self {
        let ([a, b, c, d], [e, f, g, h]) = (self.by, other.by);
        let of = |own: T, others: T| own * by_self + others * by_other;
        Self {
            value,
            by: [of(a, e), of(b, f), of(c, g), of(d, h)],
        }
    }
    /// A function of this number, from its value and slope.
    #[inline]
    fn chain(self, value: T, slope: T) -> Self {
        let [a, b, c, d] = self.by;
        Self {
            value,
            by: [a * slope, b * slope, c * slope, d * slope],
        }
    }
}

/// The operators of two numbers, each from its value and its two partial derivatives.
macro_rules! operators {
    ($($operator:ident::$name:ident($a:ident, $b:ident) = $value:expr;)+) => {$(
        impl<T: Real> $operator for Dual<T> {
            type Output = Self;
            #[inline]
            fn $name(self, other: Self) -> Self {
                let ($a, $b) = (self.value, other.value);
                let (value, by_self, by_other) = $value;
                self.join(other, value, by_self, by_other)
            }
        }
    )+};
}
operators! {
    Add::add(a, b) = (a + b, T::one(), T::one());
    Sub::sub(a, b) = (a - b, T::one(), -T::one());
    Mul::mul(a, b) = (a * b, b, a);
    Div::div(a, b) = {
        let (value, inverse) = (a / b, T::one() / b);
        (value, inverse, -value * inverse)
    };
}

impl<T: Real> Neg for Dual<T> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        self.chain(-self.value, -T::one())
    }
}

impl<T: Real> Number for Dual<T> {
    type Float = T;
    #[inline]
    fn constant(value: T) -> Self {
        Self {
            value,
            by: [T::zero(); 4],
        }
    }
    #[inline]
    fn value(self) -> T {
        self.value
    }
    #[inline]
    fn scale(self, by: T) -> Self {
        self.chain(self.value * by, by)
    }
    #[inline]
    fn shift(self, by: T) -> Self {
        Self {
            value: self.value + by,
            by: self.by,
        }
    }
    #[inline]
    fn abs(self) -> Self {
        if self.value < T::zero() {
            -self
        } else {
            self
        }
    }
    #[inline]
    fn exp(self) -> Self {
        let value = Real::exp(self.value);
        self.chain(value, value)
    }
    #[inline]
    fn ln(self) -> Self {
        self.chain(Real::ln(self.value), T::one() / self.value)
    }
    #[inline]
    fn sqrt(self) -> Self {
        let value = Real::sqrt(self.value);
        self.chain(value, T::from_f64(0.5) / value)
    }
    #[inline]
    fn log2(self) -> Self {
        let slope = T::from_f64(core::f64::consts::LOG2_E) / self.value;
        self.chain(Sealed::log2(self.value), slope)
    }
    #[inline]
    fn exp2(self) -> Self {
        let value = Sealed::exp2(self.value);
        self.chain(value, value * T::from_f64(core::f64::consts::LN_2))
    }
    #[inline]
    fn coarse_log2(self) -> Self {
        let slope = T::one() / self.value.binade();
        self.chain(Sealed::coarse_log2(self.value), slope)
    }
    #[inline]
    fn coarse_power(self, exponent: Self) -> Self {
        let value = Sealed::coarse_power(self.value, exponent.value);
        // Along the straight line that holds each of the two.
        let (from, to) = (self.value.binade(), value.binade());
        let log = Sealed::coarse_log2(self.value);
        self.join(exponent, value, to * exponent.value / from, to * log)
    }
}
