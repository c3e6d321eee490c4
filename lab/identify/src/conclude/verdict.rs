//! One verdict for a whole run, and the sentence that goes with it.
//!
//! The sentence is what somebody pastes into a report: it speaks of the delivered model, in
//! the figures that stand above it, and says what the model must not be used for.

use super::ballast::Part;
use super::by_file::worse;
use super::changes::{
    extrapolates, other_line, other_rig, starts_apart, unseen_motion, velocity_words,
};
use super::changes::{made_without_input, stands_for_output};
use super::channel_apart::channel_words;
pub use super::errors::{falls_up_to, held_out_ratio, percent, raises, POOR, RISES};
use super::errors::{
    floors, is_noise, is_worse, multiples, names, poor_words, worse_than_a_constant,
};
use super::excitation::without_reversals;
use super::files_apart::{another_zero, apart_words, rigs_words};
use super::final_fit::FinalFit;
use super::intervals::term_title;
use super::lacks::{lacks, rises};
use super::no_model::{is_no_model, no_model};
use super::resolution::coarse_words;
use super::rivals::each_pair_once;
use super::signs::{
    exchanged_words, falls, of_temperature, of_tension, of_the_motion, turns_against,
};
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::model::catalogue::Candidate;
use crate::problem::Prepared;
use crate::record::{Defect, Mode};
use crate::score::blocks::Regime;
use crate::score::explains::{deviations, segments_differ};
use crate::score::whiteness::is_white;
use crate::search::policy::AT_FLOOR;
use bowden::model::Source;

/// What the run amounts to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The input explains less than half of the output, the output integrates it, or one file has
    /// another gain than the others.
    NoInputDependence,
    /// The delivered model predicts held-out data worse than the declared one, worse than a
    /// constant, or with many times the error of the fit segment.
    NotTransferable,
    /// The residual is the sensor's noise, on the fit segment and held out.
    Explained,
    /// The residual is more than that, and no effect of the catalogue was found in it.
    StructuredResidual,
    /// The residual depends on something measured, in a way that has no name.
    UnmodelledDependence,
    /// An added effect has rivals that this record cannot tell from it.
    Ambiguous,
    /// Too few independent stretches for a test: names are proposals.
    UnderExcited,
    /// What was concluded rests on a measurement that is spoilt.
    DefectiveRecord,
    /// The search was ended by request, and more than noise is left.
    Stopped,
}

impl Verdict {
    /// The name in the JSON.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::NoInputDependence => "no-input-dependence",
            Self::NotTransferable => "not-transferable",
            Self::Explained => "explained",
            Self::StructuredResidual => "structured-residual",
            Self::UnmodelledDependence => "unmodelled-dependence",
            Self::Ambiguous => "ambiguous",
            Self::UnderExcited => "under-excited",
            Self::DefectiveRecord => "defective-record",
            Self::Stopped => "stopped",
        }
    }
}

/// Least share of an unmodelled curve, taken by names to first order, at which the sentence says
/// why the curve was preferred. A choice: a reader who is told "95 %" asks why there is no name.
const NEARLY_ALL: f64 = 0.9;

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

