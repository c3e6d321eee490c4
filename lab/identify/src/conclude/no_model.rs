//! Whether there is no model of the input, and why. In a valid model the input explains at least half
//! of the held-out output.

use super::changes::is_other_file;
use super::files_apart::files_scaled;
use super::final_fit::FinalFit;
use super::finding::Finding;
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::record::Mode;
use crate::scale::HALF;
use crate::score::explains::{explained, explained_on, Explained};
use bowden::model::Source;

/// The share of the output explained by the variables that the model describes.
///
/// Friction of a joint that moves under a nearly constant load is not a spring that replaces the
/// output, so the share explained by such effects of the channels counts.
fn judged(shares: Explained, declared: &Solution, done: &Solution) -> f64 {
    match declared.structure.reads(Source::Input) && !is_friction_alone(done) {
        true => shares.input,
        false => shares.input + shares.channels,
    }
}

/// Whether a model has terms on channels, and all of them are friction.
fn is_friction_alone(solution: &Solution) -> bool {
    let terms = solution.structure.terms.iter();
    let mut read = terms.filter(|t| t.source != Source::Input).peekable();
    let is_friction = |family: &str| {
        matches!(
            family,
            "viscous"
                | "drag"
                | "coulomb"
                | "stribeck"
                | "presliding"
                | "power-law"
                | "position-friction"
                | "load-friction"
        )
    };
    read.peek().is_some() && read.all(|t| is_friction(t.effect.info().family))
}

/// The share of the output that the baseline model explains by the input alone, if a channel
/// replaces the output in the delivered model.
fn stood_in_for(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Option<f64> {
    let shares = explained(data, &done.solution);
    let alone = explained(data, &ledger.declared).input;
    let is = ledger.declared.structure.reads(Source::Input) && shares.channels > shares.time;
    (is && alone >= HALF).then_some(alone)
}

/// Whether nothing explains the held-out segment, although the baseline model explains the
/// selection segment, to which it was not fitted. Then the model is valid, and the held-out segment
/// is from another rig or another motion.
fn only_held_out_is_lost(data: &Prepared, declared: &Solution, held_out: Explained) -> bool {
    let all = held_out.input + held_out.channels + held_out.time;
    let before = explained_on(data, declared, &data.split.selection);
    all < HALF && !data.split.selection.is_empty() && judged(before, declared, declared) >= HALF
}

/// Whether one of the files appears to be logged differently from the others.
fn differs_in_a_file(ledger: &Ledger) -> bool {
    let suspicion = ledger.suspicion.as_ref();
    suspicion.is_some_and(|suspicion| suspicion.path.is_some())
}

/// Whether there is no model of the input, or no common model of all files.
pub(super) fn is_no_model(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> bool {
    let shares = explained(data, &done.solution);
    let little = judged(shares, &ledger.declared, &done.solution) < HALF
        && !is_other_file(data, done)
        && !only_held_out_is_lost(data, &ledger.declared, shares);
    ledger.integrates || !ledger.apart.is_empty() || differs_in_a_file(ledger) || little
}

/// Why there is no model.
pub(super) fn no_model(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Finding {
    let (input, output) = (data.input.name.clone(), data.output_name.clone());
    if ledger.integrates {
        let may_creep = data.mode == Mode::Displacement;
        return Finding::OutputIntegrates {
            input,
            output,
            may_creep,
        };
    }
    if let Some(scaled) = files_scaled(data, ledger) {
        return scaled;
    }
    if let Some(suspicion) = ledger
        .suspicion
        .clone()
        .filter(|_| differs_in_a_file(ledger))
    {
        return Finding::LoggedDifferently(suspicion);
    }
    if data.is_shuffled() {
        return Finding::RowsShuffled { input, output };
    }
    if data.is_at_rest() {
        return Finding::InputAtRest { input };
    }
    let explains = explained(data, &done.solution);
    let channels = data.channels.len();
    match stood_in_for(data, ledger, done) {
        Some(alone) => Finding::ChannelTakesOver {
            input,
            explains,
            channels,
            alone,
        },
        None => Finding::NothingExplained {
            input,
            explains,
            channels,
        },
    }
}
