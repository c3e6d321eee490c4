//! Iterative learning: what a task that repeats has lacked so far, fed forward.
//!
//! ```text
//! v(c) = (1 − forgetting)·learned(c) + gain·e(c + lead)     as soon as cell c + lead is left
//! learned(c) = Σ w(k)·v(c + k), k from −half_width to half_width
//! ```
//! A cycle is divided into cells of equal phase, and e is the mean of `reference − measured` over a
//! cell. The feed-forward is what the cells around the phase have learned, by straight lines
//! between their middles. A cell learns `lead + half_width` cells after it was left, when all that
//! it needs is known; so there is no end of a cycle with more to do than the rest, and steps, gait
//! and wheels may go on without a pause.
//!
//! The weights are a triangle, `w(k) = (M − |k|)/M²` with `M = half_width + 1`. The filter has no
//! phase, and it passes from 0 to 1 of every tone (Fejér's kernel):
//!
//! ```text
//! Q(f) = (sin(M·x)/(M·sin(x)))², x = pi·f/(cells a second)
//! ```
//! It passes 0.71 of a tone at 0.32·(cells a second)/M.
//!
//! What one cell can learn is limited, and so is the mean over cells that are. Hence the feed-forward
//! is within ±limit whatever comes in; whether it *converges* depends on gain, lead, Q and the loop
//! that it is added to ([`bound::LearningConvergence`](crate::bound::LearningConvergence)).
//!
//! Sources: D. Bristow, M. Tharayil, A. Alleyne, "A survey of iterative learning control", *IEEE
//! Control Systems Magazine* 26(3), 2006; J. Zhang, C. Cheah, S. Collins, "Experimental comparison
//! of torque control methods on an ankle exoskeleton during human walking", *ICRA* 2015, where a
//! proportional law with such a feed-forward did best of nine.

use super::status::unless_finite;
use super::{Fault, Status};
use crate::error::{must_be_finite, not_below_zero, rarely};
use crate::signal::confined;
use crate::{Error, Real};

mod ring;
mod state;

use ring::{back, between, next, triangle};
pub use state::LearningState;

#[cfg(kani)]
#[path = "../../proofs/learning.rs"]
mod proofs;

/// Most cells that one sample may pass over.
const MOST_PASSED: usize = 4;

/// Samples of a cell after which its mean is taken to be known: a sum of many more would be wrong in
/// `f32`, where somebody stands still for hours.
const MOST_SAMPLES: f64 = 65_536.0;

/// Learning over a cycle that repeats: gain, lead, filter, limit, forgetting.
///
/// What is learned stands in two buffers of the same length, a number a cell each: arrays, or slices
/// that somebody else owns. A gait of 200 cells in `f32` takes 1600 bytes. Choose as many cells as the
/// filter needs, some ten times its corner a second, and fewer than there are samples in the shortest
/// cycle.
///
/// ```
/// use bowden::control::{Learning, LearningInput, Status};
/// // 4 units a N·m, at most 30 units, two cells ahead, Q over five cells.
/// let learning = Learning::try_new(4.0_f32, 30.0, 2, 2)?;
/// let mut state = learning.start([0.0; 250], [0.0; 250])?;
/// // A cycle of 1000 samples; 0.5 N·m are missing everywhere.
/// for k in 0..2000 {
///     let phase = (k % 1000) as f32 / 1000.0;
///     let at = LearningInput::new(phase, 20.0, 19.5); // [N·m], [N·m]
///     let out = learning.step(&mut state, &at); // out.feed_forward into LoopSample
///     // Held where there is no phase: after a few, a push-off should not be held on.
///     assert!(!matches!(out.status, Status::Held(_)));
/// }
/// // The cell has been taught twice: 4 units a N·m, each time.
/// assert!((state.learned()[100] - 4.0).abs() < 1e-5);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(
        try_from = "Unchecked<T>",
        bound(
            serialize = "T: Real + serde::Serialize",
            deserialize = "T: Real + serde::Deserialize<'de>"
        )
    )
)]
pub struct Learning<T> {
    gain: T,
    limit: T,
    lead: u16,
    half_width: u16,
    forgetting: T,
}

/// Its numbers after their checks, for any float and for constants.
macro_rules! learning {
    ($gain:ident, $limit:ident, $lead:ident, $half_width:ident, $zero:expr) => {{
        must_be_finite!($gain, "gain");
        if $gain == $zero {
            return Err(Error::OutOfRange("gain"));
        }
        crate::error::above_zero!($limit, $zero, "limit");
        Ok(Self {
            gain: $gain,
            limit: $limit,
            lead: $lead,
            half_width: $half_width,
            forgetting: $zero,
        })
    }};
}

