//! The columns of the regression, computed by the core itself.
//!
//! The functions that run in firmware compute every column: the hysteresis from
//! [`bowden::hysteresis::BoucWen`], the effects from [`bowden::effect::Effect`].
//!
//! If several records follow one another, every state restarts in each. Time counts from the
//! beginning of each record, because a rig warms up anew. Only for the preload step does time count
//! from the first record: a clamp that has slipped stays slipped in the next record.

use crate::model::kind::is_stage;
use crate::model::structure::{FitTerm, Free, Role, Structure, TermId, Terms};
use crate::model::Variable;
use crate::problem::{Channel, Piece, Prepared, Stretch};
use bowden::effect::{Effect, EffectState, Inputs, Motion};
use bowden::hysteresis::{BoucWen, Sensitivity};
use gathered::Gathered;
use loops::{seen, trace, trajectory};
use rayon::prelude::*;
use stages::Stages;
use std::sync::Arc;
use variation::Variation;

mod abreast;
mod gathered;
mod loops;
mod series;
mod stages;
mod variation;

pub(crate) use series::early;
pub use series::series_column;
pub(crate) use stages::by_stage;

/// Columns on the work grid, before the filter.
pub struct RawColumns {
    /// One per linear gain: input, eta, constant, then the effects.
    pub columns: Vec<Arc<Stretch>>,
    /// Whether a column is the same for all values of the free parameters.
    pub fixed: Vec<bool>,
    /// The hysteresis state.
    pub eta: Vec<f64>,
    /// The structure at these values.
    terms: Terms,
    /// The hysteresis, and its state at the start of each record.
    shape: Option<(BoucWen<f64>, Vec<f64>)>,
    /// The hysteresis with its slopes, if they were computed with it.
    trajectory: Option<Vec<Sensitivity<f64>>>,
    /// The input behind the input stages.
    seen: Vec<f64>,
    stages: Stages,
}

/// What is already known of the requested columns.
#[derive(Clone, Copy, Default)]
pub(crate) struct Beforehand<'a> {
    /// The columns for other values of the same free parameters: those that are the same
    /// for all values are taken from there.
    pub(crate) last: Option<&'a RawColumns>,
    /// Whether the slopes will be requested as well: they are computed in one pass with the value.
    pub(crate) slopes: bool,
    /// Whether only parameters of input stages differ from those of `last`, and the columns
    /// are asked for as they are before the output stages.
    pub(crate) behind_input: bool,
}

/// The dependence of the columns on each free parameter: which columns, and their slopes.
pub struct Moves(Vec<Vec<(usize, Stretch)>>);

/// The regressor of a stage: its contribution for a small gain, divided by this gain.
#[must_use]
pub fn stage_column(data: &Prepared, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
    Stages::none(data).alone(effect, output)
}

/// The regressor of one effect along the work grid; `None` if its channel is missing.
#[must_use]
pub fn effect_column(data: &Prepared, term: &FitTerm, eta: &[f64]) -> Option<Vec<f64>> {
    if let [piece] = &data.pieces[..] {
        return effect_on(data, term, 0, &eta[piece.work.clone()]);
    }
    let of =
        |(record, piece): (usize, &Piece)| effect_on(data, term, record, &eta[piece.work.clone()]);
    let all: Option<Vec<_>> = data.pieces.par_iter().enumerate().map(of).collect();
    Some(all?.concat())
}

/// The same on one of the records, along which the hysteresis is `eta`.
fn effect_on(data: &Prepared, term: &FitTerm, record: usize, eta: &[f64]) -> Option<Vec<f64>> {
    let channel = data.channel(term.source)?;
    let piece = data.pieces.get(record)?;
    let load = match (data.mode, data.load) {
        (_, Some(i)) => Some(&data.channels[i].motion),
        (crate::record::Mode::Torque, None) => Some(&data.input.motion),
        (crate::record::Mode::Displacement, None) => None,
    };
    let mut state = before(data, term, channel, record, piece);
    // A moment counts from the first record on.
    let since = match term.has_moment() {
        true => piece.since,
        false => 0.0,
    };
    let at = |(k, i): (usize, usize)| {
        let motion = &channel.motion[i];
        Inputs {
            dt: data.dt,
            time: since + k as f64 * data.dt,
            motion: Motion {
                position: motion.position - term.origin,
                ..*motion
            },
            input: data.input.motion[i],
            load: load.map_or(0.0, |l| l[i].position),
            eta: eta[k],
            output: 0.0,
        }
    };
    let samples = piece.work.clone().enumerate().map(at);
    let mut column = Vec::with_capacity(eta.len());
    let push = |value| column.push(value);
    term.effect.regressors(&mut state, samples, push);
    Some(column)
}

