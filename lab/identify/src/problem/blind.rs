//! Stretches of a record without a measurement.

use crate::record::{self, Column, Defect, DefectKind, Record};
use std::borrow::Cow;
use std::ops::Range;

/// Spikes longer than this share of a period of the cut-off are excluded. For shorter spikes, the
/// error of a straight line is smaller than the part that the filter passes.
const LONG: f64 = 0.125;

/// Stretches without a measurement, which are excluded from the fit, each with its margin. The
/// error of a clipped top is small, and so is the part that the filter spreads beyond it; but a
/// line through a stuck stretch is as wrong as the ends of the record.
///
/// `period` and `edge` are in estimation samples, a period of the cut-off has `samples` of the
/// record.
pub(super) fn blind(
    record: &Record,
    (period, samples): (usize, f64),
    edge: usize,
) -> impl Iterator<Item = (Range<usize>, usize)> + '_ {
    record.defects.iter().flat_map(move |defect| {
        let spike = defect.kind == DefectKind::Spike;
        let guard = match defect.kind {
            DefectKind::Clipping | DefectKind::Spike => period,
            _ => edge,
        };
        let is_left_out = move |stretch: &&Range<usize>| match spike {
            true => stretch.len() as f64 > LONG * samples,
            false => defect.left_out,
        };
        let stretches = defect.samples.iter().filter(is_left_out);
        stretches.map(move |stretch| (stretch.clone(), guard))
    })
}

/// A column with a line through its spikes and through the stretches on which its sensor was stuck;
/// otherwise the filter would spread the jump at their end beyond them.
pub(super) fn bridged<'a>(record: &'a Record, column: &'a Column) -> Cow<'a, [f64]> {
    let stands_in = |d: &&Defect| matches!(d.kind, DefectKind::Stuck | DefectKind::Spike);
    let own = record.defects.iter().filter(stands_in);
    let own = own.filter(|d| d.channel == column.name);
    record::bridged(&column.values, own.flat_map(|d| &d.samples))
}
