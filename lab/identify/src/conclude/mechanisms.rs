//! The mechanisms that are missing from the baseline model: what the missing force depends on.
//!
//! The terms of one mechanism describe one curve. Another record of the same rig often gives other
//! terms, but usually the same mechanism.

use super::changes::velocity;
use super::curve::Knot;
use super::final_fit::FinalFit;
use super::intervals::term_name;
use crate::ledger::{Grade, Ledger, Round, Share, Support};
use crate::model::mechanism::Mechanism;
use crate::model::structure::Structure;
use crate::problem::Prepared;
use crate::score::binned::Bin;
use crate::search::is_at_noise;
use crate::search::support::alone;
use bowden::model::Source;
use serde::Serialize;

/// A mechanism that the baseline model lacks.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Lack {
    /// Which.
    pub mechanism: Mechanism,
    /// The channel that the missing force depends on.
    pub channel: String,
    /// The mechanism in words, with its channel.
    pub title: String,
    /// Share of the baseline's squared error on left-out blocks that it removes.
    pub share: Shares,
    /// High if it leaves at most half of the squared error that any other mechanism leaves, or if
    /// the model is complete and one of its terms has high confidence.
    pub confidence: Grade,
    /// Other mechanisms that, instead of it, leave less than twice as much squared error.
    pub alternatives: Vec<Mechanism>,
    /// Its contribution to the output.
    pub curve: Curve,
    /// Its terms, as the results table names them, in the order of their rounds.
    pub members: Vec<String>,
    /// Other terms that describe it as well, the best first; none if the model is complete.
    pub described_by: Vec<DescribedBy>,
}

/// Terms that describe a mechanism as well as its members.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DescribedBy {
    /// Their names.
    pub effects: Vec<String>,
    /// Rms error with them on the fit segment, over that with the members.
    pub error_ratio: f64,
}

impl DescribedBy {
    /// The terms in words, and the error with them.
    #[must_use]
    pub fn words(&self) -> String {
        let effects = self.effects.join(" + ");
        format!("{effects} ({:.2} × the error)", self.error_ratio)
    }
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
    /// The larger of the two shares.
    #[must_use]
    pub fn most(&self) -> f64 {
        self.alone.value.max(self.beyond_others.value)
    }
}

/// The contribution of a mechanism to the output, over the mechanism's variable.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// The variable in words.
    pub over: String,
    /// Its unit, if the record states it.
    pub unit: Option<String>,
    /// Points with their 95 % intervals, which hold for the motion of this record.
    pub points: Vec<Knot>,
}

/// The answer of one of several files by itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FileAlone {
    /// The file.
    pub path: String,
    /// The mechanisms that are missing if the baseline model is fitted to this file alone; `None`
    /// if the file is too short for an answer.
    pub lacks: Option<Vec<LackAlone>>,
}

/// A mechanism that is missing from the baseline model, fitted to one file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LackAlone {
    /// Which.
    pub mechanism: Mechanism,
    /// The channel that the missing force depends on.
    pub channel: String,
    /// The mechanism in words, with its channel.
    pub title: String,
    /// Share of the baseline's squared error on left-out blocks that it removes by itself.
    pub share: Share,
    /// High if it leaves at most half of the squared error that any other mechanism leaves.
    pub confidence: Grade,
}

impl FileAlone {
    /// Finds the mechanisms of one file.
    pub(crate) fn new(path: &str, asked: Option<(Prepared, Structure)>) -> Self {
        let answer = asked.and_then(|(data, structure)| {
            let supported = alone(&data, &structure)?;
            let lacks = supported.all.iter().map(|one| LackAlone::new(&data, one));
            Some(lacks.collect())
        });
        Self {
            path: path.to_owned(),
            lacks: answer,
        }
    }
}

impl LackAlone {
    fn new(data: &Prepared, one: &Support) -> Self {
        let (channel, title) = channel_and_title(data, one);
        Self {
            mechanism: one.mechanism,
            channel,
            title,
            share: one.alone,
            confidence: if one.is_clear {
                Grade::High
            } else {
                Grade::Low
            },
        }
    }
}

