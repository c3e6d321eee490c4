//! Iterative learning control: a feed-forward from the errors of earlier cycles.
//!
//! ```text
//! v(c) = (1 − forgetting)·learned(c) + gain·e(c + lead)     as soon as cell c + lead is left
//! learned(c) = Σ w(k)·v(c + k), k from −half_width to half_width
//! ```
//! A cycle is divided into cells of equal phase width. The error e of a cell is the mean of
//! `reference − measured` over this cell. The feed-forward interpolates linearly between the
//! learned values at the centres of the cells. The learned value of a cell is updated
//! `lead + half_width` cells after the end of the cell, when all required errors are known.
//!
//! The weights form a triangle, `w(k) = (M − |k|)/M²` with `M = half_width + 1`. The filter has
//! zero phase, and its gain is between 0 and 1 at every frequency (Fejér kernel):
//!
//! ```text
//! Q(f) = (sin(M·x)/(M·sin(x)))², x = pi·f/(cells per second)
//! ```
//! For M of 3 or more, the gain is about 0.71 at the frequency 0.32·(cells per second)/M.
//!
//! The learned values are clamped, so the feed-forward is within ±limit for any input.
//! *Convergence* depends on the gain, the lead, the filter and the loop; see
//! `IterativeLearningConvergence` in the crate `bowden-bound`.
//!
//! Sources: D. Bristow, M. Tharayil, A. Alleyne, "A survey of iterative learning control", *IEEE
//! Control Systems Magazine* 26(3), 2006; J. Zhang, C. Cheah, S. Collins, "Experimental comparison
//! of torque control methods on an ankle exoskeleton during human walking", *ICRA* 2015.

use super::{Fault, Output, Status};
use crate::error::{above_zero, must_be_finite, not_below_zero, rarely};
use crate::fault::unless_finite;
use crate::signal::confined;
use crate::{Error, Real};

mod ring;
mod state;

use ring::{back, between, next, triangle};
pub use state::IterativeLearningState;

#[cfg(kani)]
#[path = "../../proofs/learning.rs"]
mod proofs;

/// Most cells that one sample may skip.
const MOST_PASSED: usize = 4;

/// Samples of a cell after which further samples are ignored. In `f32`, a sum of many more would be
/// inaccurate, for example after hours without motion.
const MOST_SAMPLES: f64 = 65_536.0;

crate::checked::stored! {
    /// Iterative learning control over a repeating cycle: gain, lead, filter, limit and forgetting.
    ///
    /// The learned values are stored in two buffers (arrays or borrowed slices) of the same length,
    /// with one number per cell. A cycle of 200 cells in `f32` requires 1600 bytes. Use about ten
    /// cells per second for each hertz of the filter's corner frequency. The number of cells must
    /// be smaller than the number of samples in the shortest cycle.
    ///
    /// ```
    /// use bowden::control::{IterativeLearning, IterativeLearningInput, Status};
    /// // 4 units per N·m, at most 30 units, two cells ahead, Q over five cells.
    /// let learning = IterativeLearning::try_new(4.0_f32, 30.0, 2, 2)?;
    /// let mut state = learning.start([0.0; 250], [0.0; 250])?;
    /// // A cycle of 1000 samples; 0.5 N·m are missing everywhere.
    /// for k in 0..2000 {
    ///     let phase = (k % 1000) as f32 / 1000.0;
    ///     let at = IterativeLearningInput::new(phase, 20.0, 19.5); // [N·m], [N·m]
    ///     let out = learning.step(&mut state, &at); // out.command is the feed-forward
    ///     // Held means no phase: after a few such samples, omit the feed-forward.
    ///     assert!(!matches!(out.status, Status::Held(_)));
    /// }
    /// // The cell has learned twice: 4 units per N·m each time.
    /// assert!((state.learned()[100] - 4.0).abs() < 1e-5);
    /// # Ok::<(), bowden::Error>(())
    /// ```
    pub struct IterativeLearning<T> {
        gain: T,
        limit: T,
        lead: u16,
        half_width: u16,
        #[serde(default = "T::zero")]
        forgetting: T,
    }
    => {
        Self::try_new(gain, limit, lead, half_width)?
            .with_forgetting(forgetting)
    }
}

/// One sample for [`IterativeLearning`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IterativeLearningInput<T> {
    /// Phase of the cycle, from 0 to 1. Phase 1 equals phase 0 of the next cycle.
    pub phase: T,
    /// Reference y_r \[output unit\], such as \[N·m\].
    pub reference: T,
    /// Measured output y \[output unit\].
    pub measured: T,
    /// Whether the error of this sample is used. Set it to `false` if the command is limited, the
    /// safe command is applied, or the task is different (standing, or a held joint). After a cell
    /// with more unused than used samples, the errors of the next `lead` cells are ignored as well.
    pub learns: bool,
}

