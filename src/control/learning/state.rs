//! What [`Learning`](super::Learning) remembers: two buffers, and the cell that it is in.

use crate::Real;

/// State of [`Learning`](super::Learning) over two buffers, arrays or slices, from
/// [`start`](super::Learning::start) or [`resume`](super::Learning::resume).
///
/// ```
/// use bowden::control::Learning;
/// let learning = Learning::try_new(4.0_f32, 30.0, 2, 2)?;
/// let state = learning.start([0.0; 100], [0.0; 100])?;
/// assert_eq!((state.learned().len(), state.feed_forward()), (100, 0.0));
/// // Or over buffers that somebody else owns.
/// let (mut learned, mut unfiltered) = (vec![0.0; 100], vec![0.0; 100]);
/// let state = learning.start(&mut learned[..], &mut unfiltered[..])?;
/// # assert_eq!(state.learned().len(), 100);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningState<T, M> {
    pub(super) learned: M,
    /// What the cells would have learned without the filter.
    pub(super) unfiltered: M,
    /// The cell that is gathered from; none of them before the first sample.
    pub(super) cell: usize,
    /// Of the errors in that cell, and how many.
    pub(super) sum: T,
    pub(super) count: T,
    pub(super) output: T,
    /// Samples in that cell that are not to be learned from.
    pub(super) missed: u16,
    /// Whole cells that were left since a jump, the start, or one that was not to be learned from.
    pub(super) since: u16,
}

impl<T: Real, M: AsRef<[T]>> LearningState<T, M> {
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

    /// What each cell has learned \[command unit\], within ±limit: for a plot, or to be stored for
    /// [`resume`](super::Learning::resume).
    #[inline]
    #[must_use]
    pub fn learned(&self) -> &[T] {
        self.learned.as_ref()
    }

    /// The last feed-forward \[command unit\].
    #[must_use]
    pub fn feed_forward(&self) -> T {
        self.output
    }

    /// The cell of a phase from 0 to 1, and how far in it that is, from 0 to 1.
    #[inline]
    pub(super) fn place(&self, phase: T) -> Option<(usize, T)> {
        if !(T::ZERO <= phase && phase <= T::ONE) {
            return None;
        }
        let cells = self.learned().len();
        let along = phase * T::of(cells as f64);
        let cell = along.to_usize()?;
        // The end of a cycle is the start of the next; rounding may lead there too.
        if cell >= cells {
            return Some((0, T::ZERO));
        }
        Some((cell, along - T::of(cell as f64)))
    }

    /// Whether the error of a cell that is left is that of what was out in the cell `lead` before it,
    /// and may be learned from; counts the cell.
    pub(super) fn may_teach(&mut self, lead: u16) -> bool {
        if T::of(f64::from(self.missed)) > self.count {
            self.since = 0;
            return false;
        }
        let teaches = self.since >= lead;
        self.since = self.since.saturating_add(1);
        teaches
    }

    /// Begins to gather in another cell.
    pub(super) fn begin(&mut self, cell: usize) {
        self.cell = cell;
        self.sum = T::ZERO;
        self.count = T::ZERO;
        self.missed = 0;
    }
}
