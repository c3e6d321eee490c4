//! The verdict of a validation in one or two sentences.

use super::CheckFacts;
use crate::check::{Fitted, Line, Otherwise, Verdict, Way, FAINT, HOLDS, JUST, NOISE, NOTHING};
use crate::conclude::files_apart::is_far;
use crate::conclude::verdict::POOR;
use crate::facts::numbers::{number, share as percent, with_interval};
use std::fmt::Write as _;

/// Largest share of noise in the output's standard deviation without a remark.
const LITTLE: f64 = 0.2;

/// For a model that holds, gain and offset are mentioned if with them less than this share of its
/// error remains.
const BETTER: f64 = 0.8;

/// A model hardly depends on its input if the input contributes less than this share of the
/// output's standard deviation. A choice.
const HARDLY: f64 = 0.1;

/// Only the offset has changed if a gain in addition divides the error by no more than this. A
/// choice.
const ALIKE: f64 = 1.05;

fn fitted(one: &Fitted) -> String {
    with_interval(one.value, one.ci95)
}

fn unit(check: &CheckFacts) -> String {
    let unit = check.record.unit.as_deref();
    unit.map_or_else(String::new, |unit| format!(" {unit}"))
}

/// The error up to which a model holds.
pub(super) fn rule(check: &CheckFacts) -> String {
    let noise = format!("{NOISE} times the noise floor");
    let Some(own) = check.reference else {
        return noise;
    };
    if HOLDS * own > NOTHING {
        return format!(
            "the larger of two values: {} of the standard deviation (less than {HOLDS} times the model's own held-out error, because above this limit a model explains less than half of the output's variance); and {noise}",
            percent(NOTHING)
        );
    }
    let own = format!("{HOLDS} times the model's own held-out error");
    match check.reference_rmse.is_some() {
        true => format!(
            "the largest of three values: {own}, as a share of the standard deviation; {own} in the output's unit, but at most {} of the standard deviation; and {noise}",
            percent(FAINT)
        ),
        false => format!("the larger of two values: {own}, as a share of the standard deviation; and {noise}"),
    }
}

/// A remark that a poor model does not become good because it holds.
fn was_poor(check: &CheckFacts) -> &'static str {
    match check.reference.is_some_and(|own| own >= POOR) {
        true => " Its error on its own record is large too: `holds` does not make it a good model.",
        false => "",
    }
}

/// The validation in one or two sentences.
pub(super) fn sentence(check: &CheckFacts) -> String {
    let share = |rmse: f64| percent(rmse / check.deviation);
    let as_it_is = share(check.rmse);
    let came = check.reference.map_or_else(
        || "an unknown error on its own record (its file states none)".to_owned(),
        |own| format!("{} on the held-out part of its own record", percent(own)),
    );
    let mut text = match check.verdict {
        Verdict::Holds if check.reference.is_some_and(|own| check.rmse <= HOLDS * own * check.deviation) => format!(
            "The model holds: its error is {as_it_is} of this record's output, compared with {came}; nothing was refitted.{}",
            was_poor(check)
        ),
        Verdict::Holds if check.is_as_at_home && !is_noise(check) => format!(
            "The model holds: its error is {}; nothing was refitted. The output moves less here, so this error is {as_it_is} of the output, compared with {came}.",
            in_its_unit(check)
        ),
        Verdict::Holds => format!(
            "The model holds: its error, {as_it_is} of this record's output, is the sensor's noise; nothing was refitted.{}",
            hardly_moves(check)
        ),
        Verdict::GainOrOffsetMoved => format!(
            "The {}, and no other change is visible: the model as it is has an error of {as_it_is} of this record's output, with this correction {}, compared with {came}.{}",
            moved(check, check.offset_alone),
            share(check.rmse_corrected),
            another_unit(check)
        ),
        Verdict::DoesNotHold if check.is_inverted => {
            return format!(
                "The model does not hold: its error is {as_it_is} of this record's output. With the sign of the output reversed (gain {}) its error is {}, compared with {came}: is a sensor or the drive connected with the opposite sign?",
                fitted(&check.line.gain),
                share(check.rmse_gain_offset)
            )
        }
        Verdict::DoesNotHold => format!(
            "The model does not hold: its error is {as_it_is} of this record's output, compared with {came}{}",
            with_another_gain(check)
        ),
        Verdict::CannotTell if check.quiet => {
            "This record is inconclusive: its output moves by little more than the noise.".to_owned()
        }
        Verdict::CannotTell if check.is_as_at_home => format!(
            "This record is inconclusive: the error is {}, which does not indicate a change, but the output moves so little here that this error is {as_it_is} of the output. Record a larger motion.",
            in_its_unit(check)
        ),
        Verdict::CannotTell if check.is_just_above => format!(
            "The program cannot tell whether the model holds: its error is {as_it_is} of this record's output, compared with {came}; the limit is {}. The model was not exact on its own record, and such a model may have a larger error on another motion. Use a record of the same motion.",
            check.allowed.map_or_else(String::new, share)
        ),
        Verdict::CannotTell => format!(
            "The program cannot tell whether the model holds: its error exceeds the noise and is {as_it_is} of this record's output, compared with {came}."
        ),
        Verdict::DefectiveRecord => format!(
            "The measurement is defective, so the record says nothing about the model: its error is {as_it_is} of the recorded output."
        ),
    };
    if check.verdict == Verdict::DoesNotHold {
        text.push_str(&match &check.otherwise {
            Some(otherwise) => asked(otherwise),
            None => reasons(check),
        });
    }
    if check.verdict == Verdict::Holds {
        text.push_str(&with_reserve(check));
    }
    if check.was_of_one_record {
        text.push_str(
            " The model's own verdict was `not-transferable`: do not use it on another record.",
        );
    }
    text
}

