//! Parameters with their confidence intervals.
//!
//! Block jackknife on the Jacobian of the final model: residuals may have any colour
//! inside a block. The sixteen blocks of the scan are left out in turn, and Student's t
//! with fifteen degrees of freedom gives the width. This is the cluster sandwich of Liang
//! and Zeger (1986) with the correction for few clusters (CR3; Bell and McCaffrey, 2002):
//! without it a block's residuals are too small, since the block itself was fitted.

use super::excitation;
pub use super::term_name::{term_name, term_title};
use super::without::moved_without;
use crate::algebra::inverse;
use crate::fit::Solution;
use crate::model::effects::shown_by;
use crate::model::structure::{FitTerm, Range, Role};
use crate::model::units::Unit;
use crate::problem::{Prepared, Stretch};
use crate::record::Mode;
use crate::scale::{HALF, PART};
use crate::score::blocks::{blocks, BLOCKS};
use nalgebra::{DMatrix, DVector};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// One parameter of a fitted model.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Parameter {
    /// The field's name: `kappa_eta`, `rho`, `viscous`, `coulomb.v_e`.
    pub name: String,
    /// Estimate.
    pub value: f64,
    /// Unit, if the record states the units of its columns.
    pub unit: Option<String>,
    /// 95 % interval; `None` if the parameter is not identified.
    pub ci95: Option<[f64; 2]>,
    /// Whether the record determines it.
    pub identified: bool,
    /// The reason why it is not identified, and the motion that would identify it; `None` if it is
    /// identified.
    pub not_identified: Option<Refusal>,
    /// Factor by which its interval is too wide, if this is the reason.
    #[serde(skip)]
    pub too_wide: Option<f64>,
    /// Index of its term; `None` for the transmission.
    #[serde(skip)]
    pub term: Option<usize>,
}

/// Why a record does not determine a parameter.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Refusal {
    /// "at its upper bound", "correlated with kappa_eta", …
    pub reason: String,
    /// The motion that would identify it.
    pub excitation: String,
}

struct Entry<'a> {
    name: String,
    unit: Option<String>,
    value: f64,
    column: &'a Stretch,
    shape: bool,
    /// The reason why it is not identified, independently of its interval: it is at a bound, or the
    /// record cannot identify it.
    refused: Option<String>,
    excitation: &'static str,
    /// The reported value is this factor times the fitted one.
    sign: f64,
    term: Option<usize>,
}

/// Unit of a term's gain.
pub(crate) fn gain_unit(data: &Prepared, term: &FitTerm) -> Option<String> {
    let d = term.effect.info().dimension;
    let channel = data.channel(term.source).and_then(|c| c.unit.as_deref());
    let load = match data.load {
        Some(i) => data.channels[i].unit.as_deref(),
        None => data.input.unit.as_deref(),
    };
    Unit::one()
        .times(data.output_unit.as_deref(), 1 - i32::from(d.output))
        .times(channel, -i32::from(d.channel))
        .times(load, -i32::from(d.load))
        .times(data.input.unit.as_deref(), -i32::from(d.input))
        .times(Some("s"), -i32::from(d.time))
        .text()
}

pub(crate) fn shape_unit(data: &Prepared, term: &FitTerm, index: usize) -> Option<String> {
    let d = term.effect.info().shapes.get(index)?.dimension;
    let channel = data.channel(term.source).and_then(|c| c.unit.as_deref());
    Unit::one()
        .times(data.output_unit.as_deref(), i32::from(d.output))
        .times(channel, i32::from(d.channel))
        .times(data.input.unit.as_deref(), i32::from(d.load))
        .times(Some("s"), i32::from(d.time))
        .text()
}

