//! Stability of the loop with a P or PI controller and without learning control, and its response
//! above the Nyquist frequency of the cells.

use crate::plants::Plants;
use crate::span::{Plane, Span};
use crate::zeros::{excluded, Closed};

/// A P or PI controller with a plant, without learning control.
pub(super) struct Loop {
    pub(super) k_p: f64,
    pub(super) k_i: f64,
    /// Natural frequency in the middle of the range \[rad/s\].
    pub(super) natural_frequency: f64,
}

impl Loop {
    /// Number of regions in the proof that `s·D~ + f·alpha~·(1 + c/K·s)·e^(−theta·s)·(k_p·s + k_i)`
    /// has no zero in the right half-plane, for any plant. For a P controller, the first term has
    /// no factor s.
    pub(super) fn is_stable(&self, all: &Plants) -> Option<u32> {
        let middle = all.middle();
        // The plant in the middle, without latency, joint and hysteresis.
        let first = Plants {
            joint: Span::at(0.0),
            slope: Span::at(1.0),
            latency: Span::at(0.0),
            ..middle
        };
        if !first.is_stable_with(self.k_p, self.k_i) {
            return None;
        }
        let highest = self.highest(&first.hull(all))?;
        excluded(self, first, *all, highest)
    }

    /// A frequency above which the first term is the larger term everywhere in the right
    /// half-plane. Both terms are divided by `|s|³`. Then one term decreases and the other
    /// increases with `1/|s|`.
    fn highest(&self, hull: &Plants) -> Option<f64> {
        let mut r = self.natural_frequency;
        for _ in 0..64 {
            let x = Span::at(r).recip();
            let (least, most) = self.shares(hull, x)?;
            if least.low > (most * self.law(x)).high {
                return Some(r);
            }
            r *= 2.0;
        }
        None
    }

    /// Lower bound on `|D~|/|s|²` and upper bound on `f·alpha~·|1 + c/K·s|/|s|²`, for all
    /// `|s| >= 1/x` in the right half-plane.
    fn shares(&self, hull: &Plants, x: Span) -> Option<(Span, Span)> {
        let (curvature, rate) = hull.denominator();
        let gain = Span::at(hull.gain.high.abs().max(hull.gain.low.abs()));
        let answer = gain * Span::at(hull.slope.high) * x * (Span::at(hull.joint.high) + x);
        let least = Span::at(curvature.low) - x * (Span::at(rate.high) + x);
        (least.high.is_finite() && answer.high.is_finite()).then_some((least, answer))
    }

    /// Upper bound on `|k_p + k_i/s|`.
    fn law(&self, x: Span) -> Span {
        Span::at(self.k_p.abs()) + Span::at(self.k_i.abs()) * x
    }

    /// Upper bound on |G| above the Nyquist frequency of the cells; `None` if there is no bound.
    pub(super) fn beyond(&self, all: &Plants, cell: Span) -> Option<f64> {
        let x = Span::at(cell.high) * Span::at(core::f64::consts::PI).recip();
        let (least, most) = self.shares(all, Span::at(x.high))?;
        if least.low <= 0.0 {
            return None;
        }
        let open = most * Span::at(least.low).recip();
        let around = Span::at(1.0) - open * self.law(Span::at(x.high));
        (around.low > 0.0).then(|| (open * Span::at(around.low).recip()).high)
    }
}

impl Closed for Loop {
    fn scale(&self) -> f64 {
        0.1 * self.natural_frequency
    }

    fn values(&self, w: Span, plants: &Plants) -> Plane {
        let (curvature, rate) = plants.denominator();
        let plant = Plane {
            re: Span::at(1.0) - curvature * w.square(),
            im: rate * w,
        };
        let joint = Plane {
            re: Span::at(1.0),
            im: plants.joint * w,
        };
        let delayed = (joint * Plane::late(plants.latency * w)).times(plants.gain * plants.slope);
        let k_p = Span::at(self.k_p);
        if self.k_i == 0.0 {
            return plant + delayed.times(k_p);
        }
        let law = Plane {
            re: Span::at(self.k_i),
            im: k_p * w,
        };
        plant.turned(w) + delayed * law
    }
}