/// The verdict on a ledger and the model that it delivers.
#[must_use]
pub fn verdict(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Verdict {
    let last = ledger.last();
    let untested = ledger.rounds.iter().any(|r| r.p.is_none());
    // Where nothing was looked for there are no names that a test could be too weak for.
    let only_fitted = ledger.is_stopped() && ledger.rounds.is_empty();
    if spoils(data, last).next().is_some() {
        Verdict::DefectiveRecord
    } else if is_no_model(data, ledger, done) {
        Verdict::NoInputDependence
    } else if is_worse(ledger, done)
        || worse_than_a_constant(data, done)
        || other_rig(data, done).is_some()
    {
        Verdict::NotTransferable
    } else if ledger.unknown.is_some() && !untested {
        Verdict::UnmodelledDependence
    } else if untested
        || (ledger.regime == Regime::Effect && !only_fitted)
        || is_one_stroke(data, done)
    {
        Verdict::UnderExcited
    } else if ledger.rounds.iter().any(|r| !r.rivals.is_empty()) {
        Verdict::Ambiguous
    } else if floors(data, done).is_some_and(|errors| is_noise(data, errors)) {
        Verdict::Explained
    } else if ledger.is_stopped() {
        Verdict::Stopped
    } else {
        Verdict::StructuredResidual
    }
}

/// Whether a hysteresis was fitted to a record without its reversals.
fn is_one_stroke(data: &Prepared, done: &FinalFit) -> bool {
    done.solution.structure.hysteresis && without_reversals(data).is_some()
}

/// What is to be said of such a record.
fn one_stroke(data: &Prepared) -> String {
    format!(
        "`{}` reverses fewer than two times on the fit segment: sigma and n are not identified, and the model holds for this stroke only. Record strokes in both directions.",
        data.input.name
    )
}

/// What the residual depends on without a name.
#[must_use]
pub fn unknown_words(data: &Prepared, ledger: &Ledger) -> Option<String> {
    let unknown = ledger.unknown.as_ref()?;
    // What names would take is known to first order; what was refitted and tested is decisive.
    let but = match unknown.q >= NEARLY_ALL {
        true => ", but none is accepted after a refit",
        false => "",
    };
    Some(format!(
        "The residual depends on {}; to first order, the best one or two effects of the catalogue explain {:.0} % of what a curve over it explains{but}.",
        unknown.variable.words(data),
        100.0 * unknown.q
    ))
}

fn coloured(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    if let Some((_, held_out)) = floors(data, done).filter(|(fit, _)| *fit <= AT_FLOOR) {
        return format!(
            "The residual is the sensor's noise on the fit segment, but {held_out:.1} times this noise on the held-out segment: the two segments differ."
        );
    }
    let size = match multiples(data, done) {
        Some(size) => format!("The residual is {size}"),
        None => "The record does not show its noise floor (the cut-off is too close to half the sampling rate)".to_owned(),
    };
    match is_white(data, ledger.last()) {
        true => {
            format!("{size}; it looks like white noise and depends on no measured quantity.")
        }
        // The first sentence says already that no effect was found.
        false if ledger.rounds.is_empty() => format!("{size}; it is coloured."),
        false => {
            format!("{size}; it is coloured, but no further effect of the catalogue explains it.")
        }
    }
}

fn confounded(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let rounds = ledger.rounds.iter().map(|round| {
        let rivals = round.rivals.iter();
        let rivals = rivals.map(|rival| term_title(data, &rival.term));
        (done.title_of(round), rivals.collect())
    });
    let pairs = each_pair_once(rounds);
    format!("This record cannot distinguish {}.", pairs.join("; nor "))
}

/// `backlash`, `play(x) - x`, is `presliding`, `(x - play(x))/r`, with another factor: what is to be
/// said of either.
fn one_function(data: &Prepared, done: &FinalFit) -> Option<String> {
    let mut terms = done.solution.structure.terms.iter();
    let term = terms.find(|term| Candidate::twin(term).is_some())?;
    let is_on_the_spring = data.mode == Mode::Displacement && term.source == Source::Input;
    let own = match is_on_the_spring && done.solution.structure.hysteresis {
        true => {
            "; with the sign of kappa_x, presliding is a slipping spring; with the opposite sign, it is slack"
        }
        false => "",
    };
    Some(format!(
        "Presliding and backlash are one function with opposite signs: either name is right{own}."
    ))
}

/// What is to be said of a hysteresis that is ballast.
fn ballast(done: &FinalFit) -> Option<String> {
    if done.without_hysteresis.is_some() {
        return Some(
            "The baseline hysteresis is excluded from the model: this record cannot distinguish it from a spring and an offset."
                .to_owned(),
        );
    }
    let part = Part::of(&done.data, &done.solution).filter(Part::is_ballast)?;
    Some(format!(
        "On this record the hysteresis differs from a spring and an offset by {} of the output: their gains cancel each other, and the model holds only within the recorded range.",
        percent(part.own)
    ))
}

/// What goes with a verdict, after the sentence on the held-out error.
fn rest(data: &Prepared, ledger: &Ledger, done: &FinalFit, found: Verdict) -> String {
    match found {
        Verdict::Explained => "The residual is the sensor's noise.".to_owned(),
        Verdict::StructuredResidual => coloured(data, ledger, done),
        Verdict::UnmodelledDependence => unknown_words(data, ledger).unwrap_or_default(),
        Verdict::Ambiguous => confounded(data, ledger, done),
        Verdict::UnderExcited if is_one_stroke(data, done) => one_stroke(data),
        Verdict::UnderExcited => {
            let names = match ledger.rounds.is_empty() {
                true => "only a large effect would be found",
                false => "the named terms are proposals",
            };
            format!("The record has too few independent stretches for a test: {names}.")
        }
        Verdict::DefectiveRecord => {
            let list: Vec<String> = spoils(data, ledger.last())
                .map(|defect| format!("{} ({})", defect.channel, defect.kind.name()))
                .collect();
            format!(
                "The measurement is defective: {}. Correct the cause and record again.",
                list.join(", ")
            )
        }
        Verdict::Stopped => multiples(data, done)
            .map_or_else(String::new, |size| format!("The residual is {size}.")),
        Verdict::NoInputDependence | Verdict::NotTransferable => String::new(),
    }
}

/// What else somebody must know who reads nothing but the sentence.
fn warnings(data: &Prepared, ledger: &Ledger, done: &FinalFit, found: Verdict) -> Vec<String> {
    let mut all: Vec<String> = velocity_words(data).into_iter().collect();
    // What a channel of the wrong sign has brought in says nothing about clocks.
    let is_mended = ledger.channel_apart.is_some();
    let says_no_size = matches!(
        found,
        Verdict::UnmodelledDependence | Verdict::Ambiguous | Verdict::UnderExcited
    );
    if says_no_size && floors(data, done).is_some_and(|errors| !is_noise(data, errors)) {
        all.extend(multiples(data, done).map(|size| format!("The residual is {size}.")));
    }
    if found == Verdict::DefectiveRecord {
        all.extend(apart_words(data, &ledger.apart));
        all.extend(ledger.channel_apart.as_ref().map(channel_words));
    }
    if found != Verdict::NotTransferable {
        all.extend(poor_words(data, done));
    }
    if found != Verdict::UnderExcited && is_one_stroke(data, done) {
        all.push(one_stroke(data));
    }
    all.extend(exchanged_words(data, ledger));
    all.extend(extrapolates(data, done));
    all.extend(unseen_motion(data, done));
    all.extend(rigs_words(ledger).or_else(|| another_zero(data, &done.solution)));
    all.extend(one_function(data, done));
    all.extend(starts_apart(data, &done.solution));
    all.extend(ballast(done));
    all.extend(of_the_motion(data, &done.solution));
    all.extend(of_tension(data, &done.solution));
    all.extend(of_temperature(data, &done.solution));
    all.extend(falls(data, &done.solution));
    all.extend(turns_against(done));
    all.extend(coarse_words(data, ledger));
    if let Some(channel) = stands_for_output(data, &ledger.declared, &done.solution) {
        all.push(format!(
            "Nearly all of the model's output comes from `{channel}`, although the baseline model does not need it: does it measure the output, as the angle behind a spring does? If so, omit its column."
        ));
    } else if let Some(channel) = made_without_input(data, &done.solution) {
        all.push(format!(
            "Nearly all of the model's output comes from `{channel}` and none from `{}`: in this record the load follows `{channel}`, so the model describes the load. It will not hold with another load: record another load, or name the transmission's terms in --baseline.",
            data.input.name
        ));
    } else if let Some(lead) = ledger.lead.filter(|_| !is_mended) {
        all.push(clocks(data, done, lead));
    }
    all.extend(ledger.stopped_words());
    if segments_differ(data) {
        let (fit, held_out) = deviations(data);
        all.push(match fit > held_out {
            true => format!("The output moves {:.0} times less on the held-out segment than on the fit segment: their percentages are not comparable.", fit / held_out),
            false => format!("The output moves {:.0} times more on the held-out segment than on the fit segment: their percentages are not comparable.", held_out / fit),
        });
    }
    let fell = falls_up_to(ledger);
    if found != Verdict::NotTransferable && fell < ledger.rounds.len() {
        let first = &names(ledger, done)[fell];
        all.push(match fell {
            0 => format!("On held-out data the first term, {first}, already raises the error."),
            n => format!("On held-out data the error falls up to round {n}; {first} raises it."),
        });
    }
    for file in worse(data, &ledger.declared, &done.solution) {
        all.push(format!(
            "The error rises for {}: {:.1} % → {:.1} %.",
            file.path,
            100.0 * file.before,
            100.0 * file.after
        ));
    }
    if ledger.rounds.len() > 3 {
        all.push(
            "Terms after the third one carry little meaning: several effects would fit equally well."
                .to_owned(),
        );
    }
    all
}

/// Multiple of the noise floor from which a lead is no matter of clocks alone. A choice.
const MUCH: f64 = 3.0;

/// What is to be said of an output that comes before its input by so much \[s\]. Where the residual is
/// large, the lead may be a part of the rig that the model lacks.
fn clocks(data: &Prepared, done: &FinalFit, lead: f64) -> String {
    let ms = 1e3 * lead;
    match floors(data, done).is_some_and(|(fit, _)| fit > MUCH) {
        true => format!(
            "In the model the output precedes the input by about {ms:.1} ms, which is not causal: either the two were logged on different clocks, or the lead is an effect that the model lacks."
        ),
        false => format!(
            "The output precedes the input by about {ms:.1} ms, which is not causal: were both logged on one clock?"
        ),
    }
}

/// The verdict in a few sentences, the one that matters most first.
#[must_use]
pub fn sentence(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let found = verdict(data, ledger, done);
    let mut all = match found {
        Verdict::NoInputDependence => {
            let words = velocity_words(data).into_iter();
            let all = std::iter::once(no_model(data, ledger, done)).chain(words);
            return all.collect::<Vec<_>>().join(" ");
        }
        Verdict::NotTransferable => {
            vec![rises(data, ledger, done) + &other_line(data, done).unwrap_or_default()]
        }
        _ => vec![lacks(data, ledger, done), rest(data, ledger, done, found)],
    };
    all.extend(warnings(data, ledger, done, found));
    all.join(" ")
}
