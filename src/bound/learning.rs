//! Whether what is learned from cycle to cycle converges, over a whole range of plants.

use super::observer::proportional_and_integral;
use super::plant::ordered;
use super::plants::{PlantRange, Plants};
use super::span::{Plane, Span};
use super::zeros::{excluded, Closed};
use super::Interval;
use crate::control::{Learning, Pid};
use crate::{Error, Real};

/// Learning beside a P or PI, whose error shrinks from cycle to cycle on every plant of a range.
///
/// With `C = k_p + k_i/s`, the plant P~ of a [`PlantRange`] and `G = P~/(1 + C·P~)` from feed-forward to
/// measured output, a tone of what is yet to be learned is multiplied in each cycle by
///
/// ```text
/// H = Q·(1 − forgetting − gain·e^(jw·lead·T)·Σ S(w·T/2 + pi·k)³·G(j(w + 2·pi·k/T)))
/// ```
/// T is the time of a cell, `S(x) = sin(x)/x` stands for the mean over a cell and twice for the straight
/// lines between two, the sum over all whole numbers k for their images, and Q is that of
/// [`Learning`]. Shown is
/// - that the loop without learning is stable, by zero exclusion as in
///   [`ObserverStability`](super::ObserverStability); and
/// - that `|H| <= factor` for every plant of the range, every cycle time, and every frequency from the
///   cycle's own to half a cell's, those between the harmonics included: by intervals that are
///   rounded outwards and halved until they show it. In the images `|G|` is at most its bound above
///   half a cell's frequency, and what stands before it at most `0.32·|sin(w·T/2)|³` in sum.
///
/// So the harmonics of a task that repeats shrink to what `factor` leaves of them, cycle by cycle:
/// `|e⁺ − e*| <= factor·|e − e*|` in each, e* being what stays (nothing, where forgetting is zero and Q
/// is one). Its mean is left to the law's integral.
///
/// Assumed beside: what one cycle has changed has settled within the next, as it has where the loop is
/// much faster than the cycle; the error is of a plant of that form, many samples a cell; friction and
/// load repeat, or are disturbances that stay bounded; the limit of what is learned is not met. A limit
/// of the command is not met either, or its samples are not learned from. **The range of the slope f
/// covers each slope of a hysteresis by itself**, which is no proof for one that changes along the path.
///
/// Source: D. Bristow, M. Tharayil, A. Alleyne, "A survey of iterative learning control", *IEEE
/// Control Systems Magazine* 26(3), 2006, frequency-domain condition for monotonic convergence.
///
/// ```
/// use bowden::bound::{Interval, LearningConvergence, PlantRange};
/// use bowden::control::{Learning, Pid, PidSettings};
/// // 250 cells of a gait of 1 s: 12 ms ahead, Q of 16 Hz.
/// let learning = Learning::try_new(4.0_f32, 30.0, 3, 4)?;
/// let pi = Pid::try_new(PidSettings::unlimited(30.0, 18.0))?;
/// let within = |x: f64, share: f64| Interval { low: x * (1.0 - share), high: x * (1.0 + share) };
/// let range = PlantRange {
///     gain: within(0.6, 0.05),
///     natural_frequency: within(25.5, 0.025),
///     damping_ratio: within(0.265, 0.05),
///     joint: within(0.0033, 0.05), // 0.5 N·m·s/rad beside 150 N·m/rad
///     slope: Interval { low: 0.33, high: 1.0 },
///     latency: within(0.003, 0.05),
/// };
/// let gait = within(1.0, 0.1); // \[s\]
/// assert!(LearningConvergence::try_new(&learning, 250, &gait, &pi, &range, 0.92).is_ok());
/// // Without a lead the tones near the loop's own resonance would grow.
/// let late = Learning::try_new(4.0_f32, 30.0, 0, 4)?;
/// assert!(LearningConvergence::try_new(&late, 250, &gait, &pi, &range, 1.0).is_err());
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningConvergence {
    /// The plants that it holds for.
    pub plants: PlantRange,
    /// The times of a cycle that it holds for \[s\].
    pub cycle: Interval<f64>,
    /// What is left of a tone after a cycle, at most.
    pub factor: f64,
    /// How many boxes of plants, cycle times and frequencies it took.
    pub boxes: u32,
}

