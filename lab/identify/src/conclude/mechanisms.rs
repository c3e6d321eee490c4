//! Which mechanisms the baseline model lacks: the terms of a search, grouped by what the missing
//! force depends on.
//!
//! The terms of one mechanism describe one curve. Another record of the same rig often gives other
//! terms, and mostly the same mechanism.

use super::final_fit::FinalFit;
use crate::ledger::{Grade, Ledger, Round};
use crate::model::mechanism::Mechanism;
use crate::model::structure::FitTerm;
use crate::model::Variable;
use crate::problem::Prepared;
use crate::search::is_at_noise;
use crate::search::policy::HALF;
use bowden::model::Source;
use serde::Serialize;

/// A mechanism that the baseline model lacks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Lack {
    /// Which.
    pub mechanism: Mechanism,
    /// The channel that the missing force depends on.
    pub channel: String,
    /// The mechanism for people, with its channel.
    pub title: String,
    /// Share of the baseline's squared error on the fit segment that its members remove.
    pub share: f64,
    /// High for the mechanism that removes at least half of what all members remove, if no member of
    /// it has an alternative in another mechanism.
    pub confidence: Grade,
    /// Mechanisms of the alternatives to its members.
    pub alternatives: Vec<Mechanism>,
    /// Its terms, as the results table names them, in the order of their rounds.
    pub members: Vec<String>,
}

/// Whether a model is complete: only a complete model can say which term describes a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Complete {
    /// Error of the last model of the search on the fit segment, in multiples of the noise.
    pub floors: Option<f64>,
    /// Whether that is noise.
    pub at_floor: bool,
}

impl Complete {
    pub(crate) fn new(data: &Prepared, ledger: &Ledger) -> Self {
        let last = ledger.last();
        let floors = last.rmse.fit / data.noise_floor;
        Self {
            floors: floors.is_finite().then_some(floors),
            at_floor: is_at_noise(data, last),
        }
    }
}

/// What a mechanism depends on, for people.
fn title(mechanism: Mechanism, channel: &str, is_input: bool) -> String {
    match mechanism {
        Mechanism::Friction => format!("friction over the velocity of {channel}"),
        Mechanism::Elastic => format!("elasticity over {channel}"),
        Mechanism::Inertia => format!("inertia over the acceleration of {channel}"),
        Mechanism::ContactMemory => format!("contact memory of {channel}"),
        Mechanism::HysteresisShape => "shape of the hysteresis".to_owned(),
        Mechanism::Time if is_input => "change over time".to_owned(),
        Mechanism::Time => format!("change with {channel}"),
    }
}

impl Mechanism {
    fn of_term(term: &FitTerm) -> Self {
        Self::of(term.effect.name(), term.effect.family())
    }

    fn of_variable(variable: Variable) -> Self {
        match variable {
            Variable::Velocity(_) | Variable::DirectedPosition(_) | Variable::DirectedLoad(_) => {
                Self::Friction
            }
            Variable::Position(_) => Self::Elastic,
            Variable::Acceleration(_) => Self::Inertia,
            Variable::ReversalDistance(_) | Variable::ReversalTime(_) => Self::ContactMemory,
            Variable::Eta => Self::HysteresisShape,
            Variable::Time => Self::Time,
        }
    }
}

/// The sentence that names them.
#[must_use]
pub fn lacking(all: &[Lack]) -> String {
    let titles: Vec<&str> = all.iter().map(|lack| lack.title.as_str()).collect();
    let titles = match &titles[..] {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        titles => titles.concat(),
    };
    format!("The baseline model lacks {titles}.")
}

/// The mechanisms that the delivered model adds to the baseline, the largest share first.
#[must_use]
pub fn mechanisms(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<Lack> {
    let unit = ledger.declared.rmse.fit.powi(2);
    let share = |before: f64, after: f64| (before.powi(2) - after.powi(2)) / unit;
    let mut all: Vec<(Source, Lack)> = Vec::new();
    for round in &ledger.rounds {
        let term = round.term();
        let lack = entry(data, &mut all, Mechanism::of_term(term), term.source);
        lack.share += share(round.before.fit, round.after.fit);
        lack.members.push(done.title_of(round));
        for other in others(round, lack.mechanism) {
            if !lack.alternatives.contains(&other) {
                lack.alternatives.push(other);
            }
        }
    }
    if let Some(unknown) = &ledger.unknown {
        let variable = unknown.variable;
        let mechanism = Mechanism::of_variable(variable);
        let lack = entry(data, &mut all, mechanism, variable.source());
        lack.share += share(unknown.before.fit, unknown.after.fit);
        lack.members
            .push(format!("curve over {}", variable.words(data)));
    }
    let mut all: Vec<Lack> = all.into_iter().map(|(_, lack)| lack).collect();
    let whole: f64 = all.iter().map(|lack| lack.share).sum();
    for lack in &mut all {
        if lack.share >= HALF * whole && lack.alternatives.is_empty() {
            lack.confidence = Grade::High;
        }
    }
    all.sort_by(|a, b| b.share.total_cmp(&a.share));
    all
}

/// Mechanisms of the alternatives to the terms of a round.
fn others(round: &Round, own: Mechanism) -> impl Iterator<Item = Mechanism> + '_ {
    let all = round
        .rivals
        .iter()
        .map(|rival| Mechanism::of_term(&rival.term));
    all.filter(move |other| *other != own)
}

/// The entry of a mechanism on a channel, a new one if there is none.
fn entry<'a>(
    data: &Prepared,
    all: &'a mut Vec<(Source, Lack)>,
    mechanism: Mechanism,
    source: Source,
) -> &'a mut Lack {
    // The shape of the hysteresis and a change over time have no channel of their own.
    let is_whole = mechanism == Mechanism::HysteresisShape;
    let source = if is_whole { Source::Input } else { source };
    let known = all
        .iter()
        .position(|(of, lack)| *of == source && lack.mechanism == mechanism);
    let index = known.unwrap_or_else(|| {
        let channel = data.channel(source).map_or("", |c| c.name.as_str());
        let lack = Lack {
            mechanism,
            channel: channel.to_owned(),
            title: title(mechanism, channel, source == Source::Input),
            share: 0.0,
            confidence: Grade::Low,
            alternatives: Vec::new(),
            members: Vec::new(),
        };
        all.push((source, lack));
        all.len() - 1
    });
    &mut all[index].1
}
