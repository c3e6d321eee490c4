//! Stability of the loop with a P or PI controller and without learning control, and its response
//! above the Nyquist frequency of the cells.

use crate::interval::{Plane, Span};
use crate::zeros::{doubled, excluded};
use crate::PlantRange;

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
    pub(super) fn is_stable(&self, all: &PlantRange) -> Option<u32> {
        let first = all.middle().plain();
        if !first.is_stable_with(self.k_p, self.k_i) {
            return None;
        }
        let highest = self.highest(&first.hull(*all))?;
        let values = |w, plants: &PlantRange, _| self.values(w, plants);
        let scale = 0.1 * self.natural_frequency;
        excluded(values, scale, [first, *all], 0.0, highest)
    }

    /// A frequency above which the first term is the larger term everywhere in the right
    /// half-plane. Both terms are divided by `|s|³`. Then one term decreases and the other
    /// increases with `1/|s|`.
    fn highest(&self, hull: &PlantRange) -> Option<f64> {
        doubled(self.natural_frequency, |r| {
            let x = Span::exactly(r).recip();
            let (least, most) = hull.shares(x);
            least.low > (most * self.law(x)).high
        })
    }

    /// Upper bound on `|k_p + k_i/s|`.
    fn law(&self, x: Span) -> Span {
        Span::exactly(self.k_p.abs()) + Span::exactly(self.k_i.abs()) * x
    }

    /// Upper bound on |G| above the Nyquist frequency of the cells; `None` if there is no bound.
    pub(super) fn beyond(&self, all: &PlantRange, cell: Span) -> Option<f64> {
        let x = Span::exactly(cell.high) * Span::exactly(core::f64::consts::PI).recip();
        let x = Span::exactly(x.high);
        let (least, most) = all.shares(x);
        if least.low <= 0.0 {
            return None;
        }
        let open = most * Span::exactly(least.low).recip();
        let around = Span::exactly(1.0) - open * self.law(x);
        (around.low > 0.0).then(|| (open * Span::exactly(around.low).recip()).high)
    }

    /// A region that contains all values of the sum at these frequencies.
    fn values(&self, w: Span, plants: &PlantRange) -> Plane {
        let (plant, delayed) = (plants.drive(w), plants.cable(w));
        let k_p = Span::exactly(self.k_p);
        if self.k_i == 0.0 {
            return plant + delayed.times(k_p);
        }
        plant.turned(w) + delayed * Plane::new(Span::exactly(self.k_i), k_p * w)
    }
}