/// The memory of an effect at the beginning of a record.
fn before(
    data: &Prepared,
    term: &FitTerm,
    channel: &Channel,
    record: usize,
    piece: &Piece,
) -> EffectState<f64> {
    let mut state = EffectState::default();
    if !term.has_past() || piece.work.is_empty() {
        return state;
    }
    let first = &channel.motion[piece.work.start];
    let start = term.start.get(record).copied().unwrap_or(0.0);
    let at = Inputs {
        dt: data.dt,
        motion: Motion {
            position: first.position - term.origin - start,
            ..*first
        },
        input: data.input.motion[piece.work.start],
        ..Inputs::default()
    };
    term.effect.regressor(&mut state, &at);
    state
}

/// All columns for the given values of the free parameters.
///
/// `None` if a shape is outside the range that the core admits.
#[must_use]
pub fn raw_columns(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: &[f64],
) -> Option<RawColumns> {
    raw_columns_knowing(data, structure, free, values, Beforehand::default())
}

/// As [`raw_columns`], bit for bit, for less where something is known beforehand.
pub(crate) fn raw_columns_knowing(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: &[f64],
    known: Beforehand<'_>,
) -> Option<RawColumns> {
    let terms = structure.terms.at(free, values)?;
    let mut gathered = Gathered::after(known.last, structure.linear());
    let seen = seen(data, &terms)?;
    let mut eta = vec![0.0; data.work_len()];
    let (mut shape, mut sensitivities) = (None, None);
    if structure.hysteresis {
        let (bouc_wen, eta0) = hysteresis(data, free, values)?;
        // In closed form the value has slopes of another step.
        if known.slopes && ![1.0, 2.0].contains(&bouc_wen.n()) {
            let all = trajectory(data, &seen, &bouc_wen, &eta0);
            for (slot, state) in eta.iter_mut().zip(&all) {
                *slot = state.eta;
            }
            sensitivities = Some(all);
        } else {
            trace(data, &seen, &bouc_wen, &eta0, &mut eta);
        }
        let staged = terms.iter().any(|t| t.effect.is_input_stage());
        for record in 0..structure.own_gains.max(1) {
            let own = |column: &[f64]| Some(of_record(data, structure, column, record));
            gathered.push(!staged, || own(&seen))?;
            gathered.push(false, || own(&eta))?;
            gathered.push(true, || own(&vec![1.0; eta.len()]))?;
        }
        shape = Some((bouc_wen, eta0));
    }
    for (id, term) in terms.with_ids().filter(|(_, t)| t.is_linear()) {
        let is_held = known.behind_input || !is_searched(free, id);
        let fixed = !term.effect.reads_eta() && is_held;
        gathered.push(fixed, || Some(effect_column(data, term, &eta)?.into()))?;
    }
    if let Some(table) = &structure.table {
        // Its slopes in eta's parameters are left out: a search needs them only roughly.
        let fixed = table.variable != Variable::Eta;
        let columns = || Some(table.columns(data, &eta)?.into_iter().map(Stretch::from));
        gathered.push_all(fixed, table.shapes.len(), || Some(columns()?.collect()))?;
    }
    let Gathered {
        mut columns,
        mut fixed,
        ..
    } = gathered;
    let mut stages = match known.behind_input {
        true => Stages::none(data),
        false => Stages::of(data, &terms, free, values)?,
    };
    if !stages.list.is_empty() {
        stages.before = columns.clone();
        fixed.fill(false);
        stages.through(columns.iter_mut().map(Arc::make_mut), 0..stages.list.len());
    }
    Some(RawColumns {
        columns,
        fixed,
        eta,
        terms,
        shape,
        trajectory: sensitivities,
        seen,
        stages,
    })
}

