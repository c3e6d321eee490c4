//! Remarks on gains: gains with a misleading sign, and the gain of the tension.

use super::final_fit::FinalFit;
use super::finding::Finding;
use super::intervals::{parameters, term_title};
use crate::algebra::line;
use crate::fit::{Segments, Solution};
use crate::model::kind::{kind, Kind};
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use crate::record::Mode;
use crate::scale::TRACE;
use crate::score::tones::may_be_of_the_motion;
use bowden::model::Source;

/// Parts with memory, or friction, which may share the friction with a hysteresis.
const FRICTION: [&str; 12] = [
    "presliding",
    "presliding-dahl",
    "backlash",
    "dead-zone",
    "play-in-series",
    "coulomb",
    "viscous",
    "power-law",
    "creep",
    "lag",
    "delay",
    "position-hysteresis",
];

/// Tones at lines that the motion itself may cause.
pub(super) fn of_the_motion(data: &Prepared, solution: &Solution) -> Option<Finding> {
    let terms = solution.structure.terms.iter();
    let tones = terms.filter(|term| may_be_of_the_motion(data, term));
    let terms: Vec<String> = tones.map(|t| term_title(data, t)).collect();
    (!terms.is_empty()).then_some(Finding::TonesOfMotion { terms })
}

/// `eta` times the torque among the parts.
pub(super) fn of_tension(data: &Prepared, solution: &Solution) -> Option<Finding> {
    let mut terms = solution.structure.terms.iter();
    let is_of_torque =
        |t: &FitTerm| t.effect.name() == "position-hysteresis" && t.source == Source::Input;
    let is = data.mode == Mode::Torque && terms.any(is_of_torque);
    is.then_some(Finding::FrictionWithTension)
}

/// `eta` times a temperature among the parts.
pub(super) fn of_temperature(data: &Prepared, solution: &Solution) -> Option<Finding> {
    let of_temperature = |t: &&FitTerm| {
        let channel = data.channel(t.source);
        t.effect.name() == "position-hysteresis"
            && channel.is_some_and(|c| kind(data.mode, t.source, c) == Kind::Temperature)
    };
    let mut terms = solution.structure.terms.iter();
    let channel = data.channel(terms.find(of_temperature)?.source)?;
    Some(Finding::FrictionWithTemperature {
        channel: channel.name.clone(),
    })
}

/// A torque that falls when the input rises.
pub(super) fn falls(data: &Prepared, solution: &Solution) -> Option<Finding> {
    if data.mode != Mode::Torque || input_gain(solution)? >= 0.0 {
        return None;
    }
    let rows = data.split.fit.iter();
    let (slope, _) = line(rows.map(|&i| (solution.columns[0][i], data.target[i])));
    (slope < 0.0).then(|| Finding::OutputFalls {
        input: data.input.name.clone(),
        output: data.output_name.clone(),
    })
}

/// The gain over the input, with the contribution of a share of it; `None` without hysteresis, and
/// if each file has its own gain.
fn input_gain(solution: &Solution) -> Option<f64> {
    let structure = &solution.structure;
    if !structure.hysteresis || structure.own_gains > 0 {
        return None;
    }
    let terms = structure.terms.iter().enumerate();
    let is_share = |term: &FitTerm| {
        let is_line = ["gain", "stiffness-linear"].contains(&term.effect.name());
        is_line && term.source == Source::Input
    };
    let shares = terms.filter(|(_, term)| is_share(term));
    Some(solution.gains[0] + shares.map(|(i, _)| solution.gain(i)).sum::<f64>())
}

/// A hysteresis whose loop is traversed in the opposite direction to the measured loop. Its gain
/// and the gains of other parts partly cancel.
pub(super) fn turns_against(done: &FinalFit) -> Option<Finding> {
    let (data, solution) = (&done.data, &done.solution);
    let structure = &solution.structure;
    if !structure.hysteresis || structure.own_gains > 0 {
        return None;
    }
    let (eta, gain) = (&solution.columns[1], solution.gains[1]);
    let eta: Vec<f64> = (0..data.target.len()).map(|i| gain * eta[i]).collect();
    let spread = |signal: &[f64]| Segments::deviation(data, signal).fit;
    if area(data, &eta) * area(data, &data.target) >= 0.0
        || spread(&eta) < TRACE * spread(&data.target)
    {
        return None;
    }
    let terms = solution.structure.terms.iter();
    let others = terms.filter(|term| FRICTION.contains(&term.effect.name()));
    let mut others: Vec<String> = others.map(|term| term_title(data, term)).collect();
    others.sort();
    others.dedup();
    if others.is_empty() {
        return None;
    }
    let all = parameters(data, solution);
    let shown = all.iter().find(|p| p.name == "kappa_eta")?;
    // An interval that holds zero says nothing of the sign.
    let is_known = shown.ci95.is_none_or(|[low, high]| low * high > 0.0);
    is_known.then_some(Finding::LoopReversed {
        kappa_eta: shown.value,
        terms: others,
    })
}

/// Whether the loop is traversed in the direction that it has if input and output are swapped: the
/// output of a cable leads its input, or the work of a force on its displacement is negative.
pub(crate) fn runs_backwards(data: &Prepared) -> bool {
    let rows = data.split.fit.iter();
    let position = |row: usize| data.input.motion[row * data.stride].position;
    let (slope, _) = line(rows.map(|&i| (position(i), data.target[i])));
    let leads = slope * area(data, &data.target);
    match data.mode {
        Mode::Torque => leads > 0.0,
        Mode::Displacement => leads < 0.0,
    }
}

/// Area of the loop of a signal over the input: the integral of it times the input's rate.
fn area(data: &Prepared, signal: &[f64]) -> f64 {
    let rows = &data.split.fit;
    let mean = rows.iter().map(|&row| signal[row]).sum::<f64>() / rows.len().max(1) as f64;
    let rate = |row: usize| data.input.motion[row * data.stride].velocity;
    rows.iter()
        .map(|&row| (signal[row] - mean) * rate(row))
        .sum()
}