/// Names of the transmission's gains, and the sign with which the last two enter.
pub(crate) fn gain_names(mode: Mode) -> ([&'static str; 3], f64) {
    match mode {
        Mode::Torque => (["B", "kappa_eta", "T0"], -1.0),
        Mode::Displacement => (["kappa_x", "kappa_eta", "offset"], 1.0),
    }
}

/// A parameter of one record among several: `B.2` is the second one's.
pub(crate) fn numbered(name: &str, record: usize) -> String {
    format!("{name}.{}", record + 1)
}

fn of_record(data: &Prepared, name: &str, record: usize) -> String {
    match data.pieces.len() {
        1 => name.to_owned(),
        _ => numbered(name, record),
    }
}

fn entries<'a>(data: &Prepared, solution: &'a Solution) -> Vec<Entry<'a>> {
    let mut all = Vec::new();
    let mut next = 0;
    if solution.structure.hysteresis {
        all.extend(transmission(data, solution));
        next = solution.structure.base();
    }
    for (index, term) in solution.structure.terms.iter().enumerate() {
        if term.is_linear() {
            let (name, unit) = (term_name(data, term), gain_unit(data, term));
            all.push(linear(solution, name, unit, (next, 1.0), Some(index)));
            next += 1;
        }
    }
    all.extend((0..solution.free.len()).map(|j| free(data, solution, j)));
    all
}

/// A linear gain: its position among the gains, and the sign with which it is shown.
fn linear(
    solution: &Solution,
    name: String,
    unit: Option<String>,
    (k, sign): (usize, f64),
    term: Option<usize>,
) -> Entry<'_> {
    Entry {
        name,
        unit,
        value: solution.gains[k],
        column: &solution.columns[k],
        shape: false,
        refused: None,
        excitation: match term {
            None => excitation::TRANSMISSION,
            Some(index) => {
                let term: &FitTerm = &solution.structure.terms[index];
                shown_by(term.effect.name())
            }
        },
        sign,
        term,
    }
}

/// The gains of the transmission; if each record has its own, those of each record.
fn transmission<'a>(data: &Prepared, solution: &'a Solution) -> Vec<Entry<'a>> {
    let (input, output) = (data.input.unit.as_deref(), data.output_unit.as_deref());
    let gain = Unit::one().times(output, 1).times(input, -1).text();
    let plain = Unit::one().times(output, 1).text();
    // (1): F = kappa_x x + kappa_eta eta; (6): tau_o = B tau_i − kappa_eta eta − T0.
    let (names, sign) = gain_names(data.mode);
    let own = |name: &str, record: usize| match solution.structure.own_gains {
        0 => name.to_owned(),
        _ => numbered(name, record),
    };
    let mut all = Vec::new();
    for record in 0..solution.structure.own_gains.max(1) {
        let units = [&gain, &plain, &plain];
        for (at, (name, unit)) in names.iter().zip(units).enumerate() {
            let sign = if at == 0 { 1.0 } else { sign };
            let (name, unit) = (own(name, record), unit.clone());
            all.push(linear(solution, name, unit, (3 * record + at, sign), None));
        }
    }
    all
}

/// The entry of a free parameter.
fn free<'a>(data: &Prepared, solution: &'a Solution, j: usize) -> Entry<'a> {
    let free = &solution.free[j];
    let (name, unit, term) = named(data, solution, free.role);
    let shape = match free.role {
        Role::Rho | Role::Sigma | Role::N => true,
        Role::Shape { .. } => !matches!(free.range, Range::Free | Range::Linear(..)),
        _ => false,
    };
    Entry {
        name,
        unit,
        value: solution.values[j],
        column: &solution.tangents[j],
        shape,
        refused: match free.role {
            Role::Sigma | Role::N => excitation::without_reversals(data),
            _ => None,
        }
        .or_else(|| {
            let end = free.range.nearest(solution.values[j]);
            solution.on_bound[j].then(|| format!("at its {end} bound"))
        }),
        excitation: excitation::of_role(solution, free.role),
        sign: 1.0,
        term,
    }
}