impl<T: Real> IterativeLearningInput<T> {
    /// A sample whose error is used.
    pub const fn new(phase: T, reference: T, measured: T) -> Self {
        Self {
            phase,
            reference,
            measured,
            learns: true,
        }
    }
}

crate::checked! {
    IterativeLearning<T>;

    /// Iterative learning control without forgetting.
    ///
    /// - `gain` multiplies the error \[command unit/output unit\]. It must be nonzero and have the
    ///   sign of the plant's gain.
    /// - `limit` must be positive; it bounds the magnitude of the learned values \[command unit\].
    /// - `lead` is the number of cells between a command and its effect.
    /// - `half_width` is the half-width of the triangle \[cells\]; 0 means no filter.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"gain"` or `"limit"`.
    pub fn try_new(gain: T, limit: T, lead: u16, half_width: u16) {
        must_be_finite!(gain, "gain");
        if gain == T::ZERO {
            return Err(Error::OutOfRange("gain"));
        }
        above_zero!(limit, "limit");
        let forgetting = T::ZERO;
        Ok(IterativeLearning { gain, limit, lead, half_width, forgetting })
    }

    /// Sets the share (0 to 1) of each learned value that each cycle removes.
    ///
    /// With forgetting, learned values decay if their errors do not repeat. However, part of the
    /// repeating error remains.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"forgetting"`.
    pub fn with_forgetting[self learning](share: T) {
        not_below_zero!(share, "forgetting");
        if share > T::ONE {
            return Err(Error::OutOfRange("forgetting"));
        }
        Ok(IterativeLearning { forgetting: share, ..learning })
    }
}

impl<T: Real> IterativeLearning<T> {
    /// Maximum number of cells in a cycle.
    pub const MOST_CELLS: usize = u16::MAX as usize;

    /// Gain \[command unit/output unit\].
    pub const fn gain(&self) -> T {
        self.gain
    }

    /// Largest magnitude of the learned values \[command unit\].
    pub const fn limit(&self) -> T {
        self.limit
    }

    /// Number of cells between a command and its effect.
    pub const fn lead(&self) -> u16 {
        self.lead
    }

    /// Half-width of the triangle \[cells\]; 0 means no filter.
    pub const fn half_width(&self) -> u16 {
        self.half_width
    }

    /// Share of a learned value that each cycle removes.
    pub const fn forgetting(&self) -> T {
        self.forgetting
    }

    /// Minimum number of cells in a cycle: `lead + 2·half_width + 9`.
    pub const fn fewest_cells(&self) -> usize {
        self.lead as usize + 2 * self.half_width as usize + 2 * MOST_PASSED + 1
    }

    /// Checks the number of cells.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if there are fewer than [`fewest_cells`](Self::fewest_cells);
    /// [`Error::Capacity`] if there are more than [`MOST_CELLS`](Self::MOST_CELLS).
    pub fn check_cells(&self, cells: usize) -> Result<(), Error> {
        if cells < self.fewest_cells() {
            return Err(Error::Inadmissible(
                "the lead and the filter need more cells",
            ));
        }
        if cells > Self::MOST_CELLS {
            return Err(Error::Capacity("cells"));
        }
        Ok(())
    }

