//! Rows that the two forms of `bowden compare` share.

use bowden_trials::facts::{Heading, Line, Spread};
use serde_json::{json, Value};

pub(super) fn configuration(heading: &Heading) -> &'static str {
    if heading.varying {
        "varying"
    } else {
        "fixed"
    }
}

/// "6 trials of 60 s".
pub(super) fn trials(heading: &Heading) -> String {
    let plural = if heading.seeds == 1 { "" } else { "s" };
    format!("{} trial{plural} of {} s", heading.seeds, heading.seconds)
}

pub(super) fn conditions(heading: &Heading) -> Value {
    json!({
        "noise": heading.noise,
        "configuration": configuration(heading),
        "seconds": heading.seconds,
        "from": heading.from,
        "transient": heading.transient,
        "seeds": heading.seeds,
        "fed_with": heading.fed_with,
        "model": heading.model,
        "gains": heading.gains,
        "setup": heading.setup,
        "drive_gain": heading.drive_gain,
        "rig": heading.rig,
        "task": if heading.gait { "gait" } else { "paper" },
        "reference": heading.reference,
        "lag_error": heading.lag_error,
    })
}

pub(super) fn row(line: &Line) -> Value {
    // The sums of a law that ran away cover a part of the trial only: no number is comparable.
    let told = line.diverged == 0;
    let number = |value: f64| told.then_some(value);
    let spread = |spread: Spread| json!({ "mean": number(spread.mean), "sd": number(spread.sd) });
    json!({
        "controller": line.controller,
        "rmse_true": spread(line.rmse_true),
        "rmse_measured": spread(line.rmse_measured),
        "percent_of_maximum": number(100.0 * line.share),
        "peak": number(line.peak),
        "effort": number(line.effort),
        "reversals": number(line.reversals),
        "transient": { "rmse_true": spread(line.transient), "peak": number(line.transient_peak) },
        "largest_command": line.command,
        "at_limit": told.then_some(line.at_limit),
        "diverged": line.diverged,
        "ran_away_at": line.ran_away,
        "certificate": Value::Null,
    })
}