/// Name and unit of a role, and the term that it belongs to.
fn named(
    data: &Prepared,
    solution: &Solution,
    role: Role,
) -> (String, Option<String>, Option<usize>) {
    let input = data.input.unit.as_deref();
    let one = Unit::one().text();
    let terms = &solution.structure.terms;
    let place = role.term().and_then(|term| terms.place(term));
    let fit = place.and_then(|place| terms.get(place));
    let name = fit.map_or_else(String::new, |fit| term_name(data, fit));
    let of_source = || {
        let channel = data.channel(fit?.source);
        channel.and_then(|c| c.unit.clone())
    };
    let (name, unit) = match role {
        Role::Rho => ("rho".to_owned(), Unit::one().times(input, -1).text()),
        Role::Sigma => ("sigma".to_owned(), one),
        Role::N => ("n".to_owned(), one),
        Role::Eta0 { record } => (of_record(data, "eta0", record), one),
        Role::Shape { index, .. } => {
            let shapes = fit.map_or(&[][..], |fit| fit.effect.info().shapes);
            let shape = shapes.get(index).map_or("", |shape| shape.name);
            let unit = fit.and_then(|fit| shape_unit(data, fit, index));
            (format!("{name}.{shape}"), unit)
        }
        Role::Origin { .. } => (format!("{name}.origin"), of_source()),
        Role::Start { record, .. } => (
            of_record(data, &format!("{name}.start"), record),
            of_source(),
        ),
        Role::Stage { .. } => (name, fit.and_then(|fit| gain_unit(data, fit))),
    };
    (name, unit, place)
}

/// Columns on the rows of the fit segment, at unit norm.
struct Design {
    /// Norm of each column.
    scale: Vec<f64>,
    /// Which of the columns are not zero.
    used: Vec<usize>,
    x: DMatrix<f64>,
    gram: DMatrix<f64>,
}

impl Design {
    fn new(data: &Prepared, columns: &[&Stretch]) -> Self {
        let rows = &data.split.fit;
        let scale: Vec<f64> = columns
            .iter()
            .map(|c| rows.iter().map(|&i| c[i] * c[i]).sum::<f64>().sqrt())
            .collect();
        let used: Vec<usize> = (0..columns.len())
            .filter(|&j| scale[j].is_finite() && scale[j] > 0.0)
            .collect();
        let x = DMatrix::from_fn(rows.len(), used.len(), |k, j| {
            columns[used[j]][rows[k]] / scale[used[j]]
        });
        let gram = x.tr_mul(&x);
        Self {
            scale,
            used,
            x,
            gram,
        }
    }

    fn bread(&self) -> Option<DMatrix<f64>> {
        inverse(self.gram.clone())
    }

    /// For each column, the other column with the most correlated estimate.
    fn partners(&self) -> Vec<Option<(usize, f64)>> {
        // Without an inverse the columns themselves tell who goes with whom.
        let covariance = self.bread().unwrap_or_else(|| self.gram.clone());
        let mut partners = vec![None; self.scale.len()];
        for (a, &j) in self.used.iter().enumerate() {
            let correlation = |b: usize| {
                let scale = (covariance[(a, a)] * covariance[(b, b)]).sqrt();
                (covariance[(a, b)] / scale).abs()
            };
            partners[j] = (0..self.used.len())
                .filter(|&b| b != a)
                .map(|b| (self.used[b], correlation(b)))
                .filter(|(_, correlation)| correlation.is_finite())
                .max_by(|x, y| x.1.total_cmp(&y.1));
        }
        partners
    }
}

/// The change of each column's factor without each block, times the correction for the number of
/// blocks: the variances are the sums of the squares. NaN for a column that depends on the others;
/// `None` if all do.
pub(crate) fn jackknife(
    data: &Prepared,
    solution: &Solution,
    columns: &[&Stretch],
) -> Option<Vec<Vec<f64>>> {
    let rows = &data.split.fit;
    let design = Design::new(data, columns);
    let Design {
        scale,
        used,
        x,
        gram,
    } = &design;
    let bread = design.bread()?;
    let correction = ((BLOCKS as f64 - 1.0) / BLOCKS as f64).sqrt();
    let mut steps = Vec::with_capacity(BLOCKS);
    for block in blocks(data) {
        let part = x.rows(block.start, block.len());
        let residual =
            DVector::from_iterator(block.len(), block.map(|k| solution.residual[rows[k]]));
        let score = part.tr_mul(&residual);
        let plain = &bread * &score;
        let moved = moved_without(&(gram - part.tr_mul(&part)), &score, &bread);
        let mut all = vec![f64::NAN; columns.len()];
        for (j, &column) in used.iter().enumerate() {
            // What hangs on this block alone cannot be told without it: then the step is that of the
            // whole fit.
            let step = moved[j].unwrap_or(plain[j]);
            if bread[(j, j)] < 1e10 {
                all[column] = correction * step / scale[column];
            }
        }
        steps.push(all);
    }
    Some(steps)
}