/// Most boxes of a proof: a second or less on a computer.
const MOST_BOXES: u32 = 500_000;

/// Most halvings of a box.
const MOST_HALVINGS: u32 = 80;

/// Sum over all images of `1/|x + pi·k|³` for x from 0 to pi/2: `(2/pi)³` of the nearest, 0.053 of all
/// others.
const IMAGES: f64 = 0.32;

/// A P or PI with a plant, and nothing else.
struct Loop {
    k_p: f64,
    k_i: f64,
    /// That of the middle of the range \[rad/s\].
    natural_frequency: f64,
}

/// What is the same for every box.
struct Cycle<'a> {
    closed: &'a Loop,
    gain: f64,
    kept: Span,
    lead: f64,
    width: f64,
    factor: f64,
    /// Half the phase over a cell, of the cycle's own frequency and of half a cell's.
    half_phases: Span,
    /// `gain·|G|` above half a cell's frequency, at most.
    images: f64,
    boxes: u32,
}

/// Frequencies \[rad/s\], times of a cell, and plants.
#[derive(Clone, Copy)]
struct Boxed {
    frequency: Span,
    cell: Span,
    plants: Plants,
}

impl LearningConvergence {
    /// Shows that every tone shrinks to `factor` of itself in a cycle, or less; with 1, that none grows.
    ///
    /// `cells` is the length of the learning's memories, `cycle` the range of what a cycle takes
    /// \[s\].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with what is wrong with the range, the `"cycle"`
    /// or the `"factor"`; [`Error::Inadmissible`] where the law is no P or PI, where there are too few
    /// cells for lead and filter, or so few that the loop still answers above half a cell's
    /// frequency, where the loop without learning is not shown to be stable, or where nothing could be
    /// shown: a tone grows on some plant, or shrinks by less.
    pub fn try_new<T: Real>(
        learning: &Learning<T>,
        cells: usize,
        cycle: &Interval<f64>,
        law: &Pid<T>,
        plants: &PlantRange,
        factor: f64,
    ) -> Result<Self, Error> {
        plants.check()?;
        ordered(cycle, "cycle")?;
        if cycle.low <= 0.0 {
            return Err(Error::OutOfRange("cycle"));
        }
        if !(factor > 0.0 && factor <= 1.0) {
            return Err(Error::OutOfRange("factor"));
        }
        if cells < learning.fewest_cells() {
            return Err(Error::Inadmissible("as many cells as lead and filter need"));
        }
        let (k_p, k_i) = proportional_and_integral(law.settings())?;
        let all = plants.all(0.0);
        let closed = Loop {
            k_p,
            k_i,
            natural_frequency: all.natural_frequency.middle(),
        };
        let stable = closed.is_stable(&all).ok_or(Error::Inadmissible(
            "the loop without learning is stable with every plant of the range",
        ))?;
        let count = Span::at(cells as f64);
        let cell = Span {
            low: (Span::at(cycle.low) * count.recip()).low,
            high: (Span::at(cycle.high) * count.recip()).high,
        };
        let beyond = closed.beyond(&all, cell).ok_or(Error::Inadmissible(
            "the loop hardly answers above half a cell's frequency",
        ))?;
        let mut proof = Cycle {
            closed: &closed,
            gain: learning.gain().as_f64(),
            kept: Span::at(1.0) - Span::at(learning.forgetting().as_f64()),
            lead: f64::from(learning.lead()),
            width: f64::from(learning.half_width()) + 1.0,
            factor,
            half_phases: Span {
                low: (Span::at(core::f64::consts::PI) * count.recip()).low,
                high: Span::outward(0.0, core::f64::consts::FRAC_PI_2).high,
            },
            images: (Span::at(learning.gain().as_f64().abs()) * Span::at(beyond)).high,
            boxes: stable,
        };
        let turn = Span::at(core::f64::consts::TAU);
        let all = Boxed {
            frequency: Span {
                low: (turn * Span::at(cycle.high).recip()).low,
                high: (turn * Span::at(2.0 * cell.low).recip()).high,
            },
            cell,
            plants: all,
        };
        if !proof.shrinks(&all, MOST_HALVINGS) {
            return Err(Error::Inadmissible(
                "every tone shrinks by the factor on every plant of the range",
            ));
        }
        Ok(Self {
            plants: *plants,
            cycle: *cycle,
            factor,
            boxes: proof.boxes,
        })
    }
}

