//! The model for firmware: its parts, its errors there, its inverse.

use super::model::effects;
use crate::conclude::verdict::percent;
use crate::export::hand_over::HandOver;
use crate::export::invertible::FeedForward;
use crate::export::LeftOut;
use crate::fit::Segments;
use crate::problem::Prepared;
use crate::record::DefectKind;

/// The model of `--model-out`.
#[derive(Debug, Clone)]
pub struct HandOverFacts {
    /// Names of its parts.
    pub effects: Vec<String>,
    /// Parts of the final model that are not in it.
    pub left_out: Vec<LeftOut>,
    /// Whether a fit within the range that has an inverse was requested.
    pub within_inverse: bool,
    /// Whether that fit ended on the bound of this range.
    pub on_inverse_bound: bool,
    /// Its errors as shares of the output's standard deviation.
    pub nrmse: Segments,
    /// The errors of the final model, likewise.
    pub as_fitted: Segments,
    /// Its errors sample by sample with causal rates, likewise.
    pub causal: Segments,
    /// Time constant of the causal rates \[s\].
    pub time_constant: f64,
    /// Whether it can serve as a feed-forward.
    pub feed_forward: FeedForward,
}

/// Least error in firmware that the sentence mentions, as a share of the output's standard
/// deviation ...
const NOTABLE: f64 = 0.05;
/// ... and its least multiple of the error of the fit. Both are a choice: of the ten measured rows
/// three get the warning, the positioning drive, whose force is mostly inertia, and a cable tool.
const OFF: f64 = 2.0;

/// What somebody must know of a model in firmware who reads nothing but the verdict: the fit has
/// velocities without phase, a chip has not.
pub(super) fn warning(data: &Prepared, hand: &HandOver) -> Option<String> {
    let (fit, firmware) = (hand.nrmse.held_out, hand.causal.held_out);
    (firmware > NOTABLE && firmware > OFF * fit).then(|| {
        format!(
            "In firmware, sample by sample with causal velocities{}, the held-out error is {} instead of {}.",
            spikes(data),
            percent(firmware),
            percent(fit)
        )
    })
}

/// The columns whose spikes reach a model in firmware: no line stands in for them there.
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
            effects: effects(data, &hand.solution),
            left_out: hand.left_out.clone(),
            within_inverse: hand.within_inverse,
            on_inverse_bound: hand.solution.structure.invertible,
            nrmse: hand.nrmse,
            as_fitted: hand.as_fitted,
            causal: hand.causal,
            time_constant: hand.time_constant,
            feed_forward: hand.feed_forward.clone(),
        }
    }
}
