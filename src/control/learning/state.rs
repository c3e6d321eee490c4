//! State of [`IterativeLearning`](super::IterativeLearning) between samples.

use crate::Real;

/// State of [`IterativeLearning`](super::IterativeLearning) with two buffers (arrays or slices),
/// from [`start`](super::IterativeLearning::start) or [`resume`](super::IterativeLearning::resume).
///
/// ```
/// use bowden::control::IterativeLearning;
/// let learning = IterativeLearning::try_new(4.0_f32, 30.0, 2, 2)?;
/// let state = learning.start([0.0; 100], [0.0; 100])?;
/// assert_eq!((state.learned().len(), state.feed_forward()), (100, 0.0));
/// // Or over borrowed buffers.
/// let (mut learned, mut unfiltered) = (vec![0.0; 100], vec![0.0; 100]);
/// let state = learning.start(&mut learned[..], &mut unfiltered[..])?;
/// # assert_eq!(state.learned().len(), 100);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct IterativeLearningState<T, M> {
    pub(super) learned: M,
    /// Learned values of the cells before the filter.
    pub(super) unfiltered: M,
    /// The present cell; `usize::MAX` before the first sample.
    pub(super) cell: usize,
    /// Sum of the errors in this cell, and their number.
    pub(super) sum: T,
    pub(super) count: T,
    pub(super) output: T,
    /// Samples in this cell from which the law does not learn.
    pub(super) missed: u16,
    /// Whole cells since a jump, the start, or a cell without learning.
    pub(super) since: u16,
}

impl<T: Real, M: AsRef<[T]>> IterativeLearningState<T, M> {
    pub(super) fn over(learned: M, unfiltered: M) -> Self {
        Self {
            learned,
            unfiltered,
            cell: usize::MAX,
            sum: T::ZERO,
            count: T::ZERO,
            output: T::ZERO,
            missed: 0,
            since: 0,
        }
    }

    /// The learned value of each cell \[command unit\], within ±limit, for a plot or for a later
    /// [`resume`](super::IterativeLearning::resume).
    pub fn learned(&self) -> &[T] {
        self.learned.as_ref()
    }

    /// The last feed-forward \[command unit\].
    pub fn feed_forward(&self) -> T {
        self.output
    }

    /// The cell of a phase from 0 to 1, and the position in this cell, from 0 to 1.
    #[inline]
    pub(super) fn place(&self, phase: T) -> Option<(usize, T)> {
        if !(T::ZERO <= phase && phase <= T::ONE) {
            return None;
        }
        let cells = self.learned().len();
        let along = phase * T::from_f64(cells as f64);
        let cell = along.to_usize()?;
        // The end of a cycle is the start of the next; rounding may reach this end too.
        if cell >= cells {
            return Some((0, T::ZERO));
        }
        Some((cell, along - T::from_f64(cell as f64)))
    }

    /// Whether the error of a finished cell belongs to the command of the cell `lead` before
    /// it, and is usable; counts the cell.
    pub(super) fn may_teach(&mut self, lead: u16) -> bool {
        if T::from_f64(f64::from(self.missed)) > self.count {
            self.since = 0;
            return false;
        }
        let teaches = self.since >= lead;
        self.since = self.since.saturating_add(1);
        teaches
    }

    /// Starts the mean of another cell.
    pub(super) fn begin(&mut self, cell: usize) {
        self.cell = cell;
        self.sum = T::ZERO;
        self.count = T::ZERO;
        self.missed = 0;
    }
}
