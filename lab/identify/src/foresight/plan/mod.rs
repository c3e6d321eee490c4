//! The experiment that would resolve what the record cannot.
//!
//! Two effects are ambiguous if their contributions look alike after removal of everything that the
//! rest of the model can imitate. This depends on the motion. The core therefore runs the fitted
//! model along predefined trajectories, built from the record's own signals ([`trajectory`]). Each
//! contribution is projected off all other columns of the model and their slopes, and off the
//! alternative with free shapes. The remaining part distinguishes the two effects, and the
//! trajectory with the largest remaining part is the experiment.
//!
//! All of this is first-order theory at the fitted values: a prediction, not a measurement.

mod model;
mod strengthen;
mod trajectory;

use crate::scale::NOISE;
pub use strengthen::{strengthen, unidentified};
pub use trajectory::{trajectory, Kind, Trajectory, Way};

use crate::algebra::imitated;
use crate::conclude::intervals::term_name;
use crate::fit::{glance_from, Known};
use crate::ledger::{Ledger, Round};
use crate::model::catalogue::Candidate;
use crate::model::structure::FitTerm;
use crate::problem::Prepared;
use model::{Beside, Model};
use serde::Serialize;

/// A planned experiment and its expected result.
#[derive(Debug, Clone, Serialize)]
pub struct Experiment {
    /// How it moves.
    pub kind: Kind,
    /// The kind of motion, and the record that it is built from.
    #[serde(skip)]
    pub way: Way,
    /// The motion in words, with its parameters.
    pub trajectory: String,
    /// Length \[s\].
    pub seconds: f64,
    /// Largest speed of the input, as a multiple of the recorded one.
    pub speed: f64,
    /// The effects to be separated, or the parameters to be identified.
    pub aims: Vec<Aim>,
}

/// One purpose of an experiment.
#[derive(Debug, Clone, Serialize)]
pub struct Aim {
    /// The named effect, or the parameter that is not identified.
    pub what: String,
    /// The alternative; `None` for a parameter.
    pub rival: Option<String>,
    /// Projected correlation of the two contributions on the record; for a parameter, the share of
    /// its slope that the others imitate.
    pub correlation_now: f64,
    /// The same, predicted for the experiment.
    pub correlation_then: f64,
    /// Rms error of a wrong term on the record, in multiples of the present error; for a parameter,
    /// one.
    pub left_now: f64,
    /// The same, predicted for the experiment; for a parameter, the factor by which it becomes more
    /// visible.
    pub left_then: f64,
}

/// The part of a contribution that the alternative cannot reproduce.
struct Apart {
    correlation: f64,
    /// Rms in the output's unit.
    left: f64,
}

fn apart(effect: &Beside, rival: &Beside, gain: f64) -> Option<Apart> {
    let rest = rival.span.off(effect.own.clone());
    let (whole, part) = (effect.own.norm(), rest.norm());
    if whole.is_nan() || whole <= 0.0 {
        return None;
    }
    Some(Apart {
        correlation: imitated(whole, part),
        left: part * gain.abs() / (rest.len() as f64).sqrt(),
    })
}

/// The two directions of a pair of effects with their gains, the worse of each figure.
fn pair(a: (&Beside, f64), b: (&Beside, f64)) -> Option<Apart> {
    let there = apart(a.0, b.0, a.1)?;
    let back = apart(b.0, a.0, b.1)?;
    Some(Apart {
        correlation: there.correlation.max(back.correlation),
        left: there.left.min(back.left),
    })
}

/// An alternative with its shapes fitted together with the rest of the model.
fn refined(data: &Prepared, round: &Round, rival: &Candidate) -> Option<FitTerm> {
    let mut structure = round.solution.structure.clone();
    structure.terms.remove(*structure.terms.ids().last()?);
    structure.terms.push(rival.term);
    let known = Known::of(&round.solution);
    let (_, fitted, _) = glance_from(&data.for_search(true), &structure, &known, 0.0)?;
    fitted.terms.last().copied()
}

