//! Gains by least squares for known shapes.

use super::tie::Tie;
use crate::algebra::{Span, Stretch};
use std::sync::Arc;

/// A column whose residual norm is below this share of its norm depends on the others.
const SUM_OF_OTHERS: f64 = 1e-9;

/// Gains, and the orthonormal basis of their columns.
pub(super) struct Linear {
    pub(super) gains: Vec<f64>,
    pub(super) basis: Span,
    /// The active bounds.
    pub(super) tied: Vec<Tie>,
}

/// Least squares on the fit segment with the sign of some gains given, 1 or −1, and others within
/// their ties.
///
/// A violated bound becomes an equation, and the two columns of its gains become one column. A
/// bound that has become an equation stays one: with one record there is only one bound, so
/// that the result is the exact optimum.
pub(super) fn solve_linear(
    rows: &[usize],
    columns: &[Arc<Stretch>],
    target: &[f64],
    signs: &[f64],
    ties: &[Tie],
) -> Linear {
    let mut tied: Vec<Tie> = Vec::new();
    loop {
        let mut columns = columns.to_vec();
        for tie in &tied {
            columns[tie.hysteresis] = Arc::new(tie.merged(&columns));
        }
        let free = |k: &usize| tied.iter().all(|tie| tie.gain != *k);
        let active = (0..columns.len()).filter(free).collect();
        let mut linear = signed(rows, &columns, target, signs, active);
        for tie in &tied {
            linear.gains[tie.gain] = -tie.ratio * linear.gains[tie.hysteresis];
        }
        match ties.iter().find(|tie| tie.is_violated(&linear.gains)) {
            Some(next) if !tied.contains(next) => tied.push(*next),
            _ => return Linear { tied, ..linear },
        }
    }
}

/// Least squares with the sign of some gains given.
fn signed(
    rows: &[usize],
    columns: &[Arc<Stretch>],
    target: &[f64],
    signs: &[f64],
    mut active: Vec<usize>,
) -> Linear {
    let y = Stretch::from(rows.iter().map(|&i| target[i]).collect::<Vec<f64>>());
    loop {
        let mut span = Span::with_tolerance(SUM_OF_OTHERS);
        let column = |k: usize| columns[k].at_rows(rows);
        let used = active.iter().copied().filter(|&k| span.add(column(k)));
        let used: Vec<usize> = used.collect();
        let gains = span.gains(&y);
        let worst = used
            .iter()
            .zip(&gains)
            .filter(|(&k, g)| signs[k] * **g < 0.0)
            .map(|(&k, _)| k)
            .next();
        match worst {
            Some(k) => active.retain(|&a| a != k),
            None => {
                let mut all = vec![0.0; columns.len()];
                for (&k, &g) in used.iter().zip(&gains) {
                    all[k] = g;
                }
                return Linear {
                    gains: all,
                    basis: span,
                    tied: Vec::new(),
                };
            }
        }
    }
}
