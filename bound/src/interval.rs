//! Intervals and complex boxes, rounded outwards.

use crate::checked::{above_zero, finite};
use bowden::{Error, Real};
use core::ops::{Add, Mul, Sub};

/// An interval of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interval<T> {
    /// Lower end \[unit of the numbers\].
    pub low: T,
    /// Upper end \[unit of the numbers\].
    pub high: T,
}

impl<T: Copy> Interval<T> {
    /// The interval of one number.
    #[must_use]
    pub const fn exactly(x: T) -> Self {
        Self { low: x, high: x }
    }
}

impl<T: Real> Interval<T> {
    /// The interval between two values, in any order.
    ///
    /// ```
    /// use bowden_bound::Interval;
    /// assert_eq!(Interval::between(2.0, -1.0), Interval { low: -1.0, high: 2.0 });
    /// ```
    #[must_use]
    pub fn between(a: T, b: T) -> Self {
        if a < b {
            Self { low: a, high: b }
        } else {
            Self { low: b, high: a }
        }
    }

    /// Largest magnitude in the interval.
    #[must_use]
    pub fn magnitude(&self) -> T {
        self.max_distance_from(T::zero())
    }

    /// Largest distance between `point` and a number of the interval.
    #[must_use]
    pub fn max_distance_from(&self, point: T) -> T {
        let (low, high) = ((self.low - point).abs(), (self.high - point).abs());
        if low > high {
            low
        } else {
            high
        }
    }

    /// The lower end is not above the upper end, and both are finite.
    pub(super) fn ordered(&self, name: &'static str) -> Result<(), Error> {
        finite(self.low, name)?;
        if self.low > finite(self.high, name)? {
            return Err(Error::OutOfRange(name));
        }
        Ok(())
    }

    /// An ordered interval of positive numbers.
    pub(super) fn above_zero(&self, name: &'static str) -> Result<(), Error> {
        self.ordered(name)?;
        above_zero(self.low, name).map(drop)
    }
}

/// Upper bound on the relative error of an operation of two floats.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

/// An interval of floats, whose operations are rounded outwards.
pub(super) type Span = Interval<f64>;

impl Span {
    /// The interval of all numbers: nothing is known.
    const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// The interval between two numbers in either order, widened by the rounding error of each
    /// number.
    pub(super) fn outward(a: f64, b: f64) -> Self {
        if a.is_nan() || b.is_nan() {
            return Self::ALL;
        }
        let (low, high) = if a < b { (a, b) } else { (b, a) };
        Self {
            low: low - (ROUNDING * low.abs() + f64::MIN_POSITIVE),
            high: high + (ROUNDING * high.abs() + f64::MIN_POSITIVE),
        }
    }

    pub(super) fn middle(self) -> f64 {
        0.5 * self.low + 0.5 * self.high
    }

    pub(super) fn width(self) -> f64 {
        self.high - self.low
    }

    /// A quotient by zero: the interval of all numbers.
    pub(super) fn recip(self) -> Self {
        if self.low > 0.0 || self.high < 0.0 {
            return Self::outward(self.low.recip(), self.high.recip());
        }
        Self::ALL
    }

    /// The squares, which are not negative.
    pub(super) fn square(self) -> Self {
        let all = Self::outward(self.low * self.low, self.high * self.high);
        let has_zero = self.low <= 0.0 && self.high >= 0.0;
        let low = if has_zero { 0.0 } else { all.low.max(0.0) };
        Self { low, ..all }
    }

    /// The intersection with another interval.
    pub(super) fn meets(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Self { low, high })
    }

    /// The numbers at a fraction of the path from these to others.
    pub(super) fn towards(self, other: Self, part: Self) -> Self {
        self + (other - self) * part
    }

    /// Two halves.
    pub(super) fn halves(self) -> [Self; 2] {
        let (low, high) = (self.middle(), self.middle());
        [Self { high, ..self }, Self { low, ..self }]
    }
}

impl Add for Span {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::outward(self.low + other.low, self.high + other.high)
    }
}

impl Sub for Span {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self::outward(self.low - other.high, self.high - other.low)
    }
}

impl Mul for Span {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let corners = [
            self.low * other.low,
            self.low * other.high,
            self.high * other.low,
            self.high * other.high,
        ];
        let least = corners.iter().fold(f64::INFINITY, |m, x| m.min(*x));
        let most = corners.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x));
        // `min` would ignore a NaN.
        match corners.iter().any(|x| x.is_nan()) {
            true => Self::ALL,
            false => Self::outward(least, most),
        }
    }
}

/// A box in the complex plane.
#[derive(Clone, Copy)]
pub(super) struct Plane {
    pub(super) re: Span,
    pub(super) im: Span,
}

impl Plane {
    pub(super) const fn new(re: Span, im: Span) -> Self {
        Self { re, im }
    }

    pub(super) fn times(self, factor: Span) -> Self {
        Self::new(self.re * factor, self.im * factor)
    }

    /// The product with j and a real number.
    pub(super) fn turned(self, factor: Span) -> Self {
        Self::new(self.im * Span::exactly(-1.0), self.re).times(factor)
    }

    /// e^(−j·phase).
    ///
    /// Assumption: libm's sine and cosine have an error of less than 1e-12.
    pub(super) fn late(phase: Span) -> Self {
        let (middle, reach) = (phase.middle(), 0.5 * phase.width() + 1e-12);
        let around = |x: f64| {
            let all = Span::outward(x - reach, x + reach);
            Span {
                low: all.low.max(-1.0),
                high: all.high.min(1.0),
            }
        };
        Self::new(around(libm::cos(middle)), around(-libm::sin(middle)))
    }

    /// Whether the box lies on one side of a line through zero. The line is perpendicular to the
    /// direction of the middle of the box, or it is an axis.
    pub(super) fn is_off_zero(self) -> bool {
        let (re, im) = (self.re.middle(), -self.im.middle());
        let towards = Self::new(Span::exactly(re), Span::exactly(im));
        let one_side = |span: Span| span.low > 0.0 || span.high < 0.0;
        one_side(self.re) || one_side(self.im) || (self * towards).re.low > 0.0
    }
}

impl Add for Plane {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self::new(self.re + other.re, self.im + other.im)
    }
}

impl Mul for Plane {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self::new(
            self.re * other.re - self.im * other.im,
            self.re * other.im + self.im * other.re,
        )
    }
}