fn is_noise(check: &CheckFacts) -> bool {
    check.rmse <= NOISE * check.record.noise_floor
}

/// The error in the output's unit, next to the model's own error.
fn in_its_unit(check: &CheckFacts) -> String {
    let amount = |rmse: f64| format!("{}{}", number(rmse, Some(0.05 * rmse)), unit(check));
    let own = check.reference_rmse.map_or_else(String::new, amount);
    format!(
        "{}, compared with {own} on the held-out part of its own record",
        amount(check.rmse)
    )
}

/// A remark on a record on which noise causes most of the error.
fn hardly_moves(check: &CheckFacts) -> String {
    match check.rmse > LITTLE * check.deviation {
        true => " The output hardly moves here: record a larger motion.".to_owned(),
        false => String::new(),
    }
}

/// Further remarks on a model that holds: gain and offset, and an input that it hardly depends on.
fn with_reserve(check: &CheckFacts) -> String {
    let share = |rmse: f64| percent(rmse / check.deviation);
    let left = share(check.rmse_gain_offset);
    let gain = check.line.gain_moved();
    let mut text = match check.allowed {
        Some(allowed) if gain || check.line.offset_moved(check.deviation) => format!(
            " However, the {}, within the limit of {}; with this correction the error would be {left}: has the rig changed, or is the motion different?",
            moved(check, !gain),
            share(allowed)
        ),
        _ if check.rmse_gain_offset < BETTER * check.rmse => format!(
            " With a gain of {} and an offset of {}{} the error would be {left}.",
            fitted(&check.line.gain),
            fitted(&check.line.offset),
            unit(check)
        ),
        _ => String::new(),
    };
    let made = check
        .made_of_input
        .filter(|made| *made < HARDLY * check.deviation);
    if let Some(made) = made {
        let _ = write!(
            text,
            " The model hardly depends on `{}`, which contributes only {} of the output of this record. This validation would hardly show a change of that part of the transmission.",
            check.record.input,
            share(made)
        );
    }
    text
}

/// The rest of a sentence about a model that does not hold with another gain and offset either.
fn with_another_gain(check: &CheckFacts) -> String {
    let share = |rmse: f64| percent(rmse / check.deviation);
    let left = share(check.rmse_gain_offset);
    let allowed = check
        .allowed
        .filter(|_| check.is_mended && check.line.gain.value > 0.0);
    let alone = check.rmse_offset <= ALIKE * check.rmse_gain_offset;
    match (allowed, &check.otherwise) {
        (Some(allowed), _) if check.rmse_gain_offset <= JUST * allowed => format!(
            ". The {}: with this correction its error is {left}, just above the limit of {}.",
            moved(check, alone),
            share(allowed)
        ),
        (Some(allowed), _) => format!(
            ". With {} its error is {left}, above the limit of {}.",
            correction(check, alone),
            share(allowed)
        ),
        (None, Some(_)) => ".".to_owned(),
        (None, None) => format!(", and with another gain and offset {left}."),
    }
}

