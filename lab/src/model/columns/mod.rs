//! The columns of the regression, computed by the core itself.
//!
//! Every column comes from the functions that run in firmware: the hysteresis from
//! [`bowden::hysteresis::Shape`], the effects from [`bowden::effect::Effect`].
//!
//! Where several records lie behind each other, every state begins anew with each. Time
//! is that since the record's beginning, as a rig warms up anew; only the step of the
//! pretension counts from the first record on: what has slipped stays so in the next one.

use crate::model::structure::{FitTerm, Free, Role, Structure};
use crate::model::Variable;
use crate::problem::{Channel, Piece, Prepared};
use bowden::effect::{Effect, EffectState, Family, Motion, Situation};
use bowden::hysteresis::{Sensitivity, Shape};
use loops::{seen, trace, trajectory};
use std::ops::Range;

mod loops;
mod series;

pub use series::series_column;
pub(crate) use series::{by_stage, early};

/// Columns on the work grid, before the filter.
pub struct RawColumns {
    /// One per linear gain: input, eta, constant, then the effects.
    pub columns: Vec<Vec<f64>>,
    /// Whether a column is the same for all values of the free parameters.
    pub fixed: Vec<bool>,
    /// The hysteresis state.
    pub eta: Vec<f64>,
    /// The structure at these values.
    terms: Vec<FitTerm>,
    /// The hysteresis, and its state at the start of each record.
    shape: Option<(Shape<f64>, Vec<f64>)>,
    /// The input behind the input stages.
    seen: Vec<f64>,
    stages: Stages,
}

/// How the columns move with each free parameter: which columns, and their slopes.
pub struct Moves(Vec<Vec<(usize, Vec<f64>)>>);

/// The output stages, which act on every column alike.
struct Stages {
    list: Vec<(usize, FitTerm, f64)>,
    dt: f64,
    /// The records on the work grid.
    records: Vec<Range<usize>>,
    /// The columns before the stages; empty where there is no stage.
    before: Vec<Vec<f64>>,
    /// Which free parameter belongs to which stage: its gain, or one of its shapes.
    owner: Vec<Option<(usize, Option<usize>)>>,
}

impl Stages {
    fn none(data: &Prepared) -> Self {
        Self {
            list: Vec::new(),
            dt: data.dt,
            records: data.pieces.iter().map(|p| p.work.clone()).collect(),
            before: Vec::new(),
            owner: Vec::new(),
        }
    }

    fn through(&self, column: &mut [f64], which: std::ops::Range<usize>) {
        for (_, term, gain) in &self.list[which] {
            self.apply(&term.effect, *gain, column);
        }
    }

    fn apply(&self, effect: &Effect<f64>, gain: f64, column: &mut [f64]) {
        for record in &self.records {
            apply_stage(effect, gain, &mut column[record.clone()], self.dt);
        }
    }

    /// What a stage adds for a gain of one.
    fn alone(&self, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
        let mut column = output.to_vec();
        self.apply(effect, 1.0, &mut column);
        column.iter().zip(output).map(|(a, b)| a - b).collect()
    }
}

/// output += gain · stage(output), along one record.
fn apply_stage(effect: &Effect<f64>, gain: f64, column: &mut [f64], dt: f64) {
    let mut state = EffectState::default();
    let mut at = Situation {
        dt,
        ..Situation::default()
    };
    for value in column {
        at.output = *value;
        *value += gain * effect.regressor(&mut state, &at);
    }
}

/// What a stage adds for a gain of one.
#[must_use]
pub fn stage_column(data: &Prepared, effect: &Effect<f64>, output: &[f64]) -> Vec<f64> {
    Stages::none(data).alone(effect, output)
}

