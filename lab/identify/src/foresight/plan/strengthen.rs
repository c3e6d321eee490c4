//! Where nothing is confounded: the motion under which unknown parameters would show.

use super::model::{Model, Placed};
use super::trajectory::{trajectory, Kind};
use super::{best, describe, Aim, Experiment};
use crate::algebra::imitated;
use crate::conclude::intervals::parameters;
use crate::fit::projection::{rows, Span};
use crate::fit::Solution;
use crate::model::structure::Role;
use crate::problem::Prepared;

/// An experiment is worth its while where a parameter shows this many times as strongly.
const WORTH: f64 = 1.2;

/// Rms per row of a column once the others are taken off, and what they imitate of it.
fn shows(placed: &Placed<'_>, data: &Prepared, j: usize) -> Option<(f64, f64)> {
    let others = placed.columns.iter().enumerate();
    let others = Span::of(data, others.filter(|(k, _)| *k != j).map(|(_, c)| c));
    let column = rows(data, &placed.columns[j]);
    let (whole, count) = (column.norm(), column.len() as f64);
    let rest = others.off(column).norm();
    (whole > 0.0).then(|| (rest / count.sqrt(), imitated(whole, rest)))
}

/// The experiment that shows best what the record does not identify; `None` where all is
/// identified or no canned motion would help.
#[must_use]
pub fn strengthen(data: &Prepared, solution: &Solution) -> Option<Experiment> {
    use rayon::prelude::*;
    let model = Model::whole(solution);
    let here = model.on(data)?;
    let all = parameters(data, solution);
    if all.len() != here.columns.len() {
        return None;
    }
    let linear = all.len() - solution.free.len();
    let weak: Vec<(usize, &str, f64, f64)> = all
        .iter()
        .enumerate()
        .filter(|(j, p)| {
            // How the record began is no property of the rig.
            let passing = j.checked_sub(linear).is_some_and(|f| {
                matches!(
                    solution.free[f].role,
                    Role::Eta0 { .. } | Role::Start { .. }
                )
            });
            !p.identified && !passing
        })
        .filter_map(|(j, p)| {
            let (now, imitated) = shows(&here, data, j)?;
            (now > 0.0).then_some((j, p.name.as_str(), now, imitated))
        })
        .collect();
    if weak.is_empty() {
        return None;
    }
    let tried = Kind::ALL
        .par_iter()
        .map(|&kind| {
            let planned = trajectory(data, kind);
            let motion = planned.prepared(data)?;
            let placed = model.on(&motion)?;
            let mut score = 0.0;
            let mut aims = Vec::new();
            for &(j, name, now, imitated) in &weak {
                let (then, left) = shows(&placed, &motion, j)?;
                score += (then / now).max(1e-9).ln() / weak.len() as f64;
                aims.push(Aim {
                    what: name.to_owned(),
                    rival: None,
                    correlation_now: imitated,
                    correlation_then: left,
                    left_now: 1.0,
                    left_then: then / now,
                });
            }
            (score >= WORTH.ln()).then(|| (score, describe(data, &planned, &motion, aims)))
        })
        .collect();
    best(tried)
}