/// Gain and offset, or the offset alone if that is sufficient.
fn correction(check: &CheckFacts, offset_alone: bool) -> String {
    match offset_alone {
        true => format!(
            "an offset of {}{}",
            number(check.mean, Some(0.05 * check.mean.abs())),
            unit(check)
        ),
        false => format!(
            "a gain of {} and an offset of {}{}",
            fitted(&check.line.gain),
            fitted(&check.line.offset),
            unit(check)
        ),
    }
}

/// Without the article.
fn moved(check: &CheckFacts, offset_alone: bool) -> String {
    let Line { gain, offset } = &check.line;
    let amount = |value: f64| number(value, Some(0.05 * value.abs()));
    match offset_alone {
        true => format!(
            "offset has changed by {}{}",
            amount(check.mean),
            unit(check)
        ),
        false => format!(
            "gain has changed by a factor of {} (and the offset by {}{})",
            fitted(gain),
            amount(offset.value),
            unit(check)
        ),
    }
}

/// The question about a changed gain: the gain of an inexact model may also change with the speed
/// or the stroke.
fn another_unit(check: &CheckFacts) -> &'static str {
    let is_far = !check.offset_alone && is_far(check.line.gain.value);
    match (is_far, check.was_inexact && !check.offset_alone) {
        (true, true) => " Is the output in another unit here, or calibrated differently, or is the motion different? The gain of a model that was not exact on its own record may differ at another speed or stroke.",
        (true, false) => " Is the output in another unit here, or calibrated differently?",
        (false, true) => " The model was not exact on its own record: at another speed or stroke the gain of such a model may differ although the rig is the same.",
        (false, false) => "",
    }
}

/// The question about a suspected logging error.
fn asked(one: &Otherwise) -> String {
    let left = percent(one.nrmse);
    match &one.way {
        Way::Turned { column } => format!(
            " With the sign of `{column}` reversed, the error is {left}: does `{column}` have the opposite sign here?"
        ),
        Way::Scaled { column, factor } => format!(
            " With `{column}` divided by {}, the error is {left}: is this column in another unit here{}?",
            number(*factor, Some(0.001 * factor)),
            match (50.0..60.0).contains(factor) {
                true => " (degrees instead of radians)",
                false => "",
            }
        ),
        Way::Exchanged { column, other } => format!(
            " With `{column}` and `{other}` swapped, the error is {left}: are these two columns swapped here?"
        ),
        Way::Late { seconds } => format!(
            " With the output {} ms {}, the error is {left}: is the output delayed here, or logged with another clock?",
            number(1e3 * seconds.abs(), Some(0.02 * 1e3 * seconds.abs())),
            if *seconds > 0.0 { "earlier" } else { "later" }
        ),
    }
}

/// The variables that the residual depends on, and the ranges in which the record exceeds the
/// model's own record.
fn reasons(check: &CheckFacts) -> String {
    let mut text = match check.depends_on.first() {
        Some(first) => {
            let proposal = if first.p.is_none() {
                " (tentative: too few independent stretches for a test)"
            } else {
                ""
            };
            format!(" The residual depends on {}{proposal}.", first.words)
        }
        None => {
            " The residual depends on no measured quantity, as far as this record shows.".to_owned()
        }
    };
    if check.was_inexact {
        text.push_str(" The model was not exact on its own record: on another motion such a model may have this error although the rig is the same.");
    }
    let mut beyond: Vec<String> = Vec::new();
    for one in &check.outside {
        let name = format!("the {} of {}", one.quantity, one.channel);
        beyond.push(name);
    }
    if !beyond.is_empty() {
        let _ = write!(
            text,
            " The record exceeds the model's ranges in {}: there the model extrapolates.",
            beyond.join(", ")
        );
    }
    text
}