/// Student's t with one degree of freedom less than there are blocks, for 95 %.
pub(crate) fn quantile() -> Option<f64> {
    let student = StudentsT::new(0.0, 1.0, BLOCKS as f64 - 1.0).ok()?;
    Some(student.inverse_cdf(0.975))
}

/// Half-widths of the 95 % intervals; `None` if a column depends on the others.
fn half_widths(data: &Prepared, solution: &Solution, columns: &[&Stretch]) -> Vec<Option<f64>> {
    let (Some(steps), Some(quantile)) = (jackknife(data, solution, columns), quantile()) else {
        return vec![None; columns.len()];
    };
    (0..columns.len())
        .map(|j| {
            let variance: f64 = steps.iter().map(|step| step[j] * step[j]).sum();
            (variance.is_finite() && variance >= 0.0).then(|| quantile * variance.sqrt())
        })
        .collect()
}

/// Why a parameter is not identified.
fn refusal(entry: &Entry<'_>, wide: bool, partner: Option<(&str, f64)>) -> Refusal {
    let with = partner
        .filter(|(_, correlation)| *correlation >= 1.0 - PART)
        .map(|(name, _)| format!("correlated with {name}"));
    let reason = match (entry.refused.clone(), with) {
        (Some(reason), _) => reason,
        (None, Some(with)) if wide => {
            format!("half-width of the interval above half of the value, and {with}")
        }
        (None, Some(with)) => with,
        (None, None) if wide => "half-width of the interval above half of the value".to_owned(),
        (None, None) => "no part of the output depends only on this parameter".to_owned(),
    };
    Refusal {
        reason,
        excitation: entry.excitation.to_owned(),
    }
}

/// All parameters of a fitted model, gains first.
#[must_use]
pub fn parameters(data: &Prepared, solution: &Solution) -> Vec<Parameter> {
    let entries = entries(data, solution);
    // A parameter that is refused does not move: the others are conditional on it.
    let moving: Vec<usize> = (0..entries.len())
        .filter(|&j| entries[j].refused.is_none())
        .collect();
    let mut columns: Vec<&Stretch> = moving.iter().map(|&j| entries[j].column).collect();
    let partners = Design::new(data, &columns).partners();
    // A table is not a parameter, but it makes the parameters less certain.
    let table = solution.columns.len() - solution.structure.table_gains();
    columns.extend(&solution.columns[table..]);
    let widths = half_widths(data, solution, &columns);
    let mut of = vec![(None, None); entries.len()];
    for (k, &j) in moving.iter().enumerate() {
        let partner = partners[k].map(|(other, r)| (moving[other], r));
        of[j] = (widths[k], partner);
    }
    let names: Vec<String> = entries.iter().map(|entry| entry.name.clone()).collect();
    entries
        .into_iter()
        .zip(of)
        .map(|(entry, (width, partner))| {
            let value = entry.sign * entry.value;
            let most = match entry.shape {
                true => HALF * value.abs(),
                false => f64::INFINITY,
            };
            let too_wide = width.filter(|w| *w > most).map(|w| w / most);
            let width = width.filter(|w| *w <= most);
            let partner = partner.map(|(other, r)| (names[other].as_str(), r));
            let refused = width
                .is_none()
                .then(|| refusal(&entry, too_wide.is_some(), partner));
            Parameter {
                name: entry.name,
                value,
                unit: entry.unit,
                ci95: width.map(|w| [value - w, value + w]),
                identified: width.is_some(),
                not_identified: refused,
                too_wide,
                term: entry.term,
            }
        })
        .collect()
}
