//! Output stages: they act on the sum of all columns, so each acts on every column alike.

use super::abreast;
use super::{weighted, RawColumns};
use crate::model::structure::{FitTerm, Free, Role, Terms};
use crate::problem::filter::BLOCK;
use crate::problem::{is_silent, Prepared, Stretch};
use bowden::effect::{Effect, EffectState, Inputs};
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

    /// The stages among the terms, each with its gain; `None` if a gain is not given.
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

    /// Passes columns through some of the stages; a column that is zero on a record stays zero
    /// there.
    pub(super) fn through<'a>(
        &self,
        columns: impl IntoIterator<Item = &'a mut Stretch>,
        which: Range<usize>,
    ) {
        let stages = &self.list[which];
        if stages.is_empty() {
            return;
        }
        let mut columns: Vec<&mut Stretch> = columns.into_iter().collect();
        for (term, gain) in stages {
            for record in &self.records {
                let own = columns.iter_mut().filter_map(|column| {
                    let own = column.range();
                    let place = record.start.checked_sub(own.start)?..record.end - own.start;
                    column.values_mut().get_mut(place)
                });
                apply_stage(&term.effect, *gain, &mut own.collect::<Vec<_>>(), self.dt);
            }
        }
    }

    fn apply(&self, effect: &Effect<f64>, gain: f64, column: &mut [f64]) {
        for record in &self.records {
            apply_stage(effect, gain, &mut [&mut column[record.clone()]], self.dt);
        }
    }

    /// The regressor of a stage: its slope in the gain at a gain of zero.
    pub(super) fn alone(&self, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
        let mut column = output.to_vec();
        for record in &self.records {
            in_blocks(&mut column[record.clone()], |state, block| {
                let mut own = block.iter();
                let take = |value| put(own.next(), |_| value);
                effect.regressors(state, samples(block, self.dt), take);
            });
        }
        column
    }

    /// The slope of a stage in its gain; except for a delay, it is the same at every gain.
    fn slope(&self, effect: &Effect<f64>, gain: f64, output: &[f64]) -> Vec<f64> {
        if effect.name() != "delay" {
            return self.alone(effect, output);
        }
        // A central difference has a relative error of 1e-8, and loses as many digits to rounding.
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

/// Adds the contribution of the stage at this gain, along one record, to each column.
fn apply_stage(effect: &Effect<f64>, gain: f64, columns: &mut [&mut [f64]], dt: f64) {
    if abreast::through(effect, gain, columns, dt) {
        return;
    }
    for column in columns {
        in_blocks(column, |state, block| {
            let mut own = block.iter();
            let add = |part| put(own.next(), |output| output + part);
            effect.contributions(gain, state, samples(block, dt), add);
        });
    }
}

/// Runs a stage over a record block by block, and clears its memory where the column is zero: as in
/// the filter, the memory would decay to denormal floats.
fn in_blocks(record: &mut [f64], mut through: impl FnMut(&mut EffectState<f64>, &[Cell<f64>])) {
    let is_all_silent = |block: &[Cell<f64>]| block.iter().all(|v| is_silent(v.get()));
    let mut state = EffectState::default();
    let mut rest = Cell::from_mut(record).as_slice_of_cells();
    while !rest.is_empty() {
        let (block, next) = rest.split_at(BLOCK.min(rest.len()));
        let had_input = !is_all_silent(block);
        through(&mut state, block);
        // A stage that has seen no sample takes the first one for what has always been.
        let has_input = next.first().is_some_and(|v| !is_silent(v.get()));
        if !had_input && !has_input && is_all_silent(block) {
            block.iter().for_each(|v| v.set(0.0));
            state = EffectState::default();
        }
        rest = next;
    }
}

/// The part of a block that an output stage reads. Each sample is read just before it is replaced.
fn samples(block: &[Cell<f64>], dt: f64) -> impl Iterator<Item = Inputs<f64>> + '_ {
    block.iter().map(move |output| Inputs {
        dt,
        output: output.get(),
        ..Inputs::default()
    })
}

/// Replaces one sample of a block.
fn put(slot: Option<&Cell<f64>>, change: impl FnOnce(f64) -> f64) {
    if let Some(slot) = slot {
        slot.set(change(slot.get()));
    }
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
        self.stages.through([&mut output], 0..position);
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
        self.stages.through([&mut part], position + 1..list.len());
        tangent.add(&part, 1.0);
    }
}

