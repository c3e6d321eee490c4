//! Numbers for proofs: integers times a power of two, and intervals of them.

use super::Interval;
use bowden::Real;
use core::cmp::Ordering;
use core::fmt;
use core::ops::{Add, Div, Mul, Sub};

/// Bits of a mantissa: a product of two fits into an `i128`.
const BITS: u32 = 62;

/// Number of bits by which the larger summand is shifted up before the smaller summand is cut.
const HEADROOM: i32 = 60;

/// Rounding direction of an operation.
#[derive(Clone, Copy, PartialEq)]
enum Towards {
    Below,
    Above,
}

/// `mantissa·2^exponent`, with at most 62 bits of mantissa.
///
/// This type represents every finite float exactly. The text form, such as `13*2^-4`, is also
/// exact.
///
/// ```
/// use bowden_bound::Dyadic;
/// assert_eq!(Dyadic::of(0.8125_f32).to_string(), "13*2^-4");
/// assert_eq!(Dyadic::of(0.8125).as_f64(), 0.8125);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Dyadic {
    mantissa: i128,
    exponent: i32,
}

impl Dyadic {
    /// A number larger than every number in a proof.
    const HUGE: Self = Self::power(1 << 20);

    const ZERO: Self = Self {
        mantissa: 0,
        exponent: 0,
    };

    /// The exact value of a finite float, or zero for a float that is not finite.
    #[must_use]
    pub fn of<T: Real>(x: T) -> Self {
        if !x.is_finite() {
            return Self::ZERO;
        }
        let (mantissa, exponent, sign) = x.integer_decode();
        Self::exactly(i128::from(mantissa) * i128::from(sign), i32::from(exponent))
    }

    /// `2^exponent`.
    pub(super) const fn power(exponent: i32) -> Self {
        Self {
            mantissa: 1,
            exponent,
        }
    }

    /// The number without trailing zeros, so that equal numbers have equal representations.
    fn exactly(mantissa: i128, exponent: i32) -> Self {
        if mantissa == 0 {
            return Self::ZERO;
        }
        let zeros = mantissa.trailing_zeros();
        Self {
            mantissa: mantissa >> zeros,
            exponent: exponent.saturating_add_unsigned(zeros),
        }
    }

    /// The number with at most `bits` bits of mantissa, rounded.
    fn cut(mantissa: i128, exponent: i32, bits: u32, to: Towards) -> Self {
        let length = i128::BITS - mantissa.unsigned_abs().leading_zeros();
        let over = length.saturating_sub(bits);
        let kept = shifted_down(mantissa, over, to);
        Self::exactly(kept, exponent.saturating_add_unsigned(over))
    }

    /// The smallest number with at most `bits` bits that is not below this one.
    #[must_use]
    pub fn shortened(self, bits: u32) -> Self {
        Self::cut(self.mantissa, self.exponent, bits, Towards::Above)
    }

    const fn negated(self) -> Self {
        Self {
            mantissa: -self.mantissa,
            ..self
        }
    }

    fn plus(self, other: Self, to: Towards) -> Self {
        if self.mantissa == 0 {
            return other;
        }
        if other.mantissa == 0 {
            return self;
        }
        let (high, low) = if self.exponent >= other.exponent {
            (self, other)
        } else {
            (other, self)
        };
        let apart = high.exponent.saturating_sub(low.exponent);
        let up = apart.min(HEADROOM);
        let down = apart.saturating_sub(up).unsigned_abs();
        let sum = (high.mantissa << up) + shifted_down(low.mantissa, down, to);
        Self::cut(sum, high.exponent.saturating_sub(up), BITS, to)
    }

    fn times(self, other: Self, to: Towards) -> Self {
        let exponent = self.exponent.saturating_add(other.exponent);
        Self::cut(self.mantissa * other.mantissa, exponent, BITS, to)
    }

    /// The quotient by a positive number.
    fn over(self, divisor: Self, to: Towards) -> Self {
        // The dividend is as long as it can be, so that the quotient has 62 bits.
        let zeros = self.mantissa.unsigned_abs().leading_zeros();
        let up = zeros.saturating_sub(2).min(i128::BITS - 3);
        let dividend = self.mantissa << up;
        let exponent = self.exponent.saturating_sub(divisor.exponent);
        let exponent = exponent.saturating_sub_unsigned(up);
        let Some(below) = dividend.checked_div_euclid(divisor.mantissa) else {
            return Self::HUGE;
        };
        let inexact = below * divisor.mantissa != dividend;
        let quotient = below + i128::from(inexact && to == Towards::Above);
        Self::cut(quotient, exponent, BITS, to)
    }

