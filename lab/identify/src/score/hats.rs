//! A curve over one variable as a term of the model: ten hat functions.
//!
//! Only the directions that the rest of the model does not span are kept: no data can separate a
//! curve from a constant or from a stiffness in the baseline.

use super::blocks::{blocks, flips};
use crate::algebra::{directions, whitening};
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::{Table, Variable};
use crate::problem::Prepared;
use crate::scale::TRACE;
use nalgebra::{DMatrix, DVector};

/// Hat functions of a curve that is tested.
pub(crate) const HATS: usize = 10;

/// Regression of a residual on a curve over one variable, to first order.
#[derive(Debug, Clone)]
pub(crate) struct Scored {
    pub(crate) table: Table,
    /// Share of the squared error.
    pub(crate) share: f64,
    /// Its directions with unit norm after projection off the model, and the projected residual.
    units: Vec<DVector<f64>>,
    residual: DVector<f64>,
}

impl Scored {
    /// Exact sign-flip p-value of the whole curve.
    pub(crate) fn p(&self, data: &Prepared) -> f64 {
        let of = |block: std::ops::Range<usize>| {
            let part = |u: &DVector<f64>| block.clone().map(|k| u[k] * self.residual[k]).sum();
            self.units.iter().map(part).collect()
        };
        let scores: Vec<Vec<f64>> = blocks(data).into_iter().map(of).collect();
        flips(&scores)
    }
}

/// Fits a curve over the variable to the residual of a model, projected off the span `moved`.
pub(crate) fn score(
    data: &Prepared,
    now: &Solution,
    moved: &Span,
    variable: Variable,
    count: usize,
) -> Option<Scored> {
    let hats = hats(data, now, variable, count)?;
    let columns = hats.columns(data, &now.eta)?;
    let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
    let raw: Vec<DVector<f64>> = data
        .filtered_all(&columns)
        .iter()
        .map(|column| rows(data, column))
        .collect();
    let whole = DMatrix::from_columns(&raw);
    let left: Vec<DVector<f64>> = raw.into_iter().map(|c| moved.off(c)).collect();
    let left = DMatrix::from_columns(&left);
    // Directions of unit norm before the projection.
    let root = whitening(whole.tr_mul(&whole))?;
    let inner = &root * left.tr_mul(&left) * root.transpose();
    let mut shapes = Vec::new();
    let mut units = Vec::new();
    for (rest, direction) in directions(inner, TRACE) {
        let weights = root.transpose() * direction;
        units.push(&left * &weights / rest.sqrt());
        shapes.push(weights.iter().copied().collect());
    }
    if shapes.is_empty() {
        return None;
    }
    let residual = moved.off(rows(data, &now.residual));
    let gain: f64 = units.iter().map(|u| u.dot(&residual).powi(2)).sum();
    Some(Scored {
        share: gain / residual.norm_squared(),
        units,
        residual,
        table: Table { shapes, ..hats },
    })
}

/// Hat functions with knots at the quantiles of the fit segment.
pub(crate) fn hats(
    data: &Prepared,
    now: &Solution,
    variable: Variable,
    count: usize,
) -> Option<Table> {
    let values = variable.values(data, &now.eta)?;
    let mut seen: Vec<f64> = data
        .split
        .fit
        .iter()
        .map(|&i| values[i * data.stride])
        .collect();
    seen.sort_by(f64::total_cmp);
    let (first, last) = (*seen.first()?, *seen.last()?);
    let mut knots: Vec<f64> = Vec::with_capacity(count);
    for k in 0..count {
        let at = seen[(seen.len() - 1) * k / (count - 1)];
        // If strokes rest at their ends, the quantiles accumulate there, and a curve that bends within a
        // few thousandths of the range encodes when the motion rests, not a position.
        let apart = knots
            .last()
            .is_none_or(|&k| at - k > TRACE * (last - first));
        if at.is_finite() && apart {
            knots.push(at);
        }
    }
    let n = knots.len();
    let unit = |k: usize| (0..n).map(|j| f64::from(u8::from(j == k))).collect();
    (n >= 4).then(|| Table {
        variable,
        shapes: (0..n).map(unit).collect(),
        knots,
    })
}

/// Whether a variable that starts again with each stroke encodes the phase of the stroke: then
/// all strokes are alike, and a curve over it would imitate anything periodic.
pub(crate) fn is_phase(data: &Prepared, now: &Solution, variable: Variable) -> bool {
    variable.is_local() && phase_share(data, now, variable).is_none_or(|share| share > PHASE)
}

/// A variable is a phase if curves over it explain more than this share of the directed
/// position and of the speed.
const PHASE: f64 = 0.8;