/// A share that is forgotten, likewise.
macro_rules! forgetting {
    ($learning:ident, $share:ident, $zero:expr, $one:expr) => {{
        not_below_zero!($share, $zero, "forgetting");
        if $share > $one {
            return Err(Error::OutOfRange("forgetting"));
        }
        Ok(Self {
            forgetting: $share,
            ..$learning
        })
    }};
}

macro_rules! constant {
    ($float:ty) => {
        impl Learning<$float> {
            /// [`try_new`](Self::try_new) at compile time, see [`constant!`](crate::constant).
            ///
            /// # Errors
            /// As [`try_new`](Self::try_new).
            pub const fn const_new(
                gain: $float,
                limit: $float,
                lead: u16,
                half_width: u16,
            ) -> Result<Self, Error> {
                learning!(gain, limit, lead, half_width, 0.0)
            }

            /// [`with_forgetting`](Self::with_forgetting) at compile time.
            ///
            /// # Errors
            /// As [`with_forgetting`](Self::with_forgetting).
            pub const fn const_with_forgetting(self, share: $float) -> Result<Self, Error> {
                forgetting!(self, share, 0.0, 1.0)
            }
        }
    };
}
constant!(f32);
constant!(f64);

/// One sample for [`Learning`].
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningInput<T> {
    /// Where in the cycle, from 0 to 1; 1 is 0 of the next one.
    pub phase: T,
    /// Reference y_r \[output unit\], such as \[N·m\].
    pub reference: T,
    /// Measured output y \[output unit\].
    pub measured: T,
    /// Whether this sample is learned from. Not where a limit cut the command or the safe one is out,
    /// and not where the task is another one: while somebody stands still, or holds the joint. Where
    /// that is so of more than half of a cell's samples, the errors of the next `lead` cells, in which
    /// its commands show, teach nothing either.
    pub learns: bool,
}

impl<T: Real> LearningInput<T> {
    /// A sample that is learned from.
    #[must_use]
    pub const fn new(phase: T, reference: T, measured: T) -> Self {
        Self {
            phase,
            reference,
            measured,
            learns: true,
        }
    }
}

/// What a step of [`Learning`] gives.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningOutput<T> {
    /// To be added to the command \[command unit\]: finite and within ±limit in any case.
    pub feed_forward: T,
    /// A good sample; [`Status::Degraded`] where the feed-forward is of this phase but the error could
    /// not be used or the phase has jumped; [`Status::Held`] where there is no phase, and the last
    /// feed-forward stays.
    pub status: Status,
}

impl<T: Real> Learning<T> {
    /// Most cells of a cycle.
    pub const MOST_CELLS: usize = u16::MAX as usize;

