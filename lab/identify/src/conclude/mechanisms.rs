//! Which mechanisms the baseline model lacks: what the missing force depends on.
//!
//! The terms of one mechanism describe one curve. Another record of the same rig often gives other
//! terms, and mostly the same mechanism.

use super::curve::Knot;
use super::final_fit::FinalFit;
use crate::ledger::{Grade, Ledger, Round, Share, Support};
use crate::model::mechanism::Mechanism;
use crate::problem::Prepared;
use crate::score::binned::Bin;
use crate::search::is_at_noise;
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
    /// Share of the baseline's squared error on left-out blocks that it removes.
    pub share: Shares,
    /// High where it leaves at most half of the squared error that any other mechanism leaves, or
    /// where the model is complete and one of its terms is of high confidence.
    pub confidence: Grade,
    /// Other mechanisms that leave less than twice as much in its place.
    pub alternatives: Vec<Mechanism>,
    /// What it adds to the output.
    pub curve: Curve,
    /// Its terms, as the results table names them, in the order of their rounds.
    pub members: Vec<String>,
}

/// The shares of a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Shares {
    /// By itself.
    pub alone: Share,
    /// Beyond all others.
    pub beyond_others: Share,
}

impl Shares {
    /// The larger of the two.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.alone.value.max(self.beyond_others.value)
    }
}

/// What a mechanism adds to the output, over its variable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// The variable in words.
    pub over: String,
    /// Its unit, where the record states it.
    pub unit: Option<String>,
    /// Points with their 95 % intervals, which hold for the motion of this record.
    pub points: Vec<Knot>,
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

/// The mechanisms that the baseline lacks, the largest share first; none where the search added
/// nothing.
#[must_use]
pub fn mechanisms(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Vec<Lack> {
    let is_complete = is_at_noise(data, ledger.last());
    let supported = ledger.supported.iter().flat_map(|found| &found.all);
    let mut all: Vec<Lack> = supported
        .map(|one| lack(data, ledger, done, one, is_complete))
        .collect();
    all.sort_by(|a, b| b.share.most().total_cmp(&a.share.most()));
    all
}

fn lack(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    one: &Support,
    is_complete: bool,
) -> Lack {
    let mechanism = one.mechanism;
    let is_own = |round: &&Round| Mechanism::of_term(round.term()) == mechanism;
    let rounds = || ledger.rounds.iter().filter(is_own);
    let mut members: Vec<String> = rounds().map(|round| done.title_of(round)).collect();
    let unknown = ledger.unknown.as_ref().map(|unknown| unknown.variable);
    let unknown = unknown.filter(|v| Mechanism::of_variable(data, *v) == mechanism);
    members.extend(unknown.map(|v| format!("curve over {}", v.words(data))));
    let mut alternatives = one.alternatives.clone();
    let mut is_high = one.is_clear;
    if is_complete {
        is_high |= rounds().any(|round| round.grade == Grade::High);
        alternatives.extend(rounds().flat_map(|round| others(round, mechanism)));
        alternatives.sort_unstable();
        alternatives.dedup();
    }
    // The clocks explain as much.
    is_high &= ledger.lead.is_none();
    let channel = data.channel(one.source).map_or("", |c| c.name.as_str());
    let point = |bin: &Bin| {
        bin.means.first().map(|mean| Knot {
            at: bin.at,
            value: mean.value,
            ci95: mean.ci95,
        })
    };
    Lack {
        mechanism,
        channel: channel.to_owned(),
        title: title(mechanism, channel, one.source == Source::Input),
        share: Shares {
            alone: one.alone,
            beyond_others: one.beyond,
        },
        confidence: if is_high { Grade::High } else { Grade::Low },
        alternatives,
        curve: Curve {
            over: one.variable.words(data),
            unit: one.variable.unit(data),
            points: one.curve.iter().filter_map(point).collect(),
        },
        members,
    }
}

/// Mechanisms of the alternatives to the terms of a round.
fn others(round: &Round, own: Mechanism) -> impl Iterator<Item = Mechanism> + '_ {
    let all = round.rivals.iter();
    let all = all.map(|rival| Mechanism::of_term(&rival.term));
    all.filter(move |other| *other != own)
}
