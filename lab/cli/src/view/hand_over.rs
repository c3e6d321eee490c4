//! The model for firmware: its errors there, and whether it is a feed-forward.

use bowden_lab::facts::{three_digits, Calmed, FeedForward, HandOverFacts, LeftOut, Segments};
use serde::Serialize;
use std::borrow::Cow;
use std::fmt::Write as _;

/// The part of the JSON's `final` that is about the model of `--model-out`.
#[derive(Serialize)]
pub(super) struct HandOverPart<'a> {
    /// Errors sample by sample with causal rates; `null` if nothing can be handed over.
    causal_nrmse: Option<Segments>,
    feed_forward: Cow<'a, FeedForward>,
    handed_over: Option<HandedOver<'a>>,
}

#[derive(Serialize)]
struct HandedOver<'a> {
    effects: &'a [String],
    left_out: &'a [LeftOut],
    within_inverse: bool,
    nrmse: Segments,
    #[serde(skip_serializing_if = "Option::is_none")]
    calmed: Option<Calmed>,
    rates_time_constant_s: f64,
}

impl<'a> HandOverPart<'a> {
    pub(super) fn new(hand: &'a Result<HandOverFacts, String>) -> Self {
        match hand {
            Ok(hand) => Self {
                causal_nrmse: Some(hand.causal),
                feed_forward: Cow::Borrowed(&hand.feed_forward),
                handed_over: Some(HandedOver {
                    effects: &hand.effects,
                    left_out: &hand.left_out,
                    within_inverse: hand.within_inverse,
                    nrmse: hand.nrmse,
                    calmed: hand.calmed,
                    rates_time_constant_s: hand.time_constant,
                }),
            },
            Err(because) => Self {
                causal_nrmse: None,
                feed_forward: Cow::Owned(FeedForward {
                    invertible: false,
                    because: Some(because.clone()),
                    nearest: None,
                    caution: None,
                }),
                handed_over: None,
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

/// The lines of the ledger.
pub(super) fn text(hand: &Result<HandOverFacts, String>) -> String {
    let hand = match hand {
        Ok(hand) => hand,
        Err(because) => return format!("firmware  nothing is handed over: {because}\n"),
    };
    let mut out = String::new();
    let mut line = |text: String| {
        let _ = writeln!(out, "firmware  {text}");
    };
    if !hand.left_out.is_empty() || hand.on_inverse_bound {
        let names: Vec<String> = hand
            .left_out
            .iter()
            .map(|part| format!("{} ({})", part.effect, part.because))
            .collect();
        let without = match names.is_empty() {
            true => "the model fitted within what can be inverted".to_owned(),
            false => format!("the model without {}, fitted again", names.join(", ")),
        };
        line(format!(
            "held out {} with {without}; {} with the final model",
            per_cent(hand.nrmse.held_out),
            per_cent(hand.as_fitted.held_out)
        ));
    }
    line(format!(
        "held out {} sample by sample as firmware runs it (input as recorded, causal velocities by Rates, {} ms), {} with the fit's smoothed signals",
        per_cent(hand.causal.held_out),
        three_digits(1e3 * hand.time_constant),
        per_cent(hand.nrmse.held_out)
    ));
    if let Some(calmed) = &hand.calmed {
        line(format!(
            "held out {} with the input behind signal::Play of half-width {}: its noise turns the hysteresis",
            per_cent(calmed.causal_nrmse.held_out),
            three_digits(calmed.half_width)
        ));
    }
    let mend = match (&hand.feed_forward.because, &hand.feed_forward.nearest) {
        (None, _) => String::new(),
        // A model that was left without a hysteresis has none with --invertible either.
        _ if !hand.effects.iter().any(|part| part == "bouc-wen") => String::new(),
        (Some(_), None) => "; --invertible fits one that can be inverted".to_owned(),
        (Some(_), Some(near)) => format!(
            "; --invertible fits one that can be inverted, the nearest one ({}) has {} held out",
            near.changed,
            per_cent(near.nrmse.held_out)
        ),
    };
    line(format!("feed-forward: {}{mend}", hand.feed_forward.words()));
    out
}
