//! Input stages: their effect on every column, by differences.

use super::{raw_columns, raw_columns_knowing, Beforehand, Moves, RawColumns};
use crate::model::structure::{FitTerm, Free, Role, Structure, TermId};
use crate::problem::{Prepared, Stretch};
use std::ops::Range;
use std::sync::Arc;

/// The contribution of an input stage to the output of a fitted model.
#[must_use]
pub fn series_column(
    data: &Prepared,
    structure: &Structure,
    (free, values): (&[Free], &[f64]),
    gains: &[f64],
    term: &FitTerm,
) -> Option<Vec<f64>> {
    let mut with = structure.clone();
    with.terms.push(*term);
    let output = |structure: &Structure| -> Option<Vec<f64>> {
        Some(raw_columns(data, structure, free, values)?.output(gains))
    };
    let (with, without) = (output(&with)?, output(structure)?);
    Some(with.iter().zip(&without).map(|(a, b)| a - b).collect())
}

/// The columns before the output stages.
pub(crate) fn early(raw: &RawColumns) -> &[Arc<Stretch>] {
    match raw.stages.before.is_empty() {
        true => &raw.columns,
        false => &raw.stages.before,
    }
}

/// The columns before the output stages, a step up and down in some of the free parameters.
struct Difference {
    up: RawColumns,
    down: RawColumns,
    step: f64,
}

impl Difference {
    /// Around the columns `here`; only parameters of input stages may move.
    fn of(
        here: &RawColumns,
        data: &Prepared,
        structure: &Structure,
        (free, values): (&[Free], &[f64]),
        step: f64,
        is_moved: impl Fn(usize, Role) -> bool,
    ) -> Option<Self> {
        let known = Beforehand {
            last: Some(here),
            behind_input: true,
            ..Beforehand::default()
        };
        let at = |sign: f64| {
            let all = free.iter().zip(values).enumerate();
            let moved = all.map(|(j, (f, value))| match is_moved(j, f.role) {
                true => value + sign * step,
                false => *value,
            });
            let moved: Vec<f64> = moved.collect();
            raw_columns_knowing(data, structure, free, &moved, known)
        };
        Some(Self {
            up: at(1.0)?,
            down: at(-1.0)?,
            step,
        })
    }

    /// The slopes on some samples of the columns that move there.
    fn slopes(&self, samples: &Range<usize>) -> Vec<(usize, Stretch)> {
        let pairs = self.up.columns.iter().zip(&self.down.columns).enumerate();
        let pairs = pairs.filter(|(_, (a, b))| !Arc::ptr_eq(a, b));
        let moving = pairs.filter_map(|(k, (a, b))| {
            let (a, b) = (a.cut(samples.clone()), b.cut(samples.clone()));
            let pairs = a.values().iter().zip(b.values());
            let slope = pairs.map(|(a, b)| (a - b) / (2.0 * self.step));
            (a != b).then(|| (k, Stretch::at(a.range().start, slope.collect())))
        });
        moving.collect()
    }
}

impl Moves {
    /// Adds the slopes in the shapes and states of the input stages.
    ///
    /// The state at the start of a record affects that record alone, so one difference over all
    /// records gives the slopes in the states of all of them.
    pub(super) fn add_series(
        &mut self,
        here: &RawColumns,
        data: &Prepared,
        structure: &Structure,
        (free, values): (&[Free], &[f64]),
    ) -> Option<()> {
        let is_input_stage = |term: TermId| {
            let own = structure.terms.find(term);
            own.is_some_and(|own| own.effect.is_input_stage())
        };
        let mut of_starts: Option<(TermId, Difference)> = None;
        for (j, f) in free.iter().enumerate() {
            match f.role {
                Role::Shape { term, .. } if is_input_stage(term) => {
                    let step = 1e-5 * values[j].abs().max(1e-9);
                    let at = (free, values);
                    let own = Difference::of(here, data, structure, at, step, |i, _| i == j)?;
                    self.0[j].extend(own.slopes(&(0..data.work_len())));
                }
                Role::Start { term, record } if is_input_stage(term) => {
                    if of_starts.as_ref().is_none_or(|(of, _)| *of != term) {
                        let step = 1e-5 * data.input.reach;
                        let is_start =
                            |_, role| matches!(role, Role::Start { term: of, .. } if of == term);
                        let at = (free, values);
                        let all = Difference::of(here, data, structure, at, step, is_start)?;
                        of_starts = Some((term, all));
                    }
                    let (_, all) = of_starts.as_ref()?;
                    self.0[j].extend(all.slopes(&data.pieces.get(record)?.work));
                }
                _ => {}
            }
        }
        Some(())
    }
}