/// A mechanism that all files together support, or one of them alone with high confidence.
#[derive(Debug, Clone, PartialEq)]
pub struct Across<'a> {
    /// The mechanism in words.
    pub title: &'a str,
    /// Whether the joint fit supports it.
    pub is_joint: bool,
    /// For each file that has an answer: the path, and the confidence by itself, which is `None` if
    /// the file does not support the mechanism.
    pub files: Vec<(&'a str, Option<Grade>)>,
}

/// Each mechanism with the answers of the files, the mechanisms of the joint fit first.
#[must_use]
pub fn across<'a>(joint: &'a [Lack], files: &'a [FileAlone]) -> Vec<Across<'a>> {
    let mut all: Vec<(Mechanism, &str, bool)> = Vec::new();
    let of_joint = joint.iter().map(|own| (own.mechanism, &*own.title, true));
    let own = files.iter().flat_map(|file| file.lacks.iter().flatten());
    let own = own.filter(|own| own.confidence == Grade::High);
    for one in of_joint.chain(own.map(|own| (own.mechanism, &*own.title, false))) {
        if all.iter().all(|known| known.0 != one.0) {
            all.push(one);
        }
    }
    let of = |(mechanism, title, is_joint)| {
        let answer = |file: &'a FileAlone| {
            let own = file
                .lacks
                .as_ref()?
                .iter()
                .find(|l| l.mechanism == mechanism);
            Some((file.path.as_str(), own.map(|own| own.confidence)))
        };
        Across {
            title,
            is_joint,
            files: files.iter().filter_map(answer).collect(),
        }
    };
    all.into_iter().map(of).collect()
}

/// Whether a model is complete: only a complete model can say which term describes a mechanism.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Complete {
    /// Error of the last model of the search on the fit segment, in multiples of the noise.
    pub floors: Option<f64>,
    /// Whether this error is noise.
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

/// The channel that a mechanism depends on, and the mechanism in words.
fn channel_and_title(data: &Prepared, one: &Support) -> (String, String) {
    let channel = data.channel(one.source).map_or("", |c| c.name.as_str());
    let is_input = one.source == Source::Input;
    let title = match one.mechanism {
        Mechanism::Friction => format!("friction over the velocity of {channel}"),
        Mechanism::Elastic => format!("elasticity over {channel}"),
        Mechanism::Inertia => format!("inertia over the acceleration of {channel}"),
        Mechanism::ContactMemory => format!("contact memory of {channel}"),
        Mechanism::HysteresisShape => "shape of the hysteresis".to_owned(),
        Mechanism::Time if is_input => "change over time".to_owned(),
        Mechanism::Time => format!("change with {channel}"),
    };
    (channel.to_owned(), title)
}

/// The sentence that names the missing mechanisms.
#[must_use]
pub fn lacking(all: &[Lack]) -> String {
    let titles: Vec<&str> = all.iter().map(|lack| lack.title.as_str()).collect();
    let titles = match &titles[..] {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        titles => titles.concat(),
    };
    format!("The baseline model lacks {titles}.")
}

/// The mechanisms that are missing from the baseline, the largest share first; none if the search
/// added nothing.
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
    // Something in the data explains as much: the clocks, the columns, or the files.
    let of_columns = ledger.suspicion.is_some() || velocity(data).is_some();
    let is_doubtful = of_columns || ledger.rigs_apart.is_some();
    is_high &= ledger.lead.is_none() && !is_doubtful;
    // They represent all terms of the search, not only the first.
    let is_whole = !ledger.beyond.iter().any(|round| is_own(&round));
    let others = ledger.descriptions.iter();
    let others = others.filter(|own| is_whole && own.mechanism == mechanism);
    let described_by = others.map(|own| DescribedBy {
        effects: own
            .terms
            .iter()
            .map(|candidate| term_name(data, &candidate.term))
            .collect(),
        error_ratio: own.error_ratio,
    });
    let (channel, title) = channel_and_title(data, one);
    let point = |bin: &Bin| {
        bin.means.first().map(|mean| Knot {
            at: bin.at,
            value: mean.value,
            ci95: mean.ci95,
        })
    };
    Lack {
        mechanism,
        channel,
        title,
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
        described_by: described_by.collect(),
    }
}

/// Mechanisms of the alternatives to the terms of a round.
fn others(round: &Round, own: Mechanism) -> impl Iterator<Item = Mechanism> + '_ {
    let all = round.rivals.iter();
    let all = all.map(|rival| Mechanism::of_term(&rival.term));
    all.filter(move |other| *other != own)
}
