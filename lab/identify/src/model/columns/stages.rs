//! Output stages: they act on the sum of all columns, so each acts on every column alike.

use super::{weighted, RawColumns};
use crate::model::structure::{FitTerm, Free, Role, Terms};
use crate::problem::{Prepared, Stretch};
use bowden::effect::{Effect, EffectState, Situation};
use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

/// The output stages, which act on every column alike.
pub(super) struct Stages {
    pub(super) list: Vec<(FitTerm, f64)>,
    dt: f64,
    /// The records on the work grid.
    records: Vec<Range<usize>>,
    /// The columns before the stages; empty where there is no stage.
    pub(super) before: Vec<Arc<Stretch>>,
    /// Which free parameter belongs to which stage: its gain, or one of its shapes.
    pub(super) owner: Vec<Option<(usize, Option<usize>)>>,
}

impl Stages {
    pub(super) fn none(data: &Prepared) -> Self {
        Self {
            list: Vec::new(),
            dt: data.dt,
            records: data.pieces.iter().map(|p| p.work.clone()).collect(),
            before: Vec::new(),
            owner: Vec::new(),
        }
    }

    /// Those among the terms, each with its gain; `None` where a gain is not given.
    pub(super) fn of(
        data: &Prepared,
        terms: &Terms,
        free: &[Free],
        values: &[f64],
    ) -> Option<Self> {
        let mut stages = Self {
            owner: vec![None; free.len()],
            ..Self::none(data)
        };
        let output_stages = terms.with_ids();
        for (id, term) in output_stages.filter(|(_, t)| t.effect.is_output_stage()) {
            let place = stages.list.len();
            let mut own_gain = None;
            for ((slot, f), &value) in stages.owner.iter_mut().zip(free).zip(values) {
                match f.role {
                    Role::Stage { term } if term == id => {
                        own_gain = Some(value);
                        *slot = Some((place, None));
                    }
                    Role::Shape { term, index } if term == id => {
                        *slot = Some((place, Some(index)));
                    }
                    _ => {}
                }
            }
            stages.list.push((*term, own_gain?));
        }
        Some(stages)
    }

    /// Sends a column through some of the stages; on a record on which it is zero it stays so.
    pub(super) fn through(&self, column: &mut Stretch, which: Range<usize>) {
        let own = column.range();
        for (term, gain) in &self.list[which] {
            for record in &self.records {
                if own.start <= record.start && record.end <= own.end {
                    let place = record.start - own.start..record.end - own.start;
                    apply_stage(
                        &term.effect,
                        *gain,
                        &mut column.values_mut()[place],
                        self.dt,
                    );
                }
            }
        }
    }

    fn apply(&self, effect: &Effect<f64>, gain: f64, column: &mut [f64]) {
        for record in &self.records {
            apply_stage(effect, gain, &mut column[record.clone()], self.dt);
        }
    }

    /// The regressor of a stage: its slope in the gain at a gain of zero.
    pub(super) fn alone(&self, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
        let mut column = Vec::with_capacity(output.len());
        for record in &self.records {
            let samples = output[record.clone()].iter();
            let samples = samples.map(|&output| sample(self.dt, output));
            let push = |value| column.push(value);
            effect.regressors(&mut EffectState::default(), samples, push);
        }
        column
    }

    /// The slope of a stage in its gain; of all but a delay it is the same at every gain.
    fn slope(&self, effect: &Effect<f64>, gain: f64, output: &[f64]) -> Vec<f64> {
        if *effect != Effect::Delay {
            return self.alone(effect, output);
        }
        // A central difference errs by a share of 1e-8, and loses as many digits to rounding.
        let h = 1e-4 * gain.abs().max(self.dt);
        let at = |gain: f64| {
            let mut column = output.to_vec();
            self.apply(effect, gain, &mut column);
            column
        };
        let pairs = at(gain + h).into_iter().zip(at(gain - h));
        pairs.map(|(up, down)| (up - down) / (2.0 * h)).collect()
    }
}

/// One sample of what an output stage reads.
fn sample(dt: f64, output: f64) -> Situation<f64> {
    Situation {
        dt,
        output,
        ..Situation::default()
    }
}

/// output += what the stage adds at that gain, along one record.
fn apply_stage(effect: &Effect<f64>, gain: f64, column: &mut [f64], dt: f64) {
    let column = Cell::from_mut(column).as_slice_of_cells();
    let samples = column.iter().map(|output| sample(dt, output.get()));
    // Each sample is read just before its own part is added.
    let mut own = column.iter();
    let add = |part| {
        if let Some(value) = own.next() {
            value.set(value.get() + part);
        }
    };
    effect.contributions(gain, &mut EffectState::default(), samples, add);
}

impl RawColumns {
    /// The part of a tangent that comes from an output stage's own gain or shape.
    pub(super) fn add_stage_tangent(
        &self,
        tangent: &mut Stretch,
        gains: &[f64],
        position: usize,
        shape: Option<usize>,
    ) {
        let Stages { list, before, .. } = &self.stages;
        let before = before.iter().map(Arc::as_ref);
        let mut output = Stretch::from(weighted(before, gains, self.eta.len()));
        self.stages.through(&mut output, 0..position);
        let output = output.values();
        let (term, gain) = &list[position];
        let part: Vec<f64> = match shape {
            None => self.stages.slope(&term.effect, *gain, output),
            Some(index) => {
                let value = term.effect.shape(index).unwrap_or(0.0);
                let h = 1e-5 * value.abs().max(1e-9);
                let (Ok(up), Ok(down)) = (
                    term.effect.with_shape(index, value + h),
                    term.effect.with_shape(index, value - h),
                ) else {
                    return;
                };
                let (up, down) = (
                    self.stages.alone(&up, output),
                    self.stages.alone(&down, output),
                );
                up.iter()
                    .zip(&down)
                    .map(|(a, b)| gain * (a - b) / (2.0 * h))
                    .collect()
            }
        };
        let mut part = Stretch::from(part);
        self.stages.through(&mut part, position + 1..list.len());
        tangent.add(&part, 1.0);
    }
}

/// What each output stage changes, in their order.
pub(crate) fn by_stage(raw: &RawColumns, output: Vec<f64>) -> Vec<Vec<f64>> {
    let mut output = Stretch::from(output);
    let mut changes = Vec::with_capacity(raw.stages.list.len());
    for stage in 0..raw.stages.list.len() {
        let before = output.clone();
        raw.stages.through(&mut output, stage..stage + 1);
        let change = output
            .values()
            .iter()
            .zip(before.values())
            .map(|(after, before)| after - before);
        changes.push(change.collect());
    }
    changes
}
