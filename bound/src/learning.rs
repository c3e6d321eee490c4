//! Convergence of iterative learning control from cycle to cycle, over a range of plants.

use super::halving::Halving;
use super::interval::Span;
use super::observer::proportional_and_integral;
use super::{Interval, PlantRange};
use alone::Loop;
use bowden::control::{IterativeLearning, Pid};
use bowden::{Error, Real};
use cycle::{Boxed, Cycle};

mod alone;
mod cycle;

/// Maximum number of regions in a proof. A proof takes a second or less on a computer.
const MOST_BOXES: u32 = 500_000;

/// Maximum number of bisections of a region.
const DEEPEST: u32 = 80;

/// Convergence of iterative learning control with a P or PI controller, for every plant of a range.
///
/// Let `C = k_p + k_i/s`, and let P~ be the plant of a [`PlantRange`]. Then `G = P~/(1 + C·P~)` is
/// the transfer function from the feed-forward to the measured output. From one cycle to the next,
/// a sinusoid in the learning error is multiplied by the factor
///
/// ```text
/// H = Q·(1 − forgetting − gain·e^(jw·lead·T)·Σ S(w·T/2 + pi·k)³·G(j(w + 2·pi·k/T)))
/// ```
/// T is the duration of a cell. `S(x) = sin(x)/x` describes the mean over a cell, and `S²`
/// describes the linear interpolation between two cells. The sum over all integers k includes the
/// images (aliases). Q is the filter of [`IterativeLearning`]. For every plant and every cycle time
/// in the range, the certificate proves:
/// - The loop without learning control is stable, by zero exclusion as in
///   [`ObserverStability`](super::ObserverStability).
/// - `|H| <= factor` at every frequency from the frequency of the cycle to the Nyquist frequency of
///   the cells, including frequencies between the harmonics. With a P controller, this holds from
///   zero frequency.
/// - With a PI controller, `|H| < 1` between zero and the frequency of the cycle.
///
/// The proof bisects regions until interval arithmetic, rounded outwards, shows the inequality. For
/// the images, the proof replaces `|G|` by its upper bound above the Nyquist frequency of the
/// cells. The sum of the factors of the images is at most `0.32·|sin(w·T/2)|³`.
///
/// The error therefore converges to its limit e* from any initial value. *Proof.* In units of
/// cells, the learned feed-forward is `z⁻ⁿ·H` times its value n cells earlier, plus external
/// inputs. This operator is causal, because `lead + half_width + 1 < n`. It is stable, because the
/// loop is stable. Its magnitude is below 1 on the unit circle, and therefore everywhere outside
/// the circle. Hence `1 − z⁻ⁿ·H` has no zero there. For a PI controller without forgetting, the
/// magnitude is 1 at `z = 1`. There, the learned mean and the integral of the controller are
/// interchangeable, and an exchange between them does not change the output. ∎
///
/// From cycle to cycle, the amplitude of a sinusoid in `e − e*` is multiplied by about |H|. The
/// factor is exact if the response to a change in one cycle settles before the next cycle. At the
/// harmonics, e* is zero if forgetting is zero and Q is one. If Q is small, e* may be *larger* than
/// the error without learning control.
///
/// Further assumptions:
/// - the cycle time is constant, and the phase advances at a constant rate;
/// - the plant has this form;
/// - there are many samples per cell;
/// - friction and load repeat in every cycle, or they are bounded disturbances (learning control
///   cannot remove these, and repeats a part of them one cycle later);
/// - neither the command nor a learned value saturates, and no sample is bad.
///
/// **The certificate covers every constant slope f in the range.** It does not cover a slope that
/// changes along the path, as the slope of a hysteresis does.
///
/// The search for a proof may also fail because the number of regions is limited.
///
/// Source: D. Bristow, M. Tharayil, A. Alleyne, "A survey of iterative learning control", *IEEE
/// Control Systems Magazine* 26(3), 2006, frequency-domain condition for monotonic convergence.
///
/// ```
/// use bowden_bound::{Interval, IterativeLearningConvergence, PlantRange};
/// use bowden::control::{IterativeLearning, Pid, PidSettings};
/// // 250 cells of a gait of 1 s: 12 ms ahead, Q of 16 Hz.
/// let learning = IterativeLearning::try_new(4.0_f32, 30.0, 3, 4)?;
/// let pi = Pid::try_new(PidSettings::unlimited(30.0, 18.0))?;
/// let within = |x: f64, share: f64| Interval { low: x * (1.0 - share), high: x * (1.0 + share) };
/// let range = PlantRange {
///     gain: within(0.6, 0.05),
///     natural_frequency: within(25.5, 0.025),
///     damping_ratio: within(0.265, 0.05),
///     joint: within(0.0033, 0.05), // 0.5 N·m·s/rad over 150 N·m/rad
///     slope: Interval { low: 0.33, high: 1.0 },
///     latency: within(0.003, 0.05),
/// };
/// let gait = within(1.0, 0.1); // [s]
/// assert!(IterativeLearningConvergence::try_new(&learning, 250, &gait, &pi, &range, 0.92).is_ok());
/// // Without a lead the tones near the loop's own resonance would grow.
/// let late = IterativeLearning::try_new(4.0_f32, 30.0, 0, 4)?;
/// assert!(IterativeLearningConvergence::try_new(&late, 250, &gait, &pi, &range, 1.0).is_err());
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IterativeLearningConvergence {
    /// The range of plants of the certificate.
    pub plants: PlantRange,
    /// The range of cycle times of the certificate \[s\].
    pub cycle: Interval<f64>,
    /// Upper bound on |H| at and above the frequency of the cycle (with a P controller, from zero).
    /// Below that frequency, |H| is less than one.
    pub factor: f64,
    /// Number of regions of plants, cycle times and frequencies in the proof.
    pub boxes: u32,
}