/// The regressor of one effect along the work grid; `None` where its channel is missing.
#[must_use]
pub fn effect_column(data: &Prepared, term: &FitTerm, eta: &[f64]) -> Option<Vec<f64>> {
    let channel = data.channel(term.source)?;
    let load = match (data.mode, data.load) {
        (_, Some(i)) => Some(&data.channels[i].motion),
        (crate::record::Mode::Torque, None) => Some(&data.input.motion),
        (crate::record::Mode::Displacement, None) => None,
    };
    let mut column = Vec::with_capacity(eta.len());
    for (record, piece) in data.pieces.iter().enumerate() {
        let mut state = before(data, term, channel, record, piece);
        let since = match term.effect.family() {
            Family::Pretension => piece.since,
            _ => 0.0,
        };
        for (k, i) in piece.work.clone().enumerate() {
            let motion = &channel.motion[i];
            let at = Situation {
                dt: data.dt,
                time: since + k as f64 * data.dt,
                motion: Motion {
                    position: motion.position - term.origin,
                    ..*motion
                },
                input: data.input.motion[i],
                load: load.map_or(0.0, |l| l[i].position),
                eta: eta[i],
                output: 0.0,
            };
            column.push(term.effect.regressor(&mut state, &at));
        }
    }
    Some(column)
}

/// What an effect remembers at the beginning of a record.
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
    let at = Situation {
        dt: data.dt,
        motion: Motion {
            position: first.position - term.origin - start,
            ..*first
        },
        input: data.input.motion[piece.work.start],
        ..Situation::default()
    };
    term.effect.regressor(&mut state, &at);
    state
}

/// All columns for the given values of the free parameters.
///
/// `None` where a shape is outside of what the core admits.
#[must_use]
pub fn raw_columns(
    data: &Prepared,
    structure: &Structure,
    free: &[Free],
    values: &[f64],
) -> Option<RawColumns> {
    let n = data.work_len();
    let value = |role: Role| free.iter().position(|f| f.role == role).map(|i| values[i]);
    let mut terms = structure.terms.clone();
    for (f, &v) in free.iter().zip(values) {
        match f.role {
            Role::Shape { term, index } => {
                terms[term].effect = terms[term].effect.with_shape(index, v).ok()?
            }
            Role::Origin { term } => terms[term].origin = v,
            Role::Start { term, record } => terms[term].start[record] = v,
            _ => {}
        }
    }
    let mut columns = Vec::with_capacity(structure.linear());
    let mut fixed = Vec::with_capacity(structure.linear());
    let mut eta = vec![0.0; n];
    let mut shape = None;
    let seen = seen(data, &terms)?;
    if structure.hysteresis {
        let bouc_wen =
            Shape::try_new(value(Role::Rho)?, value(Role::Sigma)?, value(Role::N)?).ok()?;
        // What nobody has fitted (a record that is held out) begins in the middle.
        let eta0 = |record| value(Role::Eta0 { record }).unwrap_or(0.0);
        let eta0: Vec<f64> = (0..data.pieces.len()).map(eta0).collect();
        trace(data, &seen, &bouc_wen, &eta0, &mut eta);
        let staged = terms.iter().any(|t| t.effect.is_input_stage());
        for record in 0..structure.own_gains.max(1) {
            let own = |column: &[f64]| of_record(data, structure, column, record);
            columns.extend([own(&seen), own(&eta), own(&vec![1.0; n])]);
            fixed.extend([!staged, false, true]);
        }
        shape = Some((bouc_wen, eta0));
    }
    let mut list = Vec::new();
    let mut owner = vec![None; free.len()];
    for (index, term) in terms.iter().enumerate() {
        if term.effect.is_output_stage() {
            let gain = value(Role::Stage { term: index })?;
            for (slot, f) in owner.iter_mut().zip(free) {
                match f.role {
                    Role::Stage { term } if term == index => *slot = Some((list.len(), None)),
                    Role::Shape { term, index: shape } if term == index => {
                        *slot = Some((list.len(), Some(shape)))
                    }
                    _ => {}
                }
            }
            list.push((index, *term, gain));
        } else if !term.effect.is_input_stage() {
            columns.push(effect_column(data, term, &eta)?);
            fixed.push(!term.effect.reads_eta() && free.iter().all(|f| !matches!(f.role, Role::Shape { term, .. } | Role::Origin { term } | Role::Start { term, .. } if term == index)));
        }
    }
    if let Some(table) = &structure.table {
        // Its slopes in eta's parameters are left out: a search needs them only roughly.
        columns.extend(table.columns(data, &eta)?);
        fixed.resize(columns.len(), table.variable != Variable::Eta);
    }
    let before = if list.is_empty() {
        Vec::new()
    } else {
        columns.clone()
    };
    let stages = Stages {
        list,
        before,
        owner,
        ..Stages::none(data)
    };
    if !stages.list.is_empty() {
        fixed.fill(false);
        for column in &mut columns {
            stages.through(column, 0..stages.list.len());
        }
    }
    Some(RawColumns {
        columns,
        fixed,
        eta,
        terms,
        shape,
        seen,
        stages,
    })
}

