//! A fit without some of its rows.

use crate::algebra::inverse;
use nalgebra::{DMatrix, DVector};

/// A parameter whose variance grows by more than this factor without one block is determined by
/// that block alone.
const ALONE: f64 = 30.0;

/// The change of each parameter if the rows with this score are left out and the others have this
/// Gram matrix; `None` if those rows alone determine the parameter, as the first rows determine
/// eta0.
///
/// Such a parameter is held fixed. If it were free, the rest of the record would determine it
/// poorly, and the other parameters would follow it, up to a hundred times as far.
pub(super) fn moved_without(
    rest: &DMatrix<f64>,
    score: &DVector<f64>,
    bread: &DMatrix<f64>,
) -> Vec<Option<f64>> {
    let mut moved = vec![None; score.len()];
    let mut free: Vec<usize> = (0..score.len()).collect();
    loop {
        let own = inverse(rest.select_rows(&free).select_columns(&free));
        // By how much the variance of each grows. Where they have no inverse, the one that the rest sees
        // least of is not among them.
        let grown = |k: usize| match &own {
            Some(own) => own[(k, k)] / bread[(free[k], free[k])],
            None => ALONE + 1.0 / rest[(free[k], free[k])].max(f64::MIN_POSITIVE),
        };
        let worst = (0..free.len()).max_by(|a, b| grown(*a).total_cmp(&grown(*b)));
        let alone = worst.filter(|k| grown(*k).is_nan() || grown(*k) > ALONE);
        match (alone, own) {
            (Some(k), _) => {
                free.remove(k);
            }
            (None, Some(own)) => {
                let steps = own * score.select_rows(&free);
                for (step, j) in steps.iter().zip(free) {
                    moved[j] = Some(*step);
                }
                return moved;
            }
            (None, None) => return moved,
        }
    }
}
