//! The model for firmware: its parts, its errors in firmware, and its inverse.

use super::model::{effects, FinalFacts};
use crate::conclude::verdict::percent;
use crate::export::hand_over::{Calmed, HandOver};
use crate::export::invertible::{three_digits, FeedForward};
use crate::export::LeftOut;
use crate::fit::Segments;
use crate::problem::Prepared;
use crate::record::DefectKind;

/// The model of `--model-out`.
#[derive(Debug, Clone)]
pub struct HandOverFacts {
    /// Names of its parts.
    pub effects: Vec<String>,
    /// Parts of the final model that the exported model does not contain.
    pub left_out: Vec<LeftOut>,
    /// Whether a fit within the range that has an inverse was requested.
    pub within_inverse: bool,
    /// Whether that fit ended on the bound of this range.
    pub on_inverse_bound: bool,
    /// The exported model, if this fit differs from the final model.
    pub model: Option<FinalFacts>,
    /// Its errors, as shares of the output's standard deviation.
    pub nrmse: Segments,
    /// The errors of the final model, in the same form.
    pub as_fitted: Segments,
    /// Its errors sample by sample with causal velocity and acceleration estimates, in the same
    /// form.
    pub causal: Segments,
    /// The same errors with a play operator before the hysteresis, if input noise causes the error.
    pub calmed: Option<Calmed>,
    /// Time constant of the causal velocity and acceleration estimates \[s\].
    pub time_constant: f64,
    /// Whether the model can be used as a feed-forward.
    pub feed_forward: FeedForward,
}

/// The remark in the summary on the error in firmware. The fit uses zero-phase velocities and a
/// filtered input, which a microcontroller does not have.
pub(super) fn warning(data: &Prepared, hand: &HandOver) -> Option<String> {
    let errors = format!(
        "the held-out error is {} instead of {}",
        percent(hand.causal.held_out),
        percent(hand.nrmse.held_out)
    );
    let said = || match &hand.calmed {
        Some(calmed) => {
            let unit = data.input.unit.as_ref().map(|unit| format!(" {unit}"));
            format!(
                "In firmware (sample by sample) {errors}, because the noise of `{}` drives the hysteresis. With `signal::Play` of half-width {}{} on the input, the error is {}.",
                data.input.name,
                three_digits(calmed.half_width),
                unit.unwrap_or_default(),
                percent(calmed.causal_nrmse.held_out)
            )
        }
        None => format!(
            "In firmware (sample by sample, with causal velocities{}) {errors}.",
            spikes(data)
        ),
    };
    hand.is_off().then(said)
}

/// The error of a model that `--invertible` has changed, compared with the error of the
/// unconstrained model.
pub(super) fn price(hand: &HandOver) -> Option<String> {
    hand.is_another().then(|| {
        format!(
            "The exported model can be inverted and has a held-out error of {} of the output's standard deviation, compared with {} for the unconstrained model.",
            percent(hand.nrmse.held_out),
            percent(hand.as_fitted.held_out)
        )
    })
}

/// The first sentence of the summary if a constant would have a smaller error than the model in
/// firmware, with causal velocities and an unknown initial hysteresis state.
pub(super) fn useless(hand: &HandOver) -> Option<String> {
    let calmed = hand
        .calmed
        .as_ref()
        .map(|calmed| calmed.causal_nrmse.held_out);
    let error = calmed.unwrap_or(hand.causal.held_out);
    (error > 1.0).then(|| {
        format!(
            "Do not use this model in firmware. Sample by sample, its held-out error is {} of the output's standard deviation, which is larger than the error of a constant.",
            percent(error)
        )
    })
}

/// The columns with spikes. In firmware, no straight line replaces these spikes.
fn spikes(data: &Prepared) -> String {
    let read = std::iter::once(&data.input).chain(&data.channels);
    let spoilt = |name: &str| {
        let mut spikes = data.defects.iter().filter(|d| d.kind == DefectKind::Spike);
        spikes.any(|d| d.channel == name)
    };
    let names: Vec<&str> = read
        .map(|channel| channel.name.as_str())
        .filter(|name| spoilt(name))
        .collect();
    match names.is_empty() {
        true => String::new(),
        false => format!(" and the spikes of {}", names.join(", ")),
    }
}

impl HandOverFacts {
    pub(super) fn new(data: &Prepared, hand: &HandOver) -> Self {
        Self {
            effects: effects(data, &hand.fitted.solution),
            left_out: hand.left_out.clone(),
            within_inverse: hand.within_inverse,
            on_inverse_bound: hand.fitted.solution.structure.invertible,
            model: (hand.is_another()).then(|| FinalFacts::new(data, &hand.fitted)),
            nrmse: hand.nrmse,
            as_fitted: hand.as_fitted,
            causal: hand.causal,
            calmed: hand.calmed,
            time_constant: hand.time_constant,
            feed_forward: hand.feed_forward.clone(),
        }
    }
}
