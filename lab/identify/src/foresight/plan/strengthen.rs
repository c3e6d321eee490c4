//! If nothing is ambiguous: the motion that would identify the remaining parameters.

use super::model::{Model, Placed};
use super::trajectory::{trajectory, Way};
use super::{best, describe, Aim, Experiment};
use crate::algebra::imitated;
use crate::conclude::intervals::parameters;
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::structure::Role;
use crate::problem::Prepared;
use crate::scale::NOISE;

/// Rms per row of the part of a column that the other columns cannot imitate, and the share that
/// they can imitate.
fn shows(placed: &Placed<'_>, data: &Prepared, j: usize) -> Option<(f64, f64)> {
    let others = placed.columns.iter().enumerate();
    let others = Span::of(data, others.filter(|(k, _)| *k != j).map(|(_, c)| c));
    let column = rows(data, &placed.columns[j]);
    let (whole, count) = (column.norm(), column.len() as f64);
    let rest = others.off(column).norm();
    (whole > 0.0).then(|| (rest / count.sqrt(), imitated(whole, rest)))
}

/// A parameter that the record does not identify: its place among the columns, its name, and how many times
/// as strongly it has to show to be known.
struct Open {
    place: usize,
    name: String,
    needs: f64,
}

/// The parameters that the record does not identify, except initial states, which are not a
/// property of the rig, and the number of all parameters.
fn open(data: &Prepared, solution: &Solution) -> (usize, Vec<Open>) {
    let all = parameters(data, solution);
    let count = all.len();
    let linear = all.len().saturating_sub(solution.free.len());
    let is_passing = |j: usize| {
        let role = j.checked_sub(linear).map(|f| solution.free[f].role);
        matches!(role, Some(Role::Eta0 { .. } | Role::Start { .. }))
    };
    let open = all.into_iter().enumerate();
    let open = open
        .filter(|(j, p)| !p.identified && !is_passing(*j))
        .map(|(place, p)| Open {
            place,
            name: p.name,
            // What changes no answer is no reason to record again; of an unknown interval twice is a choice.
            needs: p.too_wide.unwrap_or(2.0).max(NOISE),
        });
    (count, open.collect())
}

/// Names of the parameters that the record does not identify.
#[must_use]
pub fn unidentified(data: &Prepared, solution: &Solution) -> Vec<String> {
    let (_, open) = open(data, solution);
    open.into_iter().map(|one| one.name).collect()
}

/// The experiment that best identifies the remaining parameters; `None` if all are identified or no
/// predefined motion would help.
#[must_use]
pub fn strengthen(data: &Prepared, solution: &Solution) -> Option<Experiment> {
    use rayon::prelude::*;
    let model = Model::whole(solution);
    let here = model.on(data)?;
    let (count, open) = open(data, solution);
    if count != here.columns.len() {
        return None;
    }
    let weak: Vec<(Open, f64, f64)> = open
        .into_iter()
        .filter_map(|one| {
            let (now, imitated) = shows(&here, data, one.place)?;
            (now > 0.0).then_some((one, now, imitated))
        })
        .collect();
    if weak.is_empty() {
        return None;
    }
    let tried = Way::all(data)
        .into_par_iter()
        .map(|way| {
            let planned = trajectory(data, way);
            let motion = planned.prepared(data)?;
            let placed = model.on(&motion)?;
            let mut score = 0.0;
            let mut aims = Vec::new();
            for (one, now, imitated) in &weak {
                let (then, left) = shows(&placed, &motion, one.place)?;
                let times = then / now;
                if times.is_nan() || times < one.needs {
                    continue;
                }
                score += times.ln();
                aims.push(Aim {
                    what: one.name.clone(),
                    rival: None,
                    correlation_now: *imitated,
                    correlation_then: left,
                    left_now: 1.0,
                    left_then: times,
                });
            }
            let score = (aims.len(), score);
            Some((score, describe(data, &planned, &motion, aims)))
        })
        .collect();
    best(tried)
}
