//! Slopes in closed form of effects that remember the motion before each record, and the column
//! of the one that is a low-pass.

use super::low_pass::LowPass;
use crate::model::structure::FitTerm;
use crate::problem::{Piece, Prepared};
use bowden::effect::Effect;
use bowden::Real;

/// Slopes in the effect's one shape, and in what it had moved just before each record.
pub(super) type Slopes = (Vec<f64>, Vec<f64>);

/// How far the channel had moved just before a record.
fn moved(term: &FitTerm, record: usize) -> f64 {
    term.start.get(record).copied().unwrap_or(0.0)
}

fn positions<'a>(
    data: &'a Prepared,
    term: &'a FitTerm,
    piece: &Piece,
) -> Option<impl Iterator<Item = f64> + use<'a>> {
    let motion = &data.channel(term.source)?.motion[piece.work.clone()];
    Some(motion.iter().map(|m| m.position - term.origin))
}

/// The level of a creep at the beginning of a record.
fn level(data: &Prepared, term: &FitTerm, record: usize, piece: &Piece) -> Option<f64> {
    let first = positions(data, term, piece)?.next()? - moved(term, record);
    term.has_past().then_some(first)
}

/// The column of a creep; `None` of another effect, and where a level is not finite.
pub(super) fn creep(data: &Prepared, term: &FitTerm) -> Option<Vec<f64>> {
    let Effect::Creep(own) = term.effect else {
        return None;
    };
    let low_pass = LowPass::new(own.tau(), data.dt);
    let mut all = Vec::with_capacity(data.work_len());
    for (record, piece) in data.pieces.iter().enumerate() {
        let start = level(data, term, record, piece);
        all.extend(low_pass.levels(start, positions(data, term, piece)?)?);
    }
    Some(all)
}

/// The slopes of an effect whose column is given; `None` where there is no closed form.
pub(super) fn slopes(data: &Prepared, term: &FitTerm, column: &[f64]) -> Option<Slopes> {
    if !term.has_past() {
        return None;
    }
    let capacity = || Vec::with_capacity(column.len());
    let mut all = (capacity(), capacity());
    for (record, piece) in data.pieces.iter().enumerate() {
        match term.effect {
            Effect::Creep(own) => {
                let low_pass = LowPass::new(own.tau(), data.dt);
                let start = level(data, term, record, piece);
                all.0
                    .extend(low_pass.slope(start, positions(data, term, piece)?));
                let left = low_pass.forgets(piece.work.len());
                all.1.extend(left.map(|left| -left));
            }
            Effect::PreslidingDahl(own) => {
                let positions = positions(data, term, piece)?;
                let values = column.get(piece.work.clone())?;
                dahl(own.r(), moved(term, record), positions, values, &mut all);
            }
            _ => return None,
        }
    }
    Some(all)
}

/// `z += (±1 − z)·(1 − exp(−|dx|/r))` along one record, whose values are given: the slopes in r
/// and in the first change, `start`, before which z is zero.
fn dahl(
    r: f64,
    start: f64,
    positions: impl Iterator<Item = f64>,
    values: &[f64],
    (by_r, by_start): &mut Slopes,
) {
    let (mut last, mut z, mut in_r, mut in_start) = (None, 0.0, 0.0, 0.0);
    for (x, &value) in positions.zip(values) {
        let change = last.map_or(start, |last| x - last);
        let left = Real::exp(-change.abs() / r);
        let end = if change < 0.0 { -1.0 } else { 1.0 };
        in_r = left * (in_r - (end - z) * change.abs() / (r * r));
        in_start = match last {
            None => left / r,
            Some(_) => left * in_start,
        };
        by_r.push(in_r);
        by_start.push(in_start);
        (last, z) = (Some(x), value);
    }
}