/// The experiment that separates a term from its alternatives; `None` if it has none, or if no
/// predefined motion would separate any of them.
#[must_use]
pub fn separate(data: &Prepared, round: &Round) -> Option<Experiment> {
    use rayon::prelude::*;
    let last = round.solution.structure.terms.len().checked_sub(1)?;
    let named = &round.solution.structure.terms[last];
    if round.rivals.is_empty() {
        return None;
    }
    let model = Model::before_last(&round.solution)?;
    let gain = round.solution.gain(last);
    let here = model.on(data)?;
    let own = here.beside(named)?;
    // A rival is as large as it must be to look like the named one on this record.
    let rivals: Vec<(FitTerm, f64, Apart)> = round
        .rivals
        .iter()
        .filter_map(|rival| {
            let term = refined(data, round, rival)?;
            let rival = here.beside(&term)?;
            let size = gain * own.own.dot(&rival.own) / rival.own.norm_squared();
            let now = pair((&own, gain), (&rival, size))?;
            size.is_finite().then_some((term, size, now))
        })
        .collect();
    if rivals.is_empty() {
        return None;
    }
    let noise = round.after.fit.max(f64::MIN_POSITIVE);
    let tried: Vec<Option<((usize, f64), Experiment)>> = Way::all(data)
        .into_par_iter()
        .map(|way| {
            let planned = trajectory(data, way);
            let motion = planned.prepared(data)?;
            let placed = model.on(&motion)?;
            let mut worst = f64::INFINITY;
            let mut aims = Vec::new();
            let own = placed.beside(named)?;
            for (term, size, now) in &rivals {
                let then = pair((&own, gain), (&placed.beside(term)?, *size))?;
                if then.left.is_nan() || then.left < NOISE * noise.max(now.left) {
                    continue;
                }
                worst = worst.min(then.left);
                aims.push(Aim {
                    what: term_name(data, named),
                    rival: Some(term_name(data, term)),
                    correlation_now: now.correlation,
                    correlation_then: then.correlation,
                    left_now: now.left / noise,
                    left_then: then.left / noise,
                });
            }
            let score = (aims.len(), worst);
            Some((score, describe(data, &planned, &motion, aims)))
        })
        .collect();
    best(tried)
}

/// The experiment for the first ambiguous term of a run.
#[must_use]
pub fn separate_first(data: &Prepared, ledger: &Ledger) -> Option<Experiment> {
    ledger.rounds.iter().find_map(|round| separate(data, round))
}

/// The first of the largest, of those that have an aim.
fn best<S: PartialOrd>(tried: Vec<Option<(S, Experiment)>>) -> Option<Experiment> {
    let mut best: Option<(S, Experiment)> = None;
    let aimed = tried
        .into_iter()
        .flatten()
        .filter(|(_, e)| !e.aims.is_empty());
    for (score, experiment) in aimed {
        if best.as_ref().is_none_or(|(b, _)| score > *b) {
            best = Some((score, experiment));
        }
    }
    best.map(|(_, experiment)| experiment)
}

fn describe(
    data: &Prepared,
    planned: &Trajectory,
    motion: &Prepared,
    aims: Vec<Aim>,
) -> Experiment {
    let fastest = |data: &Prepared| {
        let speeds = data.input.motion.iter().map(|m| m.velocity.abs());
        speeds.fold(0.0, f64::max)
    };
    Experiment {
        kind: planned.way.kind,
        way: planned.way,
        trajectory: planned.words.clone(),
        seconds: planned.signals[0].values.len() as f64 * planned.step,
        speed: fastest(motion) / fastest(data).max(f64::MIN_POSITIVE),
        aims,
    }
}

impl Aim {
    /// In words: "viscous from delay: correlation 0.98 → 0.41, …".
    #[must_use]
    pub fn words(&self) -> String {
        let Self { what, .. } = self;
        let (now, then) = (self.correlation_now, self.correlation_then);
        match &self.rival {
            Some(rival) => format!(
                "{what} from {rival}: with the wrong term, {:.1} → {:.1} times the present error (projected correlation {now:.3} → {then:.3})",
                self.left_now, self.left_then
            ),
            None => format!(
                "{what}: {:.1} times as visible as in the present record (share that other terms can reproduce: {now:.3} → {then:.3})",
                self.left_then
            ),
        }
    }
}
