//! Output stages: they act on the sum of all columns, so each acts on every column alike.

use super::low_pass::LowPass;
use super::{weighted, RawColumns};
use crate::model::structure::{FitTerm, Free, Role, Terms};
use crate::problem::Prepared;
use bowden::effect::{Effect, EffectState, Situation};
use std::ops::Range;
use std::sync::Arc;

/// The output stages, which act on every column alike.
pub(super) struct Stages {
    pub(super) list: Vec<(FitTerm, f64)>,
    dt: f64,
    /// The records on the work grid.
    records: Vec<Range<usize>>,
    /// The columns before the stages; empty where there is no stage.
    pub(super) before: Vec<Arc<Vec<f64>>>,
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

    pub(super) fn through(&self, column: &mut [f64], which: Range<usize>) {
        for (term, gain) in &self.list[which] {
            self.apply(&term.effect, *gain, column);
        }
    }

    fn apply(&self, effect: &Effect<f64>, gain: f64, column: &mut [f64]) {
        for record in &self.records {
            apply_stage(effect, gain, &mut column[record.clone()], self.dt);
        }
    }

    /// The slope in a shape of what a stage adds for a gain of one; no delay has a shape.
    fn slope_in_shape(
        &self,
        effect: &Effect<f64>,
        index: usize,
        output: &[f64],
    ) -> Option<Vec<f64>> {
        if let Effect::Lag(own) = effect {
            let low_pass = LowPass::new(own.tau(), self.dt);
            let along = |record: &Range<usize>| {
                low_pass.slope(None, output[record.clone()].iter().copied())
            };
            return Some(self.records.iter().flat_map(along).collect());
        }
        let value = effect.shape(index)?;
        let h = 1e-5 * value.abs().max(1e-9);
        let at = |value: f64| Some(self.alone(&effect.with_shape(index, value).ok()?, output));
        let (up, down) = (at(value + h)?, at(value - h)?);
        let pairs = up.iter().zip(&down);
        Some(pairs.map(|(a, b)| (a - b) / (2.0 * h)).collect())
    }

    /// The regressor of a stage: its slope in the gain at a gain of zero.
    pub(super) fn alone(&self, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
        let of = |record: &Range<usize>| along(effect, &output[record.clone()], self.dt);
        self.records.iter().flat_map(of).collect()
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

/// output += what the stage adds at that gain, along one record.
fn apply_stage(effect: &Effect<f64>, gain: f64, column: &mut [f64], dt: f64) {
    if *effect == Effect::Delay {
        let mut state = EffectState::default();
        let mut at = Situation {
            dt,
            ..Situation::default()
        };
        for value in column {
            at.output = *value;
            *value += effect.contribution(gain, &mut state, &at);
        }
        return;
    }
    let own = along(effect, column, dt);
    for (value, own) in column.iter_mut().zip(own) {
        *value += gain * own;
    }
}

/// The regressor of a stage along one record of what it acts on.
fn along(effect: &Effect<f64>, output: &[f64], dt: f64) -> Vec<f64> {
    if *effect == Effect::Delay && dt > 0.0 {
        // What is not finite the core leaves out or saturates.
        let late = late(output, dt);
        if late.iter().all(|v| v.is_finite()) {
            return late;
        }
    }
    if let Effect::Lag(own) = effect {
        let levels = LowPass::new(own.tau(), dt).levels(None, output.iter().copied());
        if let Some(mut levels) = levels {
            for (level, value) in levels.iter_mut().zip(output) {
                *level -= value;
            }
            return levels;
        }
    }
    let at = |&output: &f64| Situation {
        dt,
        output,
        ..Situation::default()
    };
    let mut all = Vec::with_capacity(output.len());
    let situations = output.iter().map(at);
    effect.regressors(&mut EffectState::default(), situations, |own| all.push(own));
    all
}

/// −d(output)/dt as the core's delay has it.
fn late(output: &[f64], dt: f64) -> Vec<f64> {
    let mut own = Vec::with_capacity(output.len());
    own.extend(output.first().map(|_| 0.0));
    own.extend(output.windows(2).map(|pair| (pair[0] - pair[1]) / dt));
    own
}

impl RawColumns {
    /// The part of a tangent that comes from an output stage's own gain or shape.
    pub(super) fn add_stage_tangent(
        &self,
        tangent: &mut [f64],
        gains: &[f64],
        position: usize,
        shape: Option<usize>,
    ) {
        let Stages { list, before, .. } = &self.stages;
        let before: Vec<&[f64]> = before.iter().map(|c| c.as_slice()).collect();
        let mut output = weighted(&before, gains, tangent.len());
        self.stages.through(&mut output, 0..position);
        let (term, gain) = &list[position];
        let mut part = match shape {
            None => self.stages.slope(&term.effect, *gain, &output),
            Some(index) => {
                let Some(slope) = self.stages.slope_in_shape(&term.effect, index, &output) else {
                    return;
                };
                slope.iter().map(|s| gain * s).collect()
            }
        };
        self.stages.through(&mut part, position + 1..list.len());
        for (t, p) in tangent.iter_mut().zip(part) {
            *t += p;
        }
    }
}

/// What each output stage changes, in their order.
pub(crate) fn by_stage(raw: &RawColumns, mut output: Vec<f64>) -> Vec<Vec<f64>> {
    let mut changes = Vec::with_capacity(raw.stages.list.len());
    for stage in 0..raw.stages.list.len() {
        let before = output.clone();
        raw.stages.through(&mut output, stage..stage + 1);
        let change = output
            .iter()
            .zip(&before)
            .map(|(after, before)| after - before);
        changes.push(change.collect());
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_are_those_of_the_core_bit_for_bit() {
        let smooth = |i: usize| (0.1 * i as f64).sin() + 0.3 * (0.037 * i as f64).cos();
        let mut output: Vec<f64> = (0..300).map(smooth).collect();
        for (name, shapes) in [("delay", &[][..]), ("lag", &[0.02]), ("lag", &[7.0])] {
            let effect = Effect::try_from_name(name, shapes).unwrap();
            for spoiled in [None, Some(f64::NAN), Some(f64::MAX)] {
                output[200] = spoiled.unwrap_or(output[200]);
                let mut state = EffectState::default();
                let step = |&output: &f64| {
                    let at = Situation {
                        dt: 0.01,
                        output,
                        ..Situation::default()
                    };
                    effect.regressor(&mut state, &at)
                };
                let expected: Vec<f64> = output.iter().map(step).collect();
                let own = along(&effect, &output, 0.01);
                assert_eq!(own, expected, "{name} {shapes:?} {spoiled:?}");
            }
            output[200] = smooth(200);
        }
    }
}
