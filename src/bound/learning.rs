//! Whether what is learned from cycle to cycle converges, over a whole range of plants.

use super::halving::Halving;
use super::observer::proportional_and_integral;
use super::plant::ordered;
use super::plants::PlantRange;
use super::span::Span;
use super::Interval;
use crate::control::{Learning, Pid};
use crate::{Error, Real};
use alone::Loop;
use cycle::{Boxed, Cycle};

mod alone;
mod cycle;

/// Most boxes of a proof: a second or less on a computer.
const MOST_BOXES: u32 = 500_000;

/// Most halvings of a box.
const MOST_HALVINGS: u32 = 80;

/// Learning beside a P or PI that converges on every plant of a range.
///
/// With `C = k_p + k_i/s`, the plant P~ of a [`PlantRange`] and `G = P~/(1 + C·P~)` from feed-forward to
/// measured output, what a cycle leaves of a tone of what is yet to be learned is
///
/// ```text
/// H = Q·(1 − forgetting − gain·e^(jw·lead·T)·Σ S(w·T/2 + pi·k)³·G(j(w + 2·pi·k/T)))
/// ```
/// T is the time of a cell, `S(x) = sin(x)/x` stands for the mean over a cell and twice for the straight
/// lines between two, the sum over all whole numbers k for their images, and Q is that of
/// [`Learning`]. Shown is, for every plant and every cycle time of the range,
/// - that the loop without learning is stable, by zero exclusion as in
///   [`ObserverStability`](super::ObserverStability);
/// - that `|H| <= factor` at every frequency from the cycle's own to the cells' Nyquist, those between the
///   harmonics included; beside a P, from zero on; and
/// - beside a PI, that `|H| < 1` between zero and the cycle's own.
///
/// All by intervals that are rounded outwards and halved until they show it. In the images `|G|` is at
/// most its bound above the cells' Nyquist frequency, and what stands before it at most `0.32·|sin(w·T/2)|³`
/// in sum.
///
/// So the error goes to what stays of it, e*, from wherever it was. *Proof.* In the cells' own time the
/// learned feed-forward is `z⁻ⁿ·H` of itself, n cells before, and what comes from outside. That is
/// causal, as `lead + half_width + 1 < n`, stable as the loop is, and below 1 in magnitude on the unit circle;
/// hence everywhere outside of it, so that `1 − z⁻ⁿ·H` has no zero there. Beside a PI without forgetting
/// it is 1 at `z = 1`: the mean that was learned and the law's integral stand for each other, and the
/// output shows neither. ∎ Of `e − e*` at a tone about |H| is left from cycle to cycle, exactly so where
/// a cycle's change has settled before the next. At harmonics e* is nothing where forgetting is zero and
/// Q is one; where Q is small it may be *more* than the error without learning.
///
/// Assumed beside: one cycle time throughout, and a phase that is uniform in time; a plant of that form;
/// many samples a cell; friction and load repeat, or are disturbances that stay bounded (what does not
/// repeat cannot be learned, and some of it comes back a cycle later); no limit is met, neither of the
/// command nor of what is learned, and no sample is bad. **The range of the slope f covers each slope of
/// a hysteresis by itself**, which is no proof for one that changes along the path.
///
/// Where nothing could be shown, the number of boxes may have been too small rather than the range too
/// wide.
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
    /// |H| at most, from the cycle's own frequency on, beside a P from zero on; below that it is less
    /// than one.
    pub factor: f64,
    /// How many boxes of plants, cycle times and frequencies it took.
    pub boxes: u32,
}

impl LearningConvergence {
    /// Shows that it converges, with `|H| <= factor` from the cycle's own frequency on.
    ///
    /// `cells` is the length of the learning's buffers, `cycle` the range of what a cycle takes
    /// \[s\].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with what is wrong with the range, the `"cycle"`
    /// or the `"factor"`; [`Error::Inadmissible`] where the law is no P or PI, where there are too few
    /// cells for lead and filter, or so few that the loop still answers above their Nyquist
    /// frequency, where the loop without learning is not shown to be stable, or where nothing could be
    /// shown: what is yet to be learned of a tone grows on some plant, or shrinks by less.
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
        learning.check_cells(cells)?;
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
            "the loop hardly answers above the cells' Nyquist frequency",
        ))?;
        let turn = Span::at(core::f64::consts::TAU);
        let own = |cycle: f64| turn * Span::at(cycle).recip();
        let phase = (Span::at(core::f64::consts::PI) * count.recip()).low;
        // Without an integral the mean is learned as well, and shrinks like the rest.
        let (lowest, least) = match k_i == 0.0 {
            true => (0.0, 0.0),
            false => (own(cycle.high).low, phase),
        };
        let proof = Cycle {
            closed: &closed,
            gain: learning.gain().as_f64(),
            kept: Span::at(1.0) - Span::at(learning.forgetting().as_f64()),
            lead: f64::from(learning.lead()),
            width: f64::from(learning.half_width()) + 1.0,
            factor,
            half_phases: Span {
                low: least,
                high: Span::outward(0.0, core::f64::consts::FRAC_PI_2).high,
            },
            images: (Span::at(learning.gain().as_f64().abs()) * Span::at(beyond)).high,
        };
        let at = |low: f64, high: f64| Boxed {
            frequency: Span { low, high },
            cell,
            plants: all,
        };
        let half = Span::at(core::f64::consts::PI) * Span::at(cell.low).recip();
        let mut halving = Halving::at_most(MOST_BOXES, MOST_HALVINGS);
        let halves = |of: &Boxed| proof.halves(of);
        let to_nyquist = at(lowest, half.high);
        let below = at(0.0, own(cycle.low).high);
        let shrinks = halving.all(&to_nyquist, &|of| proof.is_small(of), &halves)
            && (k_i == 0.0 || halving.all(&below, &|of| proof.is_below_one(of), &halves));
        if !shrinks {
            return Err(Error::Inadmissible(
                "every tone shrinks by the factor on every plant of the range",
            ));
        }
        Ok(Self {
            plants: *plants,
            cycle: *cycle,
            factor,
            boxes: stable.saturating_add(halving.boxes),
        })
    }
}