/// The change made by each output stage, in order.
pub(crate) fn by_stage(raw: &RawColumns, output: Vec<f64>) -> Vec<Vec<f64>> {
    let mut output = Stretch::from(output);
    let mut changes = Vec::with_capacity(raw.stages.list.len());
    for stage in 0..raw.stages.list.len() {
        let before = output.clone();
        raw.stages.through([&mut output], stage..stage + 1);
        let change = output
            .values()
            .iter()
            .zip(before.values())
            .map(|(after, before)| after - before);
        changes.push(change.collect());
    }
    changes
}

#[cfg(test)]
mod tests {
    use super::*;
    use bowden::effect::Delay;

    const DT: f64 = 0.01;

    /// A column that is zero for `silence` samples, between two stretches on which it is not.
    fn interrupted(silence: usize) -> Vec<f64> {
        let wave = |i: i32| 3.0 + (0.3 * f64::from(i)).sin();
        let rest = std::iter::repeat_n(0.0, silence);
        (0..100)
            .map(wave)
            .chain(rest)
            .chain((0..100).map(wave))
            .collect()
    }

    fn stages() -> impl Iterator<Item = (Effect<f64>, f64)> {
        // From a decay within a few samples to one over a hundred, and one that alternates.
        let lags = [0.004, 0.02, 1.0].map(|tau| Effect::try_from_name("lag", &[tau]).unwrap());
        let lags = lags.into_iter().flat_map(|lag| [(lag, 1.0), (lag, 0.3)]);
        let delays = [-0.004, 0.003, 0.01, 0.035].map(|gain| (Effect::from(Delay), gain));
        lags.chain(delays)
    }

    #[test]
    fn blocks_change_nothing_but_what_is_silent() {
        // The second stretch begins at each place of a block.
        for silence in 6000..6000 + BLOCK {
            for (effect, gain) in stages() {
                let column = interrupted(silence);
                let mut state = EffectState::default();
                let expected = column.iter().map(|&output| {
                    let at = Inputs {
                        dt: DT,
                        output,
                        ..Inputs::default()
                    };
                    output + effect.contribution(gain, &mut state, &at)
                });
                let expected: Vec<f64> = expected.collect();
                let mut staged = column.clone();
                apply_stage(&effect, gain, &mut [&mut staged], DT);
                for (i, (a, b)) in staged.iter().zip(&expected).enumerate() {
                    let is_equal = a == b || is_silent(*a) && is_silent(*b);
                    assert!(
                        is_equal,
                        "{effect:?} {gain}, {silence}, at {i}: {a}, not {b}"
                    );
                }
            }
        }
    }

    #[test]
    fn columns_abreast_come_out_bit_for_bit_as_one_by_one() {
        let wave = |k: usize, i: usize| (0.01 * ((k + 3) * i) as f64).sin() - 0.2 * k as f64;
        for (effect, gain) in stages() {
            for (count, samples) in [(1, 700), (3, 1), (8, 256), (11, 700)] {
                let mut columns: Vec<Vec<f64>> = (0..count)
                    .map(|k| (0..samples).map(|i| wave(k, i)).collect())
                    .collect();
                // One that the core alone keeps finite.
                if count == 3 {
                    columns[1][0] = f64::MAX;
                }
                let one_by_one: Vec<Vec<f64>> = columns
                    .iter()
                    .map(|column| {
                        let mut state = EffectState::default();
                        let late = column.iter().map(|&output| {
                            let at = Inputs {
                                dt: DT,
                                output,
                                ..Inputs::default()
                            };
                            output + effect.contribution(gain, &mut state, &at)
                        });
                        late.collect()
                    })
                    .collect();
                let mut abreast: Vec<&mut [f64]> =
                    columns.iter_mut().map(Vec::as_mut_slice).collect();
                apply_stage(&effect, gain, &mut abreast, DT);
                let bits = |all: &[Vec<f64>]| -> Vec<u64> {
                    all.iter().flatten().map(|v| v.to_bits()).collect()
                };
                assert_eq!(bits(&columns), bits(&one_by_one), "{effect:?} {gain}");
            }
        }
    }

    #[test]
    fn where_a_column_is_silent_a_stage_leaves_nothing_denormal() {
        for (effect, gain) in stages() {
            let mut column = interrupted(200_000);
            apply_stage(&effect, gain, &mut [&mut column], DT);
            let denormal = column.iter().filter(|v| v.is_subnormal()).count();
            // A decay may reach them within the block in which it becomes silent.
            assert!(denormal <= BLOCK, "{effect:?} {gain}: {denormal}");
            assert_eq!(column[150_000], 0.0, "{effect:?} {gain}");
        }
    }
}