    /// The nearest `f64`, or a neighbour of the nearest.
    #[must_use]
    #[allow(clippy::cast_precision_loss)] // 62 bits into 53: next to the nearest
    pub fn as_f64(self) -> f64 {
        libm::scalbn(self.mantissa as f64, self.exponent)
    }

    /// The number as `mantissa·2^exponent`.
    #[must_use]
    pub const fn parts(self) -> (i128, i32) {
        (self.mantissa, self.exponent)
    }
}

/// `mantissa/2^by`, rounded.
fn shifted_down(mantissa: i128, by: u32, to: Towards) -> i128 {
    let by = by.min(i128::BITS - 1);
    let below = mantissa >> by;
    let inexact = (below << by) != mantissa;
    below + i128::from(inexact && to == Towards::Above)
}

impl fmt::Display for Dyadic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}*2^{}", self.mantissa, self.exponent)
    }
}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Self) -> Ordering {
        if self.mantissa == 0 || other.mantissa == 0 {
            return self.mantissa.cmp(&other.mantissa);
        }
        // Exactly: a difference that is rounded may be zero where the numbers are not equal.
        let apart = self.exponent.saturating_sub(other.exponent);
        let up = apart.unsigned_abs();
        if up > BITS {
            // A mantissa has fewer bits than the exponents are apart.
            return match apart > 0 {
                true => self.mantissa.cmp(&0),
                false => 0.cmp(&other.mantissa),
            };
        }
        match apart > 0 {
            true => (self.mantissa << up).cmp(&other.mantissa),
            false => self.mantissa.cmp(&(other.mantissa << up)),
        }
    }
}

/// An interval of exact numbers, rounded outwards so that it contains the exact result of each
/// operation.
///
/// A quotient by an interval that contains zero is the interval of all numbers. A comparison
/// ([`is_at_most`](Self::is_at_most)) is true only if it holds for all numbers in both intervals.
///
/// ```
/// use bowden_bound::Enclosure;
/// let third = Enclosure::of(1.0) / Enclosure::of(3.0);
/// assert!(third.low < third.high);
/// assert!(third.is_at_most(Enclosure::of(0.333_333_333_333_333_4)));
/// ```
pub type Enclosure = Interval<Dyadic>;

impl Enclosure {
    pub(super) const ZERO: Self = Self::exactly(Dyadic::ZERO);
    pub(super) const ONE: Self = Self::exactly(Dyadic::power(0));
    const EVERYTHING: Self = Self {
        low: Dyadic::HUGE.negated(),
        high: Dyadic::HUGE,
    };

    /// The exact value of a finite float.
    #[must_use]
    pub fn of<T: Real>(x: T) -> Self {
        Self::exactly(Dyadic::of(x))
    }

    /// `2^exponent`.
    pub(super) const fn power(exponent: i32) -> Self {
        Self::exactly(Dyadic::power(exponent))
    }

    /// Whether this number is certainly not greater than the other.
    #[must_use]
    pub fn is_at_most(&self, other: Self) -> bool {
        self.high <= other.low
    }

    /// The magnitude.
    #[must_use]
    pub fn abs(self) -> Self {
        self.max(Self::ZERO - self).max(Self::ZERO)
    }

    /// The greater of two numbers.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self {
            low: self.low.max(other.low),
            high: self.high.max(other.high),
        }
    }
}

impl Add for Enclosure {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            low: self.low.plus(other.low, Towards::Below),
            high: self.high.plus(other.high, Towards::Above),
        }
    }
}

impl Sub for Enclosure {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self {
            low: self.low.plus(other.high.negated(), Towards::Below),
            high: self.high.plus(other.low.negated(), Towards::Above),
        }
    }
}

impl Mul for Enclosure {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let corner = |to| {
            [
                self.low.times(other.low, to),
                self.low.times(other.high, to),
                self.high.times(other.low, to),
                self.high.times(other.high, to),
            ]
        };
        let [a, b, c, d] = corner(Towards::Below);
        let low = a.min(b).min(c.min(d));
        let [a, b, c, d] = corner(Towards::Above);
        let high = a.max(b).max(c.max(d));
        Self { low, high }
    }
}

impl Div for Enclosure {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        if other.high.mantissa < 0 {
            return Self::ZERO - self / (Self::ZERO - other);
        }
        if other.low.mantissa <= 0 {
            return Self::EVERYTHING;
        }
        let low = self.low.over(other.low, Towards::Below);
        let low = low.min(self.low.over(other.high, Towards::Below));
        let high = self.high.over(other.low, Towards::Above);
        let high = high.max(self.high.over(other.high, Towards::Above));
        Self { low, high }
    }
}
