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

/// Learning over a cycle that repeats: gain, lead, filter, limit, forgetting.
///
/// What is learned stands in two memories of one length, a number a cell each: arrays, or slices
/// that somebody else owns. A gait of 200 cells in `f32` takes 1600 bytes. Choose as many cells as the
/// filter needs, some ten times its corner a second, and fewer than there are samples in the shortest
/// cycle.
///
/// ```
/// use bowden::control::{Learning, LearningInput};
/// // 4 units a N·m, at most 30 units, two cells ahead, Q over five cells.
/// let learning = Learning::try_new(4.0_f32, 30.0, 2, 2)?;
/// let mut state = learning.start([0.0; 250], [0.0; 250])?;
/// // A cycle of 1000 samples; 0.5 N·m are missing everywhere.
/// for k in 0..2000 {
///     let phase = (k % 1000) as f32 / 1000.0;
///     let at = LearningInput::new(phase, 20.0, 19.5); // [N·m], [N·m]
///     let out = learning.step(&mut state, &at); // out.feed_forward into LoopSample
///     assert!(out.status.is_live());
/// }
/// // Twice in the first half of the cycle: 4 units a N·m, each time.
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
    /// Whether the error of this sample is learned from. Not where a limit cut the command, and
    /// not where the task is another one: while somebody stands still, or holds the joint.
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

    /// A state that has learned nothing, over two memories with a number a cell, which are set to
    /// zero.
    ///
    /// # Errors
    /// [`Error::Inadmissible`] where the memories have not one length, or fewer cells than
    /// [`fewest_cells`](Self::fewest_cells); [`Error::Capacity`] with more than 65 535.
    pub fn start<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        smoothing: M,
    ) -> Result<LearningState<T, M>, Error> {
        self.check(learned.as_ref(), smoothing.as_ref())?;
        learned.as_mut().fill(T::ZERO);
        self.resume(learned, smoothing)
    }

    /// A state that has learned what the first memory holds, such as a copy of
    /// [`LearningState::learned`] from before a reset; confined to the limit, and zero for NaN.
    ///
    /// # Errors
    /// As [`start`](Self::start).
    pub fn resume<M: AsRef<[T]> + AsMut<[T]>>(
        &self,
        mut learned: M,
        mut smoothing: M,
    ) -> Result<LearningState<T, M>, Error> {
        self.check(learned.as_ref(), smoothing.as_ref())?;
        let both = learned.as_mut().iter_mut().zip(smoothing.as_mut());
        for (cell, smooth) in both {
            *cell = self.confined(*cell);
            *smooth = *cell;
        }
        Ok(LearningState::over(learned, smoothing))
    }

    fn check(&self, learned: &[T], smoothing: &[T]) -> Result<(), Error> {
        if learned.len() != smoothing.len() {
            return Err(Error::Inadmissible("both memories have one length"));
        }
        if learned.len() < self.fewest_cells() {
            return Err(Error::Inadmissible("as many cells as lead and filter need"));
        }
        if learned.len() > usize::from(u16::MAX) {
            return Err(Error::Capacity("cells"));
        }
        Ok(())
    }

    /// One sample: what is to be added to the command at this phase.
    ///
    /// Call it at every sample, before the controller. Whatever state and memories hold, the
    /// feed-forward is finite and within ±limit.
    ///
    /// - A phase that is not from 0 to 1 moves nothing and holds the feed-forward.
    /// - Where reference or measured output are not finite, the feed-forward goes on from the phase, and
    ///   the sample teaches nothing.
    /// - Where the phase has jumped, by more than four cells in a sample or more than four back, the cell
    ///   that was left does not learn. (A step that ends early at the heel's contact is one; the last
    ///   `lead + half_width` cells before it do not learn then.)
    /// - While it is up to four cells behind, as one that trembles is, nothing is learned. One that
    ///   trembles by more goes through cells several times, and teaches them each time: filter it, or
    ///   let `learns` be false.
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
        if at.learns && !matches!(moved, Moved::Back) {
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
        if !(first || jumped) && state.count > T::ZERO {
            let error = state.sum / state.count;
            let mut left = state.cell;
            for _ in 0..MOST_PASSED {
                if left == cell {
                    break;
                }
                self.learn(state, left, error);
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
        let (learned, smoothing) = (state.learned.as_mut(), state.smoothing.as_mut());
        let cells = learned.len();
        let (lead, half) = (usize::from(self.lead), usize::from(self.half_width));
        let taught = back(left, lead, cells);
        let ready = back(taught, half, cells);
        if let (Some(known), Some(smooth)) = (learned.get(taught), smoothing.get_mut(taught)) {
            let kept = *known - self.forgetting * *known;
            *smooth = self.confined(kept + self.gain * error);
        }
        let mean = triangle(smoothing, ready, half);
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
