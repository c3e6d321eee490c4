//! The factor H of a sinusoid over one cycle, for regions of frequencies, cycle times and plants.

use super::alone::Loop;
use crate::interval::{Plane, Span};
use crate::PlantRange;

/// Sum over all images of `1/|x + pi·k|³` for x from 0 to pi/2: `(2/pi)³` for the nearest image and
/// 0.053 for all others.
const IMAGES: f64 = 0.32;

/// The numbers that all regions share.
pub(super) struct Cycle<'a> {
    pub(super) closed: &'a Loop,
    pub(super) gain: f64,
    pub(super) kept: Span,
    pub(super) lead: f64,
    pub(super) width: f64,
    pub(super) factor: f64,
    /// Half of the phase change over a cell, at the frequency of the cycle and at the Nyquist
    /// frequency of the cells.
    pub(super) half_phases: Span,
    /// Upper bound on `gain·|G|` above the Nyquist frequency of the cells.
    pub(super) images: f64,
}

/// A region of frequencies \[rad/s\], cell durations and plants.
#[derive(Clone, Copy)]
pub(super) struct Boxed {
    pub(super) frequency: Span,
    pub(super) cell: Span,
    pub(super) plants: PlantRange,
}

impl Cycle<'_> {
    /// Whether `|H| <= factor`, without a division by a number that may be small. Let
    /// `W = e^(−jw·lead·T)/G`, `a = gain·S³`, and let s be the part of the factor that Q and the
    /// images do not use. The inequality holds if `|kept·W − a|² − s²·|W|²` is not positive. (If H
    /// itself were enclosed, the proof would need many more regions.)
    pub(super) fn is_small(&self, all: &Boxed) -> bool {
        let w = all.frequency;
        let Some(x) = (Span::exactly(0.5) * w * all.cell).meets(self.half_phases) else {
            return true;
        };
        let sine = sine(x);
        let learned = self.learned(x);
        let images = Span::exactly(IMAGES * self.images) * sine.square() * sine;
        let passed = Span::exactly(self.passed(x));
        let left =
            Span::exactly(self.factor) * passed.recip() - Span::exactly(images.high.max(0.0));
        if left.low < 0.0 || left.low.is_nan() {
            return false;
        }
        let kept = self.kept;
        let square = kept.square() - Span::exactly(left.low).square();
        let around = self.around(w, &all.plants) * early(Span::exactly(-2.0 * self.lead) * x);
        let of_size = square * around.im.square();
        [learned.low, learned.high].iter().all(|a| {
            let a = Span::exactly(*a);
            let along = |p: Span| square * p.square() - Span::exactly(2.0) * kept * a * p;
            let ends = [around.re.low, around.re.high].map(|p| along(Span::exactly(p)).high);
            let ends = ends[0].max(ends[1]);
            // Where it falls on both sides, the highest value lies between.
            let top = (kept * a).square() * (Span::exactly(-1.0) * square).recip();
            let peak = kept * a * square.recip();
            let outside = around.re.high < peak.low || around.re.low > peak.high;
            let between = square.low < 0.0 && !outside;
            let most = if between { ends.max(top.high) } else { ends };
            (Span::exactly(most) + of_size + a.square()).high <= 0.0
        })
    }

    /// Whether `|H| < 1` for frequencies from zero, where 1/G of a PI controller is unbounded. Let
    /// `W = e^(−jw·L)/G` and `m >= 0.32·sin³` of the images. The inequality holds if
    /// `(kept² − (1 − m)²)·|W|² + a² − 2·kept·a·Re(W)` is negative. Here Re(W) is finite,
    /// `Re(e^(−jw·L)·(1/P~ + k_p)) − k_i·sin(w·L)/w`, and so is `|w·W|`.
    pub(super) fn is_below_one(&self, all: &Boxed) -> bool {
        let (w, one) = (all.frequency, Span::exactly(1.0));
        let x = Span::exactly(0.5) * w * all.cell;
        let (lead, k_i) = (
            Span::exactly(self.lead) * all.cell,
            Span::exactly(self.closed.k_i),
        );
        let mut open = self.open(w, &all.plants);
        open.re = open.re + Span::exactly(self.closed.k_p);
        let re = (open * Plane::late(lead * w)).re - k_i * lead * sinc(lead * w);
        let size = (w * open.re).square() + (w * open.im - k_i).square();
        let images = Span::exactly(IMAGES * self.images);
        let most = images * x.square() * x;
        if most.high.is_nan() || most.high > 1.0 {
            return false;
        }
        let kept = self.kept;
        let square = kept.square() - (one - Span::exactly(most.high)).square();
        let first = if square.high < 0.0 {
            Span::exactly(square.high)
                * Span::exactly(size.low)
                * Span::exactly(w.high).square().recip()
        } else {
            // At most 2·m/w², of which w³ is in m.
            let half = Span::exactly(0.5) * all.cell;
            Span::exactly(2.0) * images * half.square() * half * w * size
        };
        let learned = self.learned(x);
        [learned.low, learned.high].iter().all(|a| {
            let a = Span::exactly(*a);
            (first + a * (a - Span::exactly(2.0) * kept * re)).high < 0.0
        })
    }

    /// `gain·S³`.
    fn learned(&self, x: Span) -> Span {
        let seen = sinc(x);
        Span::exactly(self.gain) * seen * seen.square()
    }

    /// Upper bound on Q. `sin(M·x)/(M·sin(x))` is at most 1 and decreases up to its first zero at
    /// `x = pi/M`.
    fn passed(&self, x: Span) -> f64 {
        let first = self.width * x.high < core::f64::consts::PI;
        let x = if first { Span::exactly(x.low) } else { x };
        let share =
            sine(Span::exactly(self.width) * x) * (Span::exactly(self.width) * sine(x)).recip();
        share.square().high.clamp(f64::MIN_POSITIVE, 1.0)
    }

    /// `1/P~ = (D~/f)·e^(jw·theta)/(alpha·(1 + jw·c/K))`.
    fn open(&self, w: Span, plants: &PlantRange) -> Plane {
        let one = Span::exactly(1.0);
        let (slow, y) = (plants.natural_frequency.recip(), plants.joint * w);
        let share = plants.slope.recip();
        let rate = Span::exactly(2.0) * plants.damping_ratio * slow + plants.joint * share;
        let plant = Plane::new(share - (w * slow).square(), w * rate);
        let below = (one + y.square()).recip();
        let joint = Plane::new(below, Span::exactly(-1.0) * y * below);
        (plant * joint * early(plants.latency * w)).times(plants.gain.recip())
    }

    /// `1/G = 1/P~ + k_p + k_i/(jw)`.
    fn around(&self, w: Span, plants: &PlantRange) -> Plane {
        let integral = match self.closed.k_i == 0.0 {
            true => Span::exactly(0.0),
            false => Span::exactly(-self.closed.k_i) * w.recip(),
        };
        self.open(w, plants) + Plane::new(Span::exactly(self.closed.k_p), integral)
    }

    /// The two halves of the region, along the parameter that changes 1/G most.
    pub(super) fn halves(&self, all: &Boxed) -> [Boxed; 2] {
        let (w, plants) = (all.frequency.middle(), &all.plants);
        let [gain, slow, damping, joint, slope, latency] = [
            plants.gain.middle().abs(),
            w / plants.natural_frequency.middle(),
            plants.damping_ratio.middle(),
            w * plants.joint.middle(),
            plants.slope.middle(),
            w * plants.latency.middle(),
        ];
        let middle = plants.middle();
        let length = |of: Plane| libm::hypot(of.re.middle(), of.im.middle());
        let open = length(self.open(Span::exactly(w), &middle));
        let size = length(self.around(Span::exactly(w), &middle));
        let integral = self.closed.k_i / w;
        let unit = 1.0 / (gain * libm::sqrt(1.0 + joint * joint));
        let rate = 2.0 * damping * slow + joint / slope;
        let share = |span: Span| span.width() / span.middle().abs();
        let numbers = [
            share(plants.gain) * open,
            share(plants.natural_frequency) * slow * unit * 2.0 * (slow + damping),
            plants.damping_ratio.width() * 2.0 * slow * unit,
            share(plants.joint) * joint * (unit / slope + open),
            share(plants.slope) * unit * (1.0 + joint) / slope,
            share(plants.latency) * latency * open,
        ];
        let turns = unit * (2.0 * slow * slow + rate) + (latency + joint) * open + integral.abs();
        // The lead rotates it, and Q falls by (M² − 1)·x²/3.
        let x = 0.5 * w * all.cell.middle();
        let falls = 2.0 / 3.0 * (self.width * self.width - 1.0) * x * x;
        let turned = size * (2.0 * self.lead * x + falls);
        let of_frequency = share(all.frequency) * (turns + turned);
        let of_cell = share(all.cell) * turned;
        let (of_plants, [below, above]) = plants.largest(numbers);
        let (mut first, mut second) = (*all, *all);
        if of_frequency >= of_cell.max(of_plants) {
            [first.frequency, second.frequency] = all.frequency.halves();
        } else if of_cell >= of_plants {
            [first.cell, second.cell] = all.cell.halves();
        } else {
            (first.plants, second.plants) = (below, above);
        }
        [first, second]
    }
}

/// e^(j·phase).
fn early(phase: Span) -> Plane {
    Plane::late(Span::exactly(-1.0) * phase)
}

fn sine(phase: Span) -> Span {
    early(phase).im
}

/// `sin(x)/x` for x ≥ 0, from its series if x is small.
fn sinc(x: Span) -> Span {
    if x.low > 0.1 {
        return sine(x) * x.recip();
    }
    let sixth = Span::exactly(6.0).recip();
    let (first, last) = (Span::exactly(x.low.max(0.0)), Span::exactly(x.high));
    let above = first.square()
        * sixth
        * (first.square() * Span::exactly(20.0).recip() - Span::exactly(1.0));
    Span {
        low: (Span::exactly(1.0) - last.square() * sixth).low,
        high: (Span::exactly(1.0) + above).high.min(1.0),
    }
}