impl IterativeLearningConvergence {
    /// Proves convergence with `|H| <= factor` at and above the frequency of the cycle.
    ///
    /// `cells` is the length of the learning buffers, and `cycle` is the range of the cycle time
    /// \[s\].
    ///
    /// # Errors
    /// - [`Error::NonFinite`] or [`Error::OutOfRange`] with the invalid part of the range, the
    ///   `"cycle"` or the `"factor"`.
    /// - [`Error::Inadmissible`] if the controller is not P or PI, or if no proof of stability
    ///   without learning control was found.
    /// - [`Error::Inadmissible`] if there are too few cells for the lead and the filter, or so few
    ///   that the loop responds above the Nyquist frequency of the cells.
    /// - [`Error::Capacity`] if there are too many cells.
    /// - [`Error::Inadmissible`] if no proof of convergence was found. With some plant, a sinusoid
    ///   in the learning error may grow, or decay more slowly than `factor`.
    pub fn try_new<T: Real>(
        learning: &IterativeLearning<T>,
        cells: usize,
        cycle: &Interval<f64>,
        law: &Pid<T>,
        plants: &PlantRange,
        factor: f64,
    ) -> Result<Self, Error> {
        plants.check()?;
        cycle.above_zero("cycle")?;
        if !(factor > 0.0 && factor <= 1.0) {
            return Err(Error::OutOfRange("factor"));
        }
        learning.check_cells(cells)?;
        let (k_p, k_i) = proportional_and_integral(law.settings())?;
        let closed = Loop {
            k_p,
            k_i,
            natural_frequency: plants.natural_frequency.middle(),
        };
        let stable = closed.is_stable(plants).ok_or(Error::Inadmissible(
            "the loop without learning must be stable with every plant of the range",
        ))?;
        let count = Span::exactly(cells as f64);
        let cell = *cycle * count.recip();
        let beyond = closed.beyond(plants, cell).ok_or(Error::Inadmissible(
            "the loop must hardly respond above the cells' Nyquist frequency",
        ))?;
        let turn = Span::exactly(core::f64::consts::TAU);
        let own = |cycle: f64| turn * Span::exactly(cycle).recip();
        let phase = (Span::exactly(core::f64::consts::PI) * count.recip()).low;
        // Without an integral the mean is learned as well, and decays like the rest.
        let (lowest, least) = match k_i == 0.0 {
            true => (0.0, 0.0),
            false => (own(cycle.high).low, phase),
        };
        let proof = Cycle {
            closed: &closed,
            gain: learning.gain().as_f64(),
            kept: Span::exactly(1.0) - Span::exactly(learning.forgetting().as_f64()),
            lead: f64::from(learning.lead()),
            width: f64::from(learning.half_width()) + 1.0,
            factor,
            half_phases: Span {
                low: least,
                high: Span::outward(0.0, core::f64::consts::FRAC_PI_2).high,
            },
            images: (Span::exactly(learning.gain().as_f64().abs()) * Span::exactly(beyond)).high,
        };
        let at = |low: f64, high: f64| Boxed {
            frequency: Span { low, high },
            cell,
            plants: *plants,
        };
        let half = Span::exactly(core::f64::consts::PI) * Span::exactly(cell.low).recip();
        let (to_nyquist, below) = (at(lowest, half.high), at(0.0, own(cycle.low).high));
        let mut halving = Halving::at_most(MOST_BOXES);
        let halves = |of: &Boxed| proof.halves(of);
        let shrinks = halving.all(&to_nyquist, DEEPEST, &|of| proof.is_small(of), &halves)
            && (k_i == 0.0 || halving.all(&below, DEEPEST, &|of| proof.is_below_one(of), &halves));
        if !shrinks {
            return Err(Error::Inadmissible(
                "every tone must shrink by the factor on every plant of the range",
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
