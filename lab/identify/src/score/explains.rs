//! How much of the output the input explains, and whether the output integrates it.
//!
//! A fit always reduces the error; that does not show that there is a model. This module divides
//! the output's variance on the held-out segment: how much does the measured *input* explain, how
//! much do the other channels add, and how much comes from functions of time alone, such as a tone
//! or a drift? The last part never counts as explained.

use crate::algebra::least_norm;
use crate::fit::{Segments, Solution};
use crate::model::Variable;
use crate::problem::{Channel, Prepared};
use crate::scale::{PART, QUARTER};
use bowden::effect::Quantity;
use bowden::model::Source;
use nalgebra::{DMatrix, DVector};
use serde::Serialize;

/// Ratio of the output's standard deviations on two segments above which a percentage on one
/// says little about the other.
pub const UNLIKE: f64 = 3.0;

/// Shares of the output's variance, each in \[0, 1\].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Explained {
    /// Share explained by a least-squares fit of the columns that read the input.
    pub input: f64,
    /// Further share explained by the columns that read other channels.
    pub channels: f64,
    /// Share of the terms that are functions of time alone: tone, drift, pretension.
    pub time: f64,
}

/// The signal that a linear column of a model reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reads {
    Input,
    Channel,
    Time,
}

fn of_source(source: Source) -> Reads {
    match source {
        Source::Input => Reads::Input,
        Source::Channel(_) => Reads::Channel,
    }
}

/// The signal that each linear column of a solution reads, in the order of its gains.
fn reads(solution: &Solution) -> Vec<Reads> {
    let structure = &solution.structure;
    let mut all = vec![Reads::Input; structure.base()];
    for term in structure.terms.iter().filter(|t| t.is_linear()) {
        all.push(match term.effect.info().reads {
            [Quantity::Time] => Reads::Time,
            _ => of_source(term.source),
        });
    }
    if let Some(table) = &structure.table {
        let own = match table.variable {
            Variable::Time => Reads::Time,
            other => of_source(other.source()),
        };
        all.resize(all.len() + structure.table_gains(), own);
    }
    all
}

/// Sum of squares about the mean over some rows.
fn spread(rows: &[usize], signal: &[f64]) -> f64 {
    let mean = rows.iter().map(|&i| signal[i]).sum::<f64>() / rows.len().max(1) as f64;
    rows.iter().map(|&i| (signal[i] - mean).powi(2)).sum()
}

fn squares(rows: &[usize], signal: &[f64]) -> f64 {
    rows.iter().map(|&i| signal[i] * signal[i]).sum()
}

/// Residual of the least-squares fit of columns and a constant to `target` on `rows`, evaluated
/// everywhere, and the columns' factors; dependent columns get the factors of least norm.
fn regression(rows: &[usize], columns: &[&[f64]], target: &[f64]) -> (Vec<f64>, Vec<f64>) {
    // At unit size, so that one relative threshold of the SVD serves all units.
    let size = |c: &[f64]| (squares(rows, c) / rows.len().max(1) as f64).sqrt();
    let scale: Vec<f64> = columns.iter().map(|c| size(c).max(1e-300)).collect();
    let n = columns.len();
    let x = DMatrix::from_fn(rows.len(), n + 1, |k, j| match columns.get(j) {
        Some(column) => column[rows[k]] / scale[j],
        None => 1.0,
    });
    let y = DVector::from_iterator(rows.len(), rows.iter().map(|&i| target[i]));
    // The threshold of rank is that of rounding over a record of 10^6 samples.
    let factors = least_norm(x, &y, 1e-10).unwrap_or_else(|| DVector::zeros(n + 1));
    let at = |i: usize| {
        let sum: f64 = (0..n).map(|j| factors[j] / scale[j] * columns[j][i]).sum();
        target[i] - sum - factors[n]
    };
    let left = (0..target.len()).map(at).collect();
    (left, (0..n).map(|j| factors[j] / scale[j]).collect())
}

/// Standard deviations of the filtered output on the fit and on the held-out segment.
#[must_use]
pub fn deviations(data: &Prepared) -> (f64, f64) {
    let own = Segments::deviation(data, &data.target);
    (own.fit, own.held_out)
}