/// A column of the transmission: as it is, or on one record alone where each has its own.
fn of_record(data: &Prepared, structure: &Structure, column: &[f64], record: usize) -> Vec<f64> {
    if structure.own_gains == 0 {
        return column.to_vec();
    }
    let mut own = vec![0.0; column.len()];
    if let Some(piece) = data.pieces.get(record) {
        own[piece.work.clone()].copy_from_slice(&column[piece.work.clone()]);
    }
    own
}

/// d column / d parameter by central differences: the effects' shapes are few and smooth.
fn central_difference(
    data: &Prepared,
    moved: &dyn Fn(f64) -> Option<FitTerm>,
    value: f64,
    step: f64,
    eta: &[f64],
) -> Option<Vec<f64>> {
    let up = effect_column(data, &moved(value + step)?, eta)?;
    let down = effect_column(data, &moved(value - step)?, eta)?;
    Some(
        up.iter()
            .zip(&down)
            .map(|(a, b)| (a - b) / (2.0 * step))
            .collect(),
    )
}

/// d column / d parameter through eta, by a central difference along its sensitivity.
fn eta_derivative(
    data: &Prepared,
    term: &FitTerm,
    eta: &[f64],
    sensitivity: &[f64],
) -> Option<Vec<f64>> {
    let largest = sensitivity.iter().fold(0.0_f64, |m, s| m.max(s.abs()));
    if largest == 0.0 {
        return Some(vec![0.0; eta.len()]);
    }
    let h = 1e-5 / largest;
    let at = |sign: f64| {
        let moved: Vec<f64> = eta
            .iter()
            .zip(sensitivity)
            .map(|(e, s)| e + sign * h * s)
            .collect();
        effect_column(data, term, &moved)
    };
    let (up, down) = (at(1.0)?, at(-1.0)?);
    Some(
        up.iter()
            .zip(&down)
            .map(|(a, b)| (a - b) / (2.0 * h))
            .collect(),
    )
}