/// Explained share of the directed position or of the speed by a curve over the variable,
/// whichever is smaller.
fn phase_share(data: &Prepared, now: &Solution, variable: Variable) -> Option<f64> {
    let hats = hats(data, now, variable, HATS)?;
    let mut span = Span::default();
    for column in hats.columns(data, &now.eta)? {
        let thin: Vec<f64> = column.iter().step_by(data.stride).copied().collect();
        span.add(rows(data, &thin));
    }
    let channel = data.channel(variable.source())?;
    let told = |of: &dyn Fn(f64, f64) -> f64| {
        let all: Vec<f64> = channel
            .motion
            .iter()
            .step_by(data.stride)
            .map(|m| of(m.position - channel.middle, m.velocity))
            .collect();
        let column = rows(data, &all);
        let mean = column.mean();
        let column = column.map(|v| v - mean);
        let norm = column.norm_squared();
        1.0 - span.off(column).norm_squared() / norm
    };
    let place = told(&|x, v| if v < 0.0 { -x } else { x });
    let speed = told(&|_, v| v.abs());
    Some(place.min(speed))
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;
    use crate::fit::fit;
    use crate::model::declared::structure;
    use crate::problem::Preparation;
    use crate::record::{parse, Options};
    use bowden::model::Source;
    use std::f64::consts::TAU;
    use std::fmt::Write as _;

    /// 60 s at 100 Hz of a line over that motion, closed with a linear stiffness.
    fn line(motion: impl Fn(f64) -> f64) -> (Prepared, Solution) {
        let mut text = "t [s],x [mm],f [N]\n".to_owned();
        for i in 0..6000 {
            let t = f64::from(i) / 100.0;
            let x = motion(t);
            let _ = writeln!(text, "{t},{x},{}", 2.0 * x + 0.1 * (37.0 * t).sin());
        }
        let record = parse(text.as_bytes(), "line.csv", &Options::default()).unwrap();
        let cutoff = Some(8.0);
        let data = Prepared::new(&record, Preparation { cutoff }).unwrap();
        let declared = structure(&["stiffness-linear".to_owned()], &data).unwrap();
        let solution = fit(&data, &declared, None, 0.0).unwrap();
        (data, solution)
    }

    const LOCAL: [Variable; 2] = [
        Variable::ReversalDistance(Source::Input),
        Variable::ReversalTime(Source::Input),
    ];

    #[test]
    fn since_the_last_reversal_is_a_phase_where_all_strokes_are_alike() {
        let (data, now) = line(|t| 10.0 * (TAU * 0.7 * t).sin());
        for variable in LOCAL {
            assert!(is_phase(&data, &now, variable), "{variable:?}");
        }
        assert!(!is_phase(&data, &now, Variable::Position(Source::Input)));
    }

    #[test]
    fn since_the_last_reversal_is_no_phase_where_strokes_differ() {
        let (data, now) =
            line(|t| 6.0 * (TAU * 0.31 * t).sin() + 5.0 * (TAU * 0.83 * t + 1.0).sin());
        for variable in LOCAL {
            assert!(!is_phase(&data, &now, variable), "{variable:?}");
        }
    }

    #[test]
    fn a_table_is_the_line_through_its_knots_and_constant_beyond() {
        let (data, now) = line(|t| 10.0 * (TAU * 0.7 * t).sin());
        let table = Table {
            variable: Variable::Position(Source::Input),
            knots: vec![-5.0, 0.0, 5.0],
            shapes: vec![vec![1.0, 3.0, -1.0]],
        };
        let columns = table.columns(&data, &now.eta).unwrap();
        for (value, motion) in columns[0].iter().zip(&data.input.motion) {
            let x = motion.position;
            let expected = if x < 0.0 {
                3.0 + 0.4 * x.max(-5.0)
            } else {
                3.0 - 0.8 * x.min(5.0)
            };
            // Rounding of a few operations on numbers of order one.
            assert!((value - expected).abs() < 1e-12);
        }
    }

    #[test]
    fn hats_are_what_any_shapes_give() {
        let (data, now) = line(|t| 10.0 * (TAU * 0.7 * t).sin());
        let hats = hats(&data, &now, Variable::Position(Source::Input), 7).unwrap();
        let mut more = hats.clone();
        // With one shape that is no hat all are computed one by one.
        more.shapes.push(vec![2.0; hats.knots.len()]);
        let all = more.columns(&data, &now.eta).unwrap();
        assert_eq!(hats.columns(&data, &now.eta).unwrap(), all[..7]);
        assert!(all[7].iter().all(|v| *v == 2.0));
    }
}