impl Loop {
    /// How many boxes show that `s·D~ + f·alpha~·(1 + c/K·s)·e^(−theta·s)·(k_p·s + k_i)` has no zero on
    /// the right, for any plant; without the s of the first term for a P.
    fn is_stable(&self, all: &Plants) -> Option<u32> {
        let middle = all.middle();
        // The plant in the middle without latency, joint and hysteresis: stable by Routh.
        let first = Plants {
            joint: Span::at(0.0),
            slope: Span::at(1.0),
            latency: Span::at(0.0),
            ..middle
        };
        let (curvature, rate) = first.denominator();
        let one = Span::at(1.0) + first.gain * Span::at(self.k_p);
        let integral = first.gain * Span::at(self.k_i);
        let margin = rate * one - curvature * integral;
        let holds = rate.low > 0.0 && one.low > 0.0;
        if !(holds && (self.k_i == 0.0 || (integral.low > 0.0 && margin.low > 0.0))) {
            return None;
        }
        let highest = self.highest(&first.hull(all))?;
        excluded(self, first, *all, highest)
    }

    /// A frequency from which on, for all `|s|` on the right, the first term is the greater one. Both
    /// are divided by `|s|³`; then the one falls and the other grows with `1/|s|`.
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

    /// `|D~|/|s|²` at least and `f·alpha~·|1 + c/K·s|/|s|²` at most, for all `|s| >= 1/x` on the right.
    fn shares(&self, hull: &Plants, x: Span) -> Option<(Span, Span)> {
        let (curvature, rate) = hull.denominator();
        let gain = Span::at(hull.gain.high.abs().max(hull.gain.low.abs()));
        let answer = gain * Span::at(hull.slope.high) * x * (Span::at(hull.joint.high) + x);
        let least = Span::at(curvature.low) - x * (Span::at(rate.high) + x);
        (least.high.is_finite() && answer.high.is_finite()).then_some((least, answer))
    }

    /// `|k_p + k_i/s|` at most.
    fn law(&self, x: Span) -> Span {
        Span::at(self.k_p.abs()) + Span::at(self.k_i.abs()) * x
    }

