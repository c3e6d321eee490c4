//! Where there is no model of the input: whether, and in which words.

use super::changes::is_other_file;
use super::channel_apart::channel_words;
use super::files_apart::apart_words;
use super::final_fit::FinalFit;
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::record::Mode;
use crate::score::explains::{explained, explained_on, Explained};
use bowden::effect::Family;
use bowden::model::Source;

/// Least share of the held-out output that the input explains of a model worth the name.
const LEAST_EXPLAINED: f64 = 0.5;

/// The share of the output that must be explained by what the model is a model of.
///
/// Friction of a joint that moves under a nearly constant load is no spring that stands for the
/// output: what such effects of the channels explain counts.
fn judged(shares: Explained, declared: &Solution, done: &Solution) -> f64 {
    match declared.structure.reads(Source::Input) && !is_friction_alone(done) {
        true => shares.input,
        false => shares.input + shares.channels,
    }
}

/// Whether all that a model reads of the channels is friction, and it reads any of it.
fn is_friction_alone(solution: &Solution) -> bool {
    let terms = solution.structure.terms.iter();
    let mut read = terms.filter(|t| t.source != Source::Input).peekable();
    let is_friction = |family: Family| {
        matches!(
            family,
            Family::Viscous
                | Family::Drag
                | Family::Coulomb
                | Family::Stribeck
                | Family::Presliding
                | Family::PowerLaw
                | Family::PositionFriction
                | Family::LoadFriction
        )
    };
    read.peek().is_some() && read.all(|t| is_friction(t.effect.family()))
}

/// The share of the output that the baseline model explains by the input alone, where a channel
/// stands for the output in the delivered one.
fn stood_in_for(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Option<f64> {
    let shares = explained(data, &done.solution);
    let alone = explained(data, &ledger.declared).input;
    let is = ledger.declared.structure.reads(Source::Input) && shares.channels > shares.time;
    (is && alone >= LEAST_EXPLAINED).then_some(alone)
}

/// Whether nothing explains the held-out part, although the baseline model explains the selection
/// segment, which it was not fitted to: then it is a model, and the held-out part is of another rig,
/// or of another motion.
fn only_held_out_is_lost(data: &Prepared, declared: &Solution, held_out: Explained) -> bool {
    let all = held_out.input + held_out.channels + held_out.time;
    let before = explained_on(data, declared, &data.split.selection);
    all < LEAST_EXPLAINED
        && !data.split.selection.is_empty()
        && judged(before, declared, declared) >= LEAST_EXPLAINED
}

/// Whether there is no model of the input, or none of all files.
pub(super) fn is_no_model(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> bool {
    let shares = explained(data, &done.solution);
    let little = judged(shares, &ledger.declared, &done.solution) < LEAST_EXPLAINED
        && !is_other_file(data, done)
        && !only_held_out_is_lost(data, &ledger.declared, shares);
    ledger.integrates || !ledger.apart.is_empty() || ledger.channel_apart.is_some() || little
}

/// A share of the output's variance, "63 %", "0.4 %", "0 %".
fn share_of(share: f64) -> String {
    let digits = if (0.001..0.1).contains(&share) { 1 } else { 0 };
    format!("{:.digits$} %", 100.0 * share)
}

/// What the input, the other channels and functions of time explain, in one clause.
fn explains(data: &Prepared, shares: Explained) -> String {
    let mut text = format!(
        "the input `{}` explains {} of the held-out output",
        data.input.name,
        share_of(shares.input)
    );
    if shares.channels >= 0.005 && !data.channels.is_empty() {
        text += &format!(", the other channels {}", share_of(shares.channels));
    }
    if shares.time >= 0.005 {
        text += &format!(
            ", and tones and drifts (functions of time only) {}",
            share_of(shares.time)
        );
    }
    text
}

pub(super) fn no_model(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let (input, output) = (&data.input.name, &data.output_name);
    if ledger.integrates {
        let swap = match data.mode {
            Mode::Torque => "they were mixed up".to_owned(),
            Mode::Displacement => format!(
                "`{input}` is the force and `{output}` the motion: a spring in series with a dashpot creeps under a constant force"
            ),
        };
        return format!(
            "The output integrates the input: the rate of `{output}` follows `{input}`, not `{output}` itself. There was no search. Differentiate `{output}` first, or swap the columns if {swap}."
        );
    }
    if let Some(words) = apart_words(data, &ledger.apart) {
        return words;
    }
    if let Some(apart) = &ledger.channel_apart {
        return channel_words(apart);
    }
    if data.is_shuffled() {
        return format!(
            "This record gives no model: neighbouring rows of the input `{input}` have nothing in common, but `{output}` follows it row by row. Are the rows in time order?"
        );
    }
    if data.is_at_rest() {
        return format!(
            "This record gives no model: the input `{input}` is at rest and shows only its sensor's noise. Record a motion."
        );
    }
    let shares = explained(data, &done.solution);
    if let Some(alone) = stood_in_for(data, ledger, done) {
        return format!(
            "This is not a model of the transmission: {}, although in the baseline model alone the input explains {}. A channel repeats the output, as the angle behind a spring does: omit its column.",
            explains(data, shares),
            share_of(alone)
        );
    }
    format!(
        "This record gives no model: {}. Is `{input}` the right input, in the right file, and is its sensor connected?",
        explains(data, shares)
    )
}
