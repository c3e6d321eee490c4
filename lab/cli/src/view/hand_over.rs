//! The model for firmware: its errors in firmware, and whether it can be used as a feed-forward.

use super::layout::{block, Width};
use bowden_lab::facts::{
    three_digits, Calmed, FeedForward, HandOverFacts, LeftOut, Parameter, Segments,
};
use serde::Serialize;
use std::borrow::Cow;

/// The part of the JSON's `final` that is about the model of `--model-out`.
#[derive(Serialize)]
pub(super) struct HandOverPart<'a> {
    /// Errors sample by sample with causal rates; `null` if no model can be exported.
    causal_nrmse: Option<Segments>,
    feed_forward: Cow<'a, FeedForward>,
    exported_model: Option<ExportedModel<'a>>,
}

#[derive(Serialize)]
struct ExportedModel<'a> {
    effects: &'a [String],
    excluded_terms: &'a [LeftOut],
    within_inverse: bool,
    nrmse: Segments,
    #[serde(skip_serializing_if = "Option::is_none")]
    with_deadband: Option<Calmed>,
    rates_time_constant_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    parameters: Option<&'a [Parameter]>,
}

impl<'a> HandOverPart<'a> {
    pub(super) fn new(hand: &'a Result<HandOverFacts, String>) -> Self {
        match hand {
            Ok(hand) => Self {
                causal_nrmse: Some(hand.causal),
                feed_forward: Cow::Borrowed(&hand.feed_forward),
                exported_model: Some(ExportedModel {
                    effects: &hand.effects,
                    excluded_terms: &hand.left_out,
                    within_inverse: hand.within_inverse,
                    nrmse: hand.nrmse,
                    with_deadband: hand.calmed,
                    rates_time_constant_s: hand.time_constant,
                    parameters: hand.model.as_ref().map(|model| &model.parameters[..]),
                }),
            },
            Err(because) => Self {
                causal_nrmse: None,
                feed_forward: Cow::Owned(FeedForward {
                    invertible: false,
                    reason: Some(because.clone()),
                    nearest: None,
                    caution: None,
                }),
                exported_model: None,
            },
        }
    }
}

/// A share in per cent, with at most three digits.
fn per_cent(share: f64) -> String {
    if share > 10.0 {
        return "over 1000 %".to_owned();
    }
    format!("{:.2} %", 100.0 * share)
}

/// The block on the exported model: its error on a controller, and whether it has an inverse.
pub(super) fn text(hand: &Result<HandOverFacts, String>, width: Width) -> String {
    let mut out = String::new();
    let hand = match hand {
        Ok(hand) => hand,
        Err(reason) => {
            block(
                &mut out,
                width,
                "Use it",
                [format!("no model can be exported: {reason}")],
            );
            return out;
        }
    };
    let mut lines = Vec::new();
    if !hand.left_out.is_empty() {
        let names: Vec<String> = hand
            .left_out
            .iter()
            .map(|part| format!("{} ({})", part.effect, part.reason))
            .collect();
        let names = names.join(", ");
        lines.push(match &hand.model {
            // The model above is the exported one.
            Some(_) => format!("exported model: refitted without {names}"),
            None => format!(
                "exported model, refitted without {names}: held-out {}, compared with {} for the model above",
                per_cent(hand.nrmse.held_out),
                per_cent(hand.as_fitted.held_out)
            ),
        });
    }
    lines.push(format!(
        "on a controller: held-out {} (f32, causal derivatives)",
        per_cent(hand.causal.held_out),
    ));
    if let Some(calmed) = &hand.calmed {
        lines.push(format!(
            "with signal::Play of half-width {} on the input: held-out {} (without it, input noise drives the hysteresis)",
            three_digits(calmed.half_width),
            per_cent(calmed.causal_nrmse.held_out),
        ));
    }
    lines.push(format!("as feed-forward: {}", hand.feed_forward.words()));
    // A model without hysteresis has none with --invertible either.
    if hand.effects.iter().any(|part| part == "bouc-wen") {
        lines.extend(
            match (&hand.feed_forward.reason, &hand.feed_forward.nearest) {
                (None, _) => None,
                (Some(_), None) => Some("--invertible: fits a model with an inverse".to_owned()),
                (Some(_), Some(near)) => Some(format!(
                    "--invertible: held-out {} (nearest model: {})",
                    per_cent(near.nrmse.held_out),
                    near.changed
                )),
            },
        );
    }
    block(&mut out, width, "Use it", lines);
    out
}