    /// |G| above half a cell's frequency, at most; `None` where there is no such bound.
    fn beyond(&self, all: &Plants, cell: Span) -> Option<f64> {
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

impl Cycle<'_> {
    /// Whether `|H| <= factor` for all of a box.
    fn shrinks(&mut self, all: &Boxed, halvings: u32) -> bool {
        self.boxes = self.boxes.saturating_add(1);
        if self.boxes > MOST_BOXES {
            return false;
        }
        if self.is_small(all) {
            return true;
        }
        match halvings.checked_sub(1) {
            Some(left) => {
                let [first, second] = self.halves(all);
                self.shrinks(&first, left) && self.shrinks(&second, left)
            }
            None => false,
        }
    }

    /// Whether `|H| <= factor`, without a division by what may be small: with `W = e^(−jw·lead·T)/G`,
    /// `a = gain·S³` and s, what Q and the images leave of the factor, it is so where
    /// `|kept·W − a|² − s²·|W|²` is not above zero.
    fn is_small(&self, all: &Boxed) -> bool {
        let w = all.frequency;
        let Some(x) = (Span::at(0.5) * w * all.cell).meets(self.half_phases) else {
            return true;
        };
        let sine = sine(x);
        let seen = sine * x.recip();
        let learned = Span::at(self.gain) * seen * seen.square();
        let images = Span::at(IMAGES * self.images) * sine.square() * sine;
        let passed = Span::at(self.passed(x));
        let left = Span::at(self.factor) * passed.recip() - Span::at(images.high.max(0.0));
        if left.low < 0.0 || left.low.is_nan() {
            return false;
        }
        let kept = self.kept;
        let square = kept.square() - Span::at(left.low).square();
        let around = self.around(w, &all.plants) * early(Span::at(-2.0 * self.lead) * x);
        let of_size = square * around.im.square();
        [learned.low, learned.high].iter().all(|a| {
            let a = Span::at(*a);
            let along = |p: Span| square * p.square() - Span::at(2.0) * kept * a * p;
            let ends = [around.re.low, around.re.high].map(|p| along(Span::at(p)).high);
            // Where it falls on both sides, the highest value lies between.
            let top = (kept * a).square() * (Span::at(-1.0) * square).recip();
            let between = if square.low < 0.0 {
                top.high
            } else {
                f64::NEG_INFINITY
            };
            let peak = kept * a * square.recip();
            let outside = around.re.high < peak.low || around.re.low > peak.high;
            let most = match outside {
                true => ends[0].max(ends[1]),
                false => ends[0].max(ends[1]).max(between),
            };
            (Span::at(most) + of_size + a.square()).high <= 0.0
        })
    }

    /// Q at most: `sin(M·x)/(M·sin(x))` is 1 at most, and falls up to its first zero at `x = pi/M`.
    fn passed(&self, x: Span) -> f64 {
        let first = self.width * x.high < core::f64::consts::PI;
        let x = if first { Span::at(x.low) } else { x };
        let share = sine(Span::at(self.width) * x) * (Span::at(self.width) * sine(x)).recip();
        share.square().high.clamp(f64::MIN_POSITIVE, 1.0)
    }

    /// `1/G = (D~/f)·e^(jw·theta)/(alpha·(1 + jw·c/K)) + k_p + k_i/(jw)`.
    fn around(&self, w: Span, plants: &Plants) -> Plane {
        let one = Span::at(1.0);
        let (slow, y) = (plants.natural_frequency.recip(), plants.joint * w);
        let share = plants.slope.recip();
        let plant = Plane {
            re: share - (w * slow).square(),
            im: w * (Span::at(2.0) * plants.damping_ratio * slow + plants.joint * share),
        };
        let below = (one + y.square()).recip();
        let joint = Plane {
            re: below,
            im: Span::at(-1.0) * y * below,
        };
        let open = (plant * joint * early(plants.latency * w)).times(plants.gain.recip());
        open + Plane {
            re: Span::at(self.closed.k_p),
            im: Span::at(-self.closed.k_i) * w.recip(),
        }
    }

    /// Two halves, along the number that moves 1/G most across the box.
    fn halves(&self, all: &Boxed) -> [Boxed; 2] {
        let (w, plants) = (all.frequency.middle(), &all.plants);
        let [gain, slow, damping, joint, slope, latency] = [
            plants.gain.middle().abs(),
            w / plants.natural_frequency.middle(),
            plants.damping_ratio.middle(),
            w * plants.joint.middle(),
            plants.slope.middle(),
            w * plants.latency.middle(),
        ];
        let all_of_it = self.around(Span::at(w), &plants.middle());
        let integral = self.closed.k_i / w;
        let own = Plane {
            re: Span::at(-self.closed.k_p),
            im: Span::at(integral),
        };
        let length = |of: Plane| libm::hypot(of.re.middle(), of.im.middle());
        let (size, open) = (length(all_of_it), length(all_of_it + own));
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
        // The lead turns it, and Q falls by (M² − 1)·x²/3.
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
    Plane::late(Span::at(-1.0) * phase)
}

fn sine(phase: Span) -> Span {
    early(phase).im
}
