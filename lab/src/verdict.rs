//! One verdict for a whole run, and the sentence that goes with it.

use crate::channels::Prepared;
use crate::closing::Ledger;
use crate::fit::Solution;
use crate::intervals::term_name;
use crate::record::Defect;
use crate::scan::Regime;
use crate::whiteness::is_white;

/// What the run amounts to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// What is left is the sensor's noise.
    Explained,
    /// What is left is coloured, but nothing of the catalogue takes it.
    ExplainedColoured,
    /// What is left depends on something measured, in a way that has no name.
    Unknown,
    /// An added effect has rivals that this record cannot tell from it.
    Confounded,
    /// Too few independent stretches for a test: names are proposals.
    UnderExcited,
    /// What was concluded rests on a measurement that is spoilt.
    DataDefect,
    /// The search was ended by request, and more than noise is left.
    Stopped,
}

impl Verdict {
    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Explained => "explained",
            Self::ExplainedColoured => "explained-coloured",
            Self::Unknown => "unknown",
            Self::Confounded => "confounded",
            Self::UnderExcited => "under-excited",
            Self::DataDefect => "data-defect",
            Self::Stopped => "stopped",
        }
    }
}

/// Error that counts as being at the noise floor, as a multiple of it: the floor is an
/// estimate from the top of the band and assumes white noise.
const AT_FLOOR: f64 = 1.2;

/// Defects that spoil what was concluded: grave ones of time, input, output, and of the
/// channels that the model reads.
fn spoils<'a>(data: &'a Prepared, last: &'a Solution) -> impl Iterator<Item = &'a Defect> {
    let reads = |name: &str| {
        let mut sources = last
            .structure
            .terms
            .iter()
            .filter_map(|t| data.channel(t.source));
        sources.any(|channel| channel.name == name)
    };
    data.defects.iter().filter(move |defect| {
        let name = defect.channel.as_str();
        defect.grave && (data.channels.iter().all(|c| c.name != name) || reads(name))
    })
}

/// The verdict on a ledger.
#[must_use]
pub fn verdict(data: &Prepared, ledger: &Ledger) -> Verdict {
    let last = ledger.last();
    let untested = ledger.rounds.iter().any(|r| r.p.is_none());
    // Where nothing was looked for there are no names that a test could be too weak for.
    let only_fitted = ledger.stopped_by_request.is_some() && ledger.rounds.is_empty();
    if spoils(data, last).next().is_some() {
        Verdict::DataDefect
    } else if ledger.unknown.is_some() && !untested {
        Verdict::Unknown
    } else if untested || (ledger.regime == Regime::Effect && !only_fitted) {
        Verdict::UnderExcited
    } else if ledger.rounds.iter().any(|r| !r.rivals.is_empty()) {
        Verdict::Confounded
    } else if last.rmse.fit <= AT_FLOOR * data.noise_floor {
        Verdict::Explained
    } else if ledger.stopped_by_request.is_some() {
        Verdict::Stopped
    } else if is_white(data, last) {
        Verdict::Explained
    } else {
        Verdict::ExplainedColoured
    }
}

/// What the residual depends on without a name.
#[must_use]
pub fn unknown_words(data: &Prepared, ledger: &Ledger) -> Option<String> {
    let unknown = ledger.unknown.as_ref()?;
    Some(format!(
        "The residual depends on {}; the catalogue explains {:.0} % of it.",
        unknown.variable.words(data),
        100.0 * unknown.q
    ))
}

/// The verdict in a sentence or two.
#[must_use]
pub fn sentence(data: &Prepared, ledger: &Ledger) -> String {
    let last = ledger.last();
    let added: Vec<String> = ledger
        .rounds
        .iter()
        .map(|r| term_name(data, &r.candidate.term))
        .collect();
    let mut text = match added.len() {
        0 if ledger.unknown.is_some() => {
            "The declared model lacks something that is in no catalogue.".to_owned()
        }
        0 if ledger.stopped_by_request.is_some() => "The declared model was fitted.".to_owned(),
        0 => "The declared model lacks no effect that this record could show.".to_owned(),
        _ => {
            // Both have been fitted to the same data.
            let kept = last.rmse.held_out / ledger.declared.rmse.held_out;
            format!(
                "The declared model lacks {}: with it the held-out error falls {:.1}-fold.",
                added.join(", then "),
                1.0 / kept
            )
        }
    };
    let found = verdict(data, ledger);
    let rest = match found {
        Verdict::Explained => "What is left is the sensor's noise.".to_owned(),
        Verdict::ExplainedColoured => {
            "What is left is coloured, but nothing in the catalogue takes it.".to_owned()
        }
        Verdict::Unknown => unknown_words(data, ledger).unwrap_or_default(),
        Verdict::Confounded => {
            let rivals: Vec<String> = ledger
                .rounds
                .iter()
                .filter(|r| !r.rivals.is_empty())
                .map(|r| {
                    let names: Vec<String> =
                        r.rivals.iter().map(|c| term_name(data, &c.term)).collect();
                    format!(
                        "{} from {}",
                        term_name(data, &r.candidate.term),
                        names.join(", ")
                    )
                })
                .collect();
            format!("This record cannot tell {}.", rivals.join("; nor "))
        }
        Verdict::UnderExcited => {
            "The record has too few independent stretches for a test: take the names as proposals."
                .to_owned()
        }
        Verdict::DataDefect => {
            let list: Vec<String> = spoils(data, last)
                .map(|defect| format!("{} ({})", defect.channel, defect.kind.name()))
                .collect();
            format!("But the measurement itself is spoilt: {}.", list.join(", "))
        }
        Verdict::Stopped => ledger.stopped_words().unwrap_or_default(),
    };
    text.push(' ');
    text.push_str(&rest);
    if let Some(words) = ledger.stopped_words().filter(|_| found != Verdict::Stopped) {
        text.push(' ');
        text.push_str(&words);
    }
    if ledger.rounds.len() > 3 {
        text.push_str(
            " Names after the third round carry little meaning: by then many effects would do.",
        );
    }
    text
}