    /// Initial state with two buffers of one number per cell. Both buffers are set to zero.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] if the buffers differ in length; otherwise the errors of
    /// [`check_cells`](Self::check_cells).
    pub fn start<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        unfiltered: M,
    ) -> Result<IterativeLearningState<T, M>, Error> {
        self.check(learned.as_ref(), unfiltered.as_ref())?;
        learned.as_mut().fill(T::ZERO);
        self.resume(learned, unfiltered)
    }

    /// A state that continues from the learned values in the first buffer, for example a stored
    /// copy of [`IterativeLearningState::learned`]. The values are clamped to the limit, and NaN
    /// becomes zero.
    ///
    /// # Errors
    /// The same as [`start`](Self::start).
    pub fn resume<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        mut unfiltered: M,
    ) -> Result<IterativeLearningState<T, M>, Error> {
        self.check(learned.as_ref(), unfiltered.as_ref())?;
        let both = learned.as_mut().iter_mut().zip(unfiltered.as_mut());
        for (cell, before) in both {
            *cell = self.confined(*cell);
            *before = *cell;
        }
        Ok(IterativeLearningState::over(learned, unfiltered))
    }

    fn check(&self, learned: &[T], unfiltered: &[T]) -> Result<(), Error> {
        if learned.len() != unfiltered.len() {
            return Err(Error::Inadmissible(
                "both buffers must have the same length",
            ));
        }
        self.check_cells(learned.len())
    }

    /// Processes one sample and returns the value to add to the command at this phase.
    ///
    /// [`Status::Degraded`] means that the feed-forward is valid for this phase, but that the error
    /// is unusable or the phase has jumped. [`Status::Held`] means that the phase is invalid and
    /// the last feed-forward is held.
    ///
    /// Call this method at every sample, before the controller. For any state and buffers, the
    /// feed-forward is finite and within ±limit. If the phase jumps, the feed-forward jumps too.
    /// Set a slew-rate limit in the controller's [`Limits`](crate::control::Limits) to limit the
    /// rate of the command.
    ///
    /// - A phase outside 0 to 1 holds the feed-forward. The controller does not detect this fault
    ///   and does not apply its safe command. If the phase signal can fail, omit the feed-forward
    ///   after a few such samples.
    /// - If the reference or the measured output is not finite, the feed-forward follows the phase,
    ///   but the sample is not used for learning.
    /// - A phase change of more than four cells in one sample, forward or backward, counts as a
    ///   jump. The cell before a jump and the `lead` cells before the new cell are not updated. For
    ///   example, the phase jumps if a walking step ends early at heel contact. The last
    ///   `lead + half_width` cells before this jump are then not updated.
    /// - If the phase moves back by up to four cells (jitter), samples are not used until the phase
    ///   returns to the cell that it had reached. With larger jitter, cells are updated several
    ///   times per cycle. In this case, filter the phase, or set `learns` to `false`.
    /// - The most expensive step completes four cells, and computes a sum over `2·half_width + 1`
    ///   cells for each of them.
    #[inline]
    pub fn step<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut IterativeLearningState<T, M>,
        at: &IterativeLearningInput<T>,
    ) -> Output<T> {
        let status = match state.place(at.phase) {
            Some((cell, part)) => {
                let fault = self.gather(state, cell, at);
                state.output = between(state.learned(), cell, part);
                fault.map_or(Status::Good, Status::Degraded)
            }
            None => {
                rarely();
                Status::Held(Fault::Phase)
            }
        };
        if !at.learns {
            state.missed = state.missed.saturating_add(1);
        }
        state.output = self.confined(state.output);
        let command = state.output;
        Output { command, status }
    }

    /// Adds a sample to the mean of its cell after earlier cells have learned; returns the
    /// fault, if there is one.
    #[inline]
    fn gather<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut IterativeLearningState<T, M>,
        cell: usize,
        at: &IterativeLearningInput<T>,
    ) -> Option<Fault> {
        let moved = match state.cell == cell {
            true => Moved::On,
            false => self.moved(state, cell),
        };
        let error = at.reference - at.measured;
        if !error.is_finite() {
            rarely();
            let of_reference = unless_finite(at.reference, Fault::Reference);
            let of_measured = unless_finite(at.measured, Fault::Measured);
            return of_reference.or(of_measured).or(Some(Fault::Overflow));
        }
        let gathers = at.learns && !matches!(moved, Moved::Back);
        if gathers && state.count < T::from_f64(MOST_SAMPLES) {
            state.sum += error;
            state.count += T::ONE;
        }
        matches!(moved, Moved::Jumped).then_some(Fault::Phase)
    }

    /// Moves to another cell. Skipped cells learn the error of the last cell, if the law
    /// learned from that cell.
    #[inline(never)]
    fn moved<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut IterativeLearningState<T, M>,
        cell: usize,
    ) -> Moved {
        let cells = state.learned().len();
        let first = state.cell >= cells;
        let passed = back(cell, state.cell, cells);
        let returned = !first && cells.wrapping_sub(passed) <= MOST_PASSED;
        if returned {
            return Moved::Back;
        }
        let jumped = !first && passed > MOST_PASSED;
        if first || jumped {
            state.since = 0;
        } else {
            let (error, is_known) = (state.sum / state.count, state.count > T::ZERO);
            let mut left = state.cell;
            for _ in 0..MOST_PASSED {
                if left == cell {
                    break;
                }
                let may_teach = state.may_teach(self.lead);
                if is_known && may_teach {
                    self.learn(state, left, error);
                }
                left = next(left, cells);
            }
        }
        state.begin(cell);
        if jumped {
            Moved::Jumped
        } else {
            Moved::On
        }
    }

    /// Adds the error of a finished cell to the cell that lies `lead` before it, and to the
    /// cell that lacked only this error.
    fn learn<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut IterativeLearningState<T, M>,
        left: usize,
        error: T,
    ) {
        let (learned, unfiltered) = (state.learned.as_mut(), state.unfiltered.as_mut());
        let cells = learned.len();
        let (lead, half) = (usize::from(self.lead), usize::from(self.half_width));
        let taught = back(left, lead, cells);
        let ready = back(taught, half, cells);
        if let (Some(known), Some(own)) = (learned.get(taught), unfiltered.get_mut(taught)) {
            let kept = *known - self.forgetting * *known;
            *own = self.confined(kept + self.gain * error);
        }
        let mean = triangle(unfiltered, ready, half);
        if let Some(learned) = learned.get_mut(ready) {
            *learned = self.confined(mean);
        }
    }

    #[inline]
    fn confined(&self, value: T) -> T {
        confined(value, -self.limit, self.limit)
    }
}

/// How the phase has advanced.
enum Moved {
    On,
    Back,
    Jumped,
}
