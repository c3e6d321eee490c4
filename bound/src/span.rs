//! Intervals and complex boxes, rounded outwards.

use core::ops::{Add, Mul, Sub};

/// An interval of numbers.
#[derive(Clone, Copy)]
pub(super) struct Span {
    pub(super) low: f64,
    pub(super) high: f64,
}

/// Upper bound on the relative error of an operation of two floats.
const ROUNDING: f64 = 2.0 * f64::EPSILON;

impl Span {
    /// The interval of all numbers: nothing is known.
    const ALL: Self = Self {
        low: f64::NEG_INFINITY,
        high: f64::INFINITY,
    };

    /// One number.
    pub(super) const fn at(x: f64) -> Self {
        Self { low: x, high: x }
    }

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
        let (a, b) = (self.low * self.low, self.high * self.high);
        let all = Self::outward(a, b);
        let low = if self.low <= 0.0 && self.high >= 0.0 || all.low < 0.0 {
            0.0
        } else {
            all.low
        };
        Self { low, ..all }
    }

    /// The intersection with another interval.
    pub(super) fn meets(self, other: Self) -> Option<Self> {
        let (low, high) = (self.low.max(other.low), self.high.min(other.high));
        (low <= high).then_some(Self { low, high })
    }

    /// Two halves.
    pub(super) fn halves(self) -> [Self; 2] {
        let middle = self.middle();
        [
            Self {
                high: middle,
                ..self
            },
            Self {
                low: middle,
                ..self
            },
        ]
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
    pub(super) fn times(self, factor: Span) -> Self {
        Self {
            re: self.re * factor,
            im: self.im * factor,
        }
    }

    /// The product with j and a real number.
    pub(super) fn turned(self, factor: Span) -> Self {
        let turned = Self {
            re: self.im * Span::at(-1.0),
            im: self.re,
        };
        turned.times(factor)
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
        Self {
            re: around(libm::cos(middle)),
            im: around(-libm::sin(middle)),
        }
    }

    /// Whether the box lies on one side of a line through zero. The line is perpendicular to the
    /// direction of the middle of the box, or it is an axis.
    pub(super) fn is_off_zero(self) -> bool {
        let towards = Self {
            re: Span::at(self.re.middle()),
            im: Span::at(-self.im.middle()),
        };
        let one_side = |span: Span| span.low > 0.0 || span.high < 0.0;
        one_side(self.re) || one_side(self.im) || (self * towards).re.low > 0.0
    }
}

impl Add for Plane {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self {
            re: self.re + other.re,
            im: self.im + other.im,
        }
    }
}

impl Mul for Plane {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self {
            re: self.re * other.re - self.im * other.im,
            im: self.re * other.im + self.im * other.re,
        }
    }
}
