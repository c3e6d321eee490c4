//! What [`Learning`](super::Learning) remembers: two memories, and the cell that it is in.

use crate::Real;

/// State of [`Learning`](super::Learning) over two memories, arrays or slices, from
/// [`start`](super::Learning::start) or [`resume`](super::Learning::resume).
///
/// ```
/// use bowden::control::Learning;
/// let learning = Learning::try_new(4.0_f32, 30.0, 2, 2)?;
/// let state = learning.start([0.0; 100], [0.0; 100])?;
/// assert_eq!((state.learned().len(), state.feed_forward()), (100, 0.0));
/// // Or over memory that somebody else owns.
/// let (mut learned, mut smoothing) = (vec![0.0; 100], vec![0.0; 100]);
/// let state = learning.start(&mut learned[..], &mut smoothing[..])?;
/// # assert_eq!(state.learned().len(), 100);
/// # Ok::<(), bowden::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct LearningState<T, M> {
    pub(super) learned: M,
    /// What the cells would have learned without the filter.
    pub(super) smoothing: M,
    /// The cell that is gathered from; none of them before the first sample.
    pub(super) cell: usize,
    /// Of the errors in that cell, and how many.
    pub(super) sum: T,
    pub(super) count: T,
    pub(super) output: T,
}

impl<T: Real, M: AsRef<[T]>> LearningState<T, M> {
    pub(super) fn over(learned: M, smoothing: M) -> Self {
        Self {
            learned,
            smoothing,
            cell: usize::MAX,
            sum: T::ZERO,
            count: T::ZERO,
            output: T::ZERO,
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

    /// Begins to gather in another cell.
    pub(super) fn begin(&mut self, cell: usize) {
        self.cell = cell;
        self.sum = T::ZERO;
        self.count = T::ZERO;
    }
}