/// The hysteresis at the values of its free parameters, and its state at each beginning.
fn hysteresis(data: &Prepared, free: &[Free], values: &[f64]) -> Option<(BoucWen<f64>, Vec<f64>)> {
    let value = |role: Role| free.iter().position(|f| f.role == role).map(|i| values[i]);
    let shape = BoucWen::try_new(value(Role::Rho)?, value(Role::Sigma)?, value(Role::N)?).ok()?;
    // What nobody has fitted (a record that is held out) begins in the middle.
    let eta0 = |record| value(Role::Eta0 { record }).unwrap_or(0.0);
    Some((shape, (0..data.pieces.len()).map(eta0).collect()))
}

/// Whether the column of a linear term depends on one of the term's free parameters.
fn is_searched(free: &[Free], term: TermId) -> bool {
    free.iter().any(|f| f.role.term() == Some(term))
}

/// A column of the transmission: on all records, or on one record if the gains are separate.
fn of_record(data: &Prepared, structure: &Structure, column: &[f64], record: usize) -> Stretch {
    if structure.own_gains == 0 {
        return column.to_vec().into();
    }
    let work = data.pieces.get(record).map_or(0..0, |p| p.work.clone());
    Stretch::at(work.start, column[work].to_vec())
}

/// The sum of columns times gains, `n` samples long.
pub(crate) fn weighted<'a>(
    columns: impl IntoIterator<Item = &'a Stretch>,
    gains: &[f64],
    n: usize,
) -> Vec<f64> {
    let mut pairs = columns.into_iter().zip(gains);
    let mut sum: Vec<f64> = match pairs.next() {
        Some((column, gain)) => column.whole(n).iter().map(|c| gain * c).collect(),
        None => vec![0.0; n],
    };
    for (column, gain) in pairs {
        column.add_to(&mut sum, *gain);
    }
    sum
}

/// Step of a difference quotient, in the hysteresis state or as a share of a parameter's scale. For a
/// smooth column its error is about this share, plus 1e-9 of its size from rounding.
const STEP: f64 = 1e-7;

/// The slopes of a term's column in the hysteresis' free parameters, through eta.
///
/// An effect without memory has one slope in eta at each sample, which multiplies every
/// sensitivity. Otherwise the column is recomputed along each sensitivity, only on records on which
/// the sensitivity is not zero.
fn eta_slopes(
    data: &Prepared,
    term: &FitTerm,
    (column, eta): (&Stretch, &[f64]),
    sensitivities: &[(usize, Stretch)],
) -> Option<Vec<(usize, Stretch)>> {
    let in_eta = match term.effect.info().memory || sensitivities.is_empty() {
        true => None,
        false => {
            let moved: Vec<f64> = eta.iter().map(|e| e + STEP).collect();
            let mut up = effect_column(data, term, &moved)?;
            for (up, here) in up.iter_mut().zip(column.values()) {
                *up = (*up - here) / STEP;
            }
            Some(up)
        }
    };
    let along = |(j, sensitivity): &(usize, Stretch)| {
        let slope = match &in_eta {
            None => along(data, term, (column, eta), sensitivity)?,
            Some(in_eta) => {
                let range = sensitivity.range();
                let pairs = in_eta[range.clone()].iter().zip(sensitivity.values());
                Stretch::at(range.start, pairs.map(|(a, b)| a * b).collect())
            }
        };
        Some((*j, slope))
    };
    sensitivities.iter().map(along).collect()
}

/// d column / d parameter through eta, by a difference along its sensitivity.
fn along(
    data: &Prepared,
    term: &FitTerm,
    (column, eta): (&Stretch, &[f64]),
    sensitivity: &Stretch,
) -> Option<Stretch> {
    let values = sensitivity.values();
    let largest = values.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    if largest == 0.0 {
        return Some(sensitivity.map(|_| 0.0));
    }
    let h = STEP / largest;
    let range = sensitivity.range();
    let mut slope = Vec::with_capacity(range.len());
    for (record, piece) in data.pieces.iter().enumerate() {
        let own = sensitivity.on(&piece.work);
        if own.is_empty() {
            continue;
        }
        let pairs = eta[piece.work.clone()].iter().zip(own);
        let moved: Vec<f64> = pairs.map(|(e, s)| e + h * s).collect();
        let up = effect_on(data, term, record, &moved)?;
        slope.extend(
            up.iter()
                .zip(column.on(&piece.work))
                .map(|(a, b)| (a - b) / h),
        );
    }
    Some(Stretch::at(range.start, slope))
}

