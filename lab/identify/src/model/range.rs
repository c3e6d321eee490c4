//! The range of a free parameter.

use crate::scale::{TRACE, TWENTIETH};

/// A free parameter's range, mapped to the whole line so that bounds hold by construction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Between two positive bounds, logarithmic.
    Log(f64, f64),
    /// Between two bounds.
    Linear(f64, f64),
    /// Lower end plus a positive logarithmic part between two bounds.
    Above(f64, f64, f64),
    /// Not bounded (a phase).
    Free,
}

fn logistic(u: f64) -> f64 {
    1.0 / (1.0 + (-u).exp())
}

fn logit(p: f64) -> f64 {
    let p = p.clamp(1e-6, 1.0 - 1e-6);
    (p / (1.0 - p)).ln()
}

impl Range {
    /// The value at a point of the line.
    #[must_use]
    pub fn decode(self, u: f64) -> f64 {
        match self {
            Self::Log(lo, hi) => lo * (hi / lo).powf(logistic(u)),
            Self::Linear(lo, hi) => lo + (hi - lo) * logistic(u),
            Self::Above(base, lo, hi) => base + lo * (hi / lo).powf(logistic(u)),
            Self::Free => u,
        }
    }

    /// The point of the line for a value; values on a bound land near it.
    #[must_use]
    pub fn encode(self, value: f64) -> f64 {
        let log = |v: f64, lo: f64, hi: f64| logit((v.max(lo) / lo).ln() / (hi / lo).ln());
        match self {
            Self::Log(lo, hi) => log(value, lo, hi),
            Self::Linear(lo, hi) => logit((value - lo) / (hi - lo)),
            Self::Above(base, lo, hi) => log(value - base, lo, hi),
            Self::Free => value,
        }
    }

    /// d value / d u.
    #[must_use]
    pub fn slope(self, u: f64) -> f64 {
        let p = logistic(u);
        match self {
            Self::Log(lo, hi) => self.decode(u) * (hi / lo).ln() * p * (1.0 - p),
            Self::Linear(lo, hi) => (hi - lo) * p * (1.0 - p),
            Self::Above(base, lo, hi) => (self.decode(u) - base) * (hi / lo).ln() * p * (1.0 - p),
            Self::Free => 1.0,
        }
    }

    /// The scale on which a change of a value counts: the width of the range, or the value times
    /// the logarithm of the bounds' ratio.
    #[must_use]
    pub fn scale(self, value: f64) -> f64 {
        match self {
            Self::Log(lo, hi) => value * (hi / lo).ln(),
            Self::Linear(lo, hi) => hi - lo,
            Self::Above(base, lo, hi) => (value - base).max(lo) * (hi / lo).ln(),
            Self::Free => value.abs().max(1.0),
        }
    }

    /// A value at least 5 % of a linear range from both ends: at an end the map is flat, and a
    /// search that starts there does not move.
    #[must_use]
    pub(crate) fn inside(self, value: f64) -> f64 {
        match self {
            Self::Linear(lo, hi) => {
                value.clamp(lo + TWENTIETH * (hi - lo), hi - TWENTIETH * (hi - lo))
            }
            _ => value,
        }
    }

    /// A value 5 % of the range above its lower end.
    pub(crate) fn near_least(self) -> f64 {
        self.decode(logit(TWENTIETH))
    }

    /// A value on the unbounded scale, clamped to where the map is not so flat that a parameter would
    /// seem to have no influence.
    pub(crate) fn on_line(self, value: f64) -> f64 {
        match self {
            Self::Free => value,
            range => range.encode(value).clamp(-5.0, 5.0),
        }
    }

    /// The nearer bound to a value, in words.
    #[must_use]
    pub fn nearest(self, value: f64) -> &'static str {
        if self.encode(value) < 0.0 {
            "lower"
        } else {
            "upper"
        }
    }

    /// Whether the point lies within 1 % of the range's width from an end.
    #[must_use]
    pub fn at_bound(self, u: f64) -> bool {
        let p = logistic(u);
        !matches!(self, Self::Free) && !(TRACE..=1.0 - TRACE).contains(&p)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn ranges_map_there_and_back_and_their_slopes_are_derivatives() {
        for range in [
            Range::Log(1e-3, 50.0),
            Range::Linear(-2.0, 5.0),
            Range::Above(0.5, 1e-3, 1e3),
            Range::Free,
        ] {
            for u in [-3.0, -0.2, 0.0, 1.7, 4.0] {
                let value = range.decode(u);
                assert_relative_eq!(range.encode(value), u, epsilon = 1e-6);
                let h = 1e-6;
                let numeric = (range.decode(u + h) - range.decode(u - h)) / (2.0 * h);
                // Central differences of a smooth function: relative error about h².
                assert_relative_eq!(range.slope(u), numeric, max_relative = 1e-6);
                // The logistic map's slope is a quarter at most; in the middle it is that.
                if u == 0.0 && range != Range::Free {
                    let scale = range.scale(range.decode(u));
                    assert_relative_eq!(0.25 * scale, range.slope(u), max_relative = 1e-12);
                }
            }
        }
    }
}