/// Whether the output varies more than [`UNLIKE`] times as much on one segment, fit or held-out, as
/// on the other.
#[must_use]
pub fn segments_differ(data: &Prepared) -> bool {
    let (fit, held_out) = deviations(data);
    fit > UNLIKE * held_out || held_out > UNLIKE * fit
}

/// The shares on the held-out segment; on both segments together if the output varies
/// [`UNLIKE`] times less on the held-out segment than on the fit segment.
#[must_use]
pub fn explained(data: &Prepared, solution: &Solution) -> Explained {
    let (fit, held_out) = deviations(data);
    let mut rows = data.split.held_out.clone();
    if fit > UNLIKE * held_out {
        rows.extend(&data.split.fit);
    }
    explained_on(data, solution, &rows)
}

/// The shares on some rows.
#[must_use]
pub fn explained_on(data: &Prepared, solution: &Solution, rows: &[usize]) -> Explained {
    let reads = reads(solution);
    let mut timeless = data.target.clone();
    for ((column, gain), _) in solution
        .columns
        .iter()
        .zip(&solution.gains)
        .zip(&reads)
        .filter(|(_, reads)| **reads == Reads::Time)
    {
        column.add_to(&mut timeless, -gain);
    }
    let whole = spread(rows, &data.target).max(f64::MIN_POSITIVE);
    let rest = spread(rows, &timeless);
    let share = |left: f64| ((rest - left) / whole).clamp(0.0, 1.0);
    let total = share(squares(rows, &solution.residual));
    let columns = solution.columns.iter().zip(&reads);
    let input: Vec<_> = columns
        .filter(|(_, reads)| **reads == Reads::Input)
        .map(|(column, _)| column.whole(data.target.len()))
        .collect();
    let input: Vec<&[f64]> = input.iter().map(AsRef::as_ref).collect();
    let (left, _) = regression(&data.split.fit, &input, &timeless);
    let input = share(squares(rows, &left)).min(total);
    Explained {
        input,
        channels: total - input,
        time: ((whole - rest) / whole).clamp(0.0, 1.0),
    }
}

/// Whether the output follows the time integral of the input instead of the input itself, as the
/// angle of a motor follows the integral of its voltage.
///
/// A regression on \[1, t, x, integral of x\] is compared with those on \[1, t, x\] and on
/// \[1, t, x, rate of x\], and with the fitted model: a loop that opens with the motion leads, an
/// integral lags. A single tone cannot tell an integral from a rate of the opposite sign: then the
/// answer is no.
#[must_use]
pub fn integrates(data: &Prepared, declared: &Solution) -> bool {
    let rows = &data.split.fit;
    let column = |of: &dyn Fn(&Channel, usize) -> f64| {
        let work: Vec<f64> = (0..data.work_len()).map(|i| of(&data.input, i)).collect();
        data.filtered(&work)
    };
    let mut integral = vec![0.0; data.work_len()];
    for piece in &data.pieces {
        // About the middle of the range: a constant adds a line in time, which has a column.
        let mut sum = 0.0;
        for i in piece.work.clone() {
            sum += (data.input.motion[i].position - data.input.middle) * data.dt;
            integral[i] = sum;
        }
    }
    let integral = data.filtered(&integral);
    let x = column(&|input, i| input.motion[i].position);
    let v = column(&|input, i| input.motion[i].velocity);
    let t = column(&|_, i| i as f64 * data.dt);
    let left = |columns: &[&[f64]]| regression(rows, columns, &data.target).0;
    let by_input = left(&[&t, &x]);
    let by_rate = left(&[&t, &x, &v]);
    let by_integral = left(&[&t, &x, &integral]);
    let on_fit = |signal: &[f64]| squares(rows, signal);
    let whole = spread(rows, &data.target);
    let own = on_fit(&by_integral);
    let held_out = squares(&data.split.held_out, &by_integral);
    on_fit(&by_input) > 0.5 * whole
        && own <= PART * on_fit(&by_input)
        && own <= QUARTER * on_fit(&by_rate)
        && own <= QUARTER * on_fit(&declared.residual)
        && held_out <= QUARTER * squares(&data.split.held_out, &declared.residual)
}