    /// Learning without forgetting: `gain` of the error \[command unit/output unit\], not zero and
    /// of the sign of the plant's; `limit > 0` of what is learned \[command unit\]; `lead` \[cells\],
    /// by which a command comes before its effect; `half_width` of the triangle \[cells\].
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"gain"` or `"limit"`.
    pub fn try_new(gain: T, limit: T, lead: u16, half_width: u16) -> Result<Self, Error> {
        learning!(gain, limit, lead, half_width, T::ZERO)
    }

    /// The same where a share from 0 to 1 of what a cell has learned is forgotten each time.
    ///
    /// An error then remains, and what never comes again fades.
    ///
    /// # Errors
    /// [`Error::NonFinite`] or [`Error::OutOfRange`] with `"forgetting"`.
    pub fn with_forgetting(self, share: T) -> Result<Self, Error> {
        forgetting!(self, share, T::ZERO, T::ONE)
    }

    /// Gain \[command unit/output unit\].
    #[inline]
    #[must_use]
    pub const fn gain(&self) -> T {
        self.gain
    }

    /// Greatest magnitude of what is learned \[command unit\].
    #[inline]
    #[must_use]
    pub const fn limit(&self) -> T {
        self.limit
    }

    /// How many cells a command comes before its effect.
    #[inline]
    #[must_use]
    pub const fn lead(&self) -> u16 {
        self.lead
    }

    /// Half width of the triangle \[cells\]; 0 filters nothing.
    #[inline]
    #[must_use]
    pub const fn half_width(&self) -> u16 {
        self.half_width
    }

    /// Share of what a cell has learned that is forgotten each time.
    #[inline]
    #[must_use]
    pub const fn forgetting(&self) -> T {
        self.forgetting
    }

    /// Fewest cells that a cycle has: `lead + 2·half_width + 9`.
    #[must_use]
    pub const fn fewest_cells(&self) -> usize {
        self.lead as usize + 2 * self.half_width as usize + 2 * MOST_PASSED + 1
    }

    /// Refuses a number of cells that a cycle cannot have.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] with fewer than [`fewest_cells`](Self::fewest_cells);
    /// [`Error::Capacity`] with more than [`MOST_CELLS`](Self::MOST_CELLS).
    pub fn check_cells(&self, cells: usize) -> Result<(), Error> {
        if cells < self.fewest_cells() {
            return Err(Error::Inadmissible("as many cells as lead and filter need"));
        }
        if cells > Self::MOST_CELLS {
            return Err(Error::Capacity("cells"));
        }
        Ok(())
    }

    /// A state that has learned nothing, over two buffers with a number a cell, which are set to
    /// zero.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the buffers differ in length, or as
    /// [`check_cells`](Self::check_cells) of it.
    pub fn start<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        unfiltered: M,
    ) -> Result<LearningState<T, M>, Error> {
        self.check(learned.as_ref(), unfiltered.as_ref())?;
        learned.as_mut().fill(T::ZERO);
        self.resume(learned, unfiltered)
    }

    /// A state that has learned what the first buffer holds, such as a copy of
    /// [`LearningState::learned`] from before a reset; confined to the limit, and zero for NaN.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn resume<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        mut unfiltered: M,
    ) -> Result<LearningState<T, M>, Error> {
        self.check(learned.as_ref(), unfiltered.as_ref())?;
        let both = learned.as_mut().iter_mut().zip(unfiltered.as_mut());
        for (cell, before) in both {
            *cell = self.confined(*cell);
            *before = *cell;
        }
        Ok(LearningState::over(learned, unfiltered))
    }

    fn check(&self, learned: &[T], unfiltered: &[T]) -> Result<(), Error> {
        if learned.len() != unfiltered.len() {
            return Err(Error::Inadmissible("both buffers have the same length"));
        }
        self.check_cells(learned.len())
    }

    /// One sample: what is to be added to the command at this phase.
    ///
    /// Call it at every sample, before the controller, with the state of this learning. Whatever
    /// state and buffers hold, the feed-forward is finite and within ±limit. It moves as fast as what
    /// was learned does from one phase to the next, and where the phase jumps it jumps too: a slew rate
    /// of the controller's [`Limits`](crate::control::Limits) holds for the sum.
    ///
    /// - A phase that is not from 0 to 1 moves nothing and holds the feed-forward, for as long as there
    ///   is none: the controller sees good samples, so its safe command does not come. Where a phase
    ///   may stay away, add nothing after a few such samples.
    /// - Where reference or measured output are not finite, the feed-forward goes on from the phase, and
    ///   the sample teaches nothing.
    /// - Where the phase has jumped, by more than four cells in a sample or more than four back, the cell
    ///   that was left does not learn. Nor do the `lead` cells before the one that it came to: they were
    ///   not passed, and the errors are not theirs. (A step that ends early at the heel's contact is
    ///   such a jump; the last `lead + half_width` cells before it do not learn then.)
    /// - While it is up to four cells behind, as one that trembles is, nothing is learned. One that
    ///   trembles by more goes through cells several times, and teaches them each time: filter it, or
    ///   let `learns` be false.
    /// - The longest step is one in which four cells are passed; a cell that is left takes a sum over
    ///   `2·half_width + 1` cells.
    #[inline]
    pub fn step<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut LearningState<T, M>,
        at: &LearningInput<T>,
    ) -> LearningOutput<T> {
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
        LearningOutput {
            feed_forward: state.output,
            status,
        }
    }

    /// Takes a sample into the mean of its cell, after the cells before have learned; what was wrong
    /// with it.
    #[inline]
    fn gather<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut LearningState<T, M>,
        cell: usize,
        at: &LearningInput<T>,
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
        if gathers && state.count < T::of(MOST_SAMPLES) {
            state.sum += error;
            state.count += T::ONE;
        }
        matches!(moved, Moved::Jumped).then_some(Fault::Phase)
    }

    /// Goes on to another cell. The cells that were passed over learn what the last one has, where
    /// that was learned from at all.
    #[inline(never)]
    fn moved<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut LearningState<T, M>,
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

    /// The error of a cell that was left reaches the one that comes `lead` before it, and the one
    /// for which it was the last that was missing.
    fn learn<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        state: &mut LearningState<T, M>,
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

/// How the phase went on.
enum Moved {
    On,
    Back,
    Jumped,
}

/// What is read before it is checked.
#[cfg(feature = "serde")]
#[derive(serde::Deserialize)]
#[serde(deny_unknown_fields)]
#[serde(bound(deserialize = "T: Real + serde::Deserialize<'de>"))]
struct Unchecked<T> {
    gain: T,
    limit: T,
    lead: u16,
    half_width: u16,
    #[serde(default = "T::zero")]
    forgetting: T,
}

#[cfg(feature = "serde")]
impl<T: Real> TryFrom<Unchecked<T>> for Learning<T> {
    type Error = Error;
    fn try_from(raw: Unchecked<T>) -> Result<Self, Error> {
        Self::try_new(raw.gain, raw.limit, raw.lead, raw.half_width)?
            .with_forgetting(raw.forgetting)
    }
}
