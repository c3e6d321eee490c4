//! Stretches of a record that hold no measurement.

use crate::record::{Column, Defect, DefectKind, Record};
use std::borrow::Cow;
use std::ops::Range;

/// Stretches without a measurement, which are left out of the fit, each with how much
/// beside it goes with it: a clipped top is off by little, and so is what the filter
/// carries beyond it, but a line through a stuck stretch is as wrong as the record's ends.
pub(super) fn blind(
    record: &Record,
    period: usize,
    edge: usize,
) -> impl Iterator<Item = (Range<usize>, usize)> + '_ {
    let defects = record.defects.iter().filter(|defect| defect.left_out);
    defects.flat_map(move |defect| {
        let clipped = defect.kind == DefectKind::Clipping;
        let guard = if clipped { period } else { edge };
        defect
            .samples
            .iter()
            .map(move |stretch| (stretch.clone(), guard))
    })
}

/// A column with a line through the stretches where its sensor was stuck: else the filter
/// would carry the leap at their end beyond them.
pub(super) fn bridged<'a>(record: &Record, column: &'a Column) -> Cow<'a, [f64]> {
    let mut values = Cow::Borrowed(column.values.as_slice());
    let own = |d: &&Defect| d.kind == DefectKind::Stuck && d.channel == column.name;
    for stretch in record.defects.iter().filter(own).flat_map(|d| &d.samples) {
        let before = stretch.start.checked_sub(1).map(|i| column.values[i]);
        let after = column.values.get(stretch.end).copied();
        let (Some(from), Some(to)) = (before.or(after), after.or(before)) else {
            continue;
        };
        let steps = (stretch.len() + 1) as f64;
        for (k, value) in values.to_mut()[stretch.clone()].iter_mut().enumerate() {
            *value = from + (to - from) * (k + 1) as f64 / steps;
        }
    }
    values
}
