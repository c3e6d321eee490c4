//! The cells of a cycle as a ring.

use crate::Real;

/// The cell that lies `by` before another, in a cycle of the given number of cells.
#[inline]
pub(super) fn back(cell: usize, by: usize, cells: usize) -> usize {
    if cell >= by {
        cell.wrapping_sub(by)
    } else {
        cell.wrapping_add(cells).wrapping_sub(by)
    }
}

/// The cell after another.
#[inline]
pub(super) fn next(cell: usize, cells: usize) -> usize {
    let after = cell.wrapping_add(1);
    if after < cells {
        after
    } else {
        0
    }
}

/// Linear interpolation between the centres of the cells.
#[inline]
pub(super) fn between<T: Real>(cells: &[T], cell: usize, part: T) -> T {
    let half = T::from_f64(0.5);
    let (before, after, share) = if part < half {
        (back(cell, 1, cells.len()), cell, part + half)
    } else {
        (cell, next(cell, cells.len()), part - half)
    };
    let value = |cell: usize| cells.get(cell).copied().unwrap_or(T::ZERO);
    (T::ONE - share) * value(before) + share * value(after)
}

/// The mean of the cells around one, weighted by a triangle.
pub(super) fn triangle<T: Real>(cells: &[T], around: usize, half_width: usize) -> T {
    let value = |cell: usize| cells.get(cell).copied().unwrap_or(T::ZERO);
    let most = T::from_f64(half_width as f64) + T::ONE;
    let (mut weight, mut sum) = (most, most * value(around));
    let (mut below, mut above) = (around, around);
    for _ in 0..half_width {
        below = back(below, 1, cells.len());
        above = next(above, cells.len());
        weight -= T::ONE;
        sum += weight * (value(below) + value(above));
    }
    sum / (most * most)
}