impl RawColumns {
    /// The slopes of all columns in all free parameters.
    #[must_use]
    pub fn moves(
        &self,
        data: &Prepared,
        structure: &Structure,
        free: &[Free],
        values: &[f64],
    ) -> Option<Moves> {
        let mut moves: Vec<Vec<(usize, Vec<f64>)>> = vec![Vec::new(); free.len()];
        let mut sensitivities: Vec<(usize, Vec<f64>)> = Vec::new();
        let mut k = 0;
        if let Some((shape, eta0)) = &self.shape {
            let trajectory = trajectory(data, &self.seen, shape, eta0);
            for (j, f) in free.iter().enumerate() {
                let pick: fn(&Sensitivity<f64>) -> f64 = match f.role {
                    Role::Rho => |s| s.d_rho,
                    Role::Sigma => |s| s.d_sigma,
                    Role::N => |s| s.d_n,
                    Role::Eta0 { .. } => |s| s.d_eta0,
                    _ => continue,
                };
                let mut slope: Vec<f64> = trajectory.iter().map(pick).collect();
                if let Role::Eta0 { record } = f.role {
                    // The state of one record moves no other.
                    let own = data.pieces.get(record).map_or(0..0, |p| p.work.clone());
                    slope[..own.start].fill(0.0);
                    slope[own.end..].fill(0.0);
                }
                sensitivities.push((j, slope));
            }
            for (j, s) in &sensitivities {
                for record in 0..structure.own_gains.max(1) {
                    let own = of_record(data, structure, s, record);
                    moves[*j].push((3 * record + 1, own));
                }
            }
            k = structure.base();
        }
        for (index, term) in self.terms.iter().enumerate() {
            if term.effect.is_output_stage() || term.effect.is_input_stage() {
                continue;
            }
            for (j, f) in free.iter().enumerate() {
                match f.role {
                    Role::Shape {
                        term: of,
                        index: shape,
                    } if of == index => {
                        // A step in time moves by whole samples.
                        let in_time = term.effect.shape_names()[shape] == "t_s";
                        let step = if in_time {
                            data.dt
                        } else {
                            1e-5 * values[j].abs().max(1e-6)
                        };
                        let moved = |v: f64| {
                            term.effect
                                .with_shape(shape, v)
                                .ok()
                                .map(|effect| FitTerm { effect, ..*term })
                        };
                        moves[j].push((
                            k,
                            central_difference(data, &moved, values[j], step, &self.eta)?,
                        ));
                    }
                    Role::Start { term: of, record } if of == index => {
                        let step = 1e-5 * data.channel(term.source)?.reach;
                        let moved = |v: f64| {
                            let mut term = *term;
                            term.start[record] = v;
                            Some(term)
                        };
                        moves[j].push((
                            k,
                            central_difference(data, &moved, values[j], step, &self.eta)?,
                        ));
                    }
                    Role::Origin { term: of } if of == index => {
                        let step = 1e-5 * data.channel(term.source)?.reach;
                        let moved = |v: f64| Some(FitTerm { origin: v, ..*term });
                        moves[j].push((
                            k,
                            central_difference(data, &moved, values[j], step, &self.eta)?,
                        ));
                    }
                    _ => {}
                }
            }
            if term.effect.reads_eta() {
                for (j, s) in &sensitivities {
                    moves[*j].push((k, eta_derivative(data, term, &self.eta, s)?));
                }
            }
            k += 1;
        }
        let mut moves = Moves(moves);
        moves.add_series(data, structure, free, values)?;
        Some(moves)
    }

    /// d output / d free parameter `j` for the given gains, before the filter.
    #[must_use]
    pub fn tangent(&self, moves: &Moves, j: usize, gains: &[f64]) -> Vec<f64> {
        let mut tangent = vec![0.0; self.eta.len()];
        for (k, column) in &moves.0[j] {
            for (t, c) in tangent.iter_mut().zip(column) {
                *t += gains[*k] * c;
            }
        }
        self.stages.through(&mut tangent, 0..self.stages.list.len());
        if let Some((position, shape)) = self.stages.owner[j] {
            self.add_stage_tangent(&mut tangent, gains, position, shape);
        }
        tangent
    }

    /// The part of a tangent that comes from an output stage's own gain or shape.
    fn add_stage_tangent(
        &self,
        tangent: &mut [f64],
        gains: &[f64],
        position: usize,
        shape: Option<usize>,
    ) {
        let Stages { list, before, .. } = &self.stages;
        let mut output: Vec<f64> = (0..tangent.len())
            .map(|i| before.iter().zip(gains).map(|(c, g)| g * c[i]).sum())
            .collect();
        self.stages.through(&mut output, 0..position);
        let (_, term, gain) = &list[position];
        let mut part = match shape {
            None => self.stages.alone(&term.effect, &output),
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
                    self.stages.alone(&up, &output),
                    self.stages.alone(&down, &output),
                );
                up.iter()
                    .zip(&down)
                    .map(|(a, b)| gain * (a - b) / (2.0 * h))
                    .collect()
            }
        };
        self.stages.through(&mut part, position + 1..list.len());
        for (t, p) in tangent.iter_mut().zip(part) {
            *t += p;
        }
    }
}