impl RawColumns {
    /// The derivatives of all columns with respect to all free parameters.
    #[must_use]
    pub fn moves(
        &self,
        data: &Prepared,
        structure: &Structure,
        free: &[Free],
        values: &[f64],
    ) -> Option<Moves> {
        let mut moves: Vec<Vec<(usize, Stretch)>> = vec![Vec::new(); free.len()];
        let sensitivities = self.sensitivities(data, free)?;
        let columns = early(self);
        let mut k = 0;
        if self.shape.is_some() {
            for (j, s) in &sensitivities {
                if structure.own_gains == 0 {
                    moves[*j].push((1, s.clone()));
                    continue;
                }
                for (record, piece) in data.pieces.iter().enumerate().take(structure.own_gains) {
                    let own = s.cut(piece.work.clone());
                    if !own.values().is_empty() {
                        moves[*j].push((3 * record + 1, own));
                    }
                }
            }
            k = structure.base();
        }
        for (id, term) in self.terms.with_ids() {
            if is_stage(&term.effect) {
                continue;
            }
            for (j, (f, &value)) in free.iter().zip(values).enumerate() {
                if let Some(variation) = Variation::of(id, f.role) {
                    let slope =
                        variation.slope(data, term, (f.range, value), (&columns[k], &self.eta))?;
                    moves[j].push((k, slope));
                }
            }
            if term.effect.reads_eta() {
                let own = (&*columns[k], &self.eta[..]);
                for (j, slope) in eta_slopes(data, term, own, &sensitivities)? {
                    moves[j].push((k, slope));
                }
            }
            k += 1;
        }
        let mut moves = Moves(moves);
        moves.add_series(self, data, structure, (free, values))?;
        Some(moves)
    }

    /// The slopes of the hysteresis in its free parameters, by the place of each parameter.
    fn sensitivities(&self, data: &Prepared, free: &[Free]) -> Option<Vec<(usize, Stretch)>> {
        let Some((shape, eta0)) = &self.shape else {
            return Some(Vec::new());
        };
        let own = match self.trajectory {
            Some(_) => None,
            None => Some(trajectory(data, &self.seen, shape, eta0)),
        };
        let trajectory = self.trajectory.as_ref().or(own.as_ref())?;
        let mut all = Vec::new();
        for (j, f) in free.iter().enumerate() {
            let pick: fn(&Sensitivity<f64>) -> f64 = match f.role {
                Role::Rho => |s| s.d_rho,
                Role::Sigma => |s| s.d_sigma,
                Role::N => |s| s.d_n,
                Role::Eta0 { .. } => |s| s.d_eta0,
                _ => continue,
            };
            let own = match f.role {
                // The state of one record moves no other.
                Role::Eta0 { record } => data.pieces.get(record).map_or(0..0, |p| p.work.clone()),
                _ => 0..trajectory.len(),
            };
            let slope = trajectory[own.clone()].iter().map(pick).collect();
            all.push((j, Stretch::at(own.start, slope)));
        }
        Some(all)
    }

    /// The output for the given gains, before the filter.
    #[must_use]
    pub fn output(&self, gains: &[f64]) -> Vec<f64> {
        weighted(self.columns.iter().map(Arc::as_ref), gains, self.eta.len())
    }

    /// d output / d free parameter for the given gains, before the filter, for each of them.
    #[must_use]
    pub fn tangents(&self, moves: &Moves, gains: &[f64]) -> Vec<Stretch> {
        let before = moves.0.iter().map(|own| {
            let mut tangent = Stretch::default();
            for (k, column) in own {
                tangent.add(column, gains[*k]);
            }
            tangent
        });
        let mut tangents: Vec<Stretch> = before.collect();
        self.stages
            .through(&mut tangents, 0..self.stages.list.len());
        for (tangent, owner) in tangents.iter_mut().zip(&self.stages.owner) {
            if let Some((position, shape)) = *owner {
                self.add_stage_tangent(tangent, gains, position, shape);
            }
        }
        tangents
    }
}
