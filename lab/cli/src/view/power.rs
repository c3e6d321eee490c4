//! The table of `bowden power`, for people and as JSON, schema `bowden.power/1`.

use super::words::{in_brackets, table};
use bowden_lab::facts::{number, Answer, PowerFacts, PowerRow, RecordFacts, SHARE};
use serde::Serialize;
use std::fmt::Write as _;

/// The method, in one sentence.
const SIMULATED: &str = "each effect at the middle one of its trial shapes, added to the last model's prediction and its residual under circular shifts and changes of sign; every trial closed as a whole: the search with its refits and tests; found: its family named or among the rivals";

#[derive(Serialize)]
struct Whole<'a> {
    schema: &'static str,
    path: &'a str,
    model: &'a [String],
    simulated: &'static str,
    trials: usize,
    share: f64,
    named_without: usize,
    unit: Option<&'a str>,
    noise_floor: f64,
    effects: Vec<Part<'a>>,
}

#[derive(Serialize)]
struct Part<'a> {
    family: &'static str,
    effect: &'static str,
    channel: &'a str,
    shapes: Vec<Value<'a>>,
    status: &'static str,
    amplitude: Option<f64>,
    noise_floors: Option<f64>,
    gain: Option<Value<'a>>,
    found: Option<usize>,
    screened: Option<f64>,
    tried: Option<f64>,
}

#[derive(Serialize)]
struct Value<'a> {
    name: &'a str,
    value: f64,
    unit: Option<&'a str>,
}

fn part<'a>(record: &RecordFacts, row: &'a PowerRow) -> Part<'a> {
    let shapes = row.shapes.iter().map(|shape| Value {
        name: shape.name,
        value: shape.value,
        unit: shape.unit.as_deref(),
    });
    let empty = Part {
        family: row.family,
        effect: row.effect,
        channel: &row.channel,
        shapes: shapes.collect(),
        status: "",
        amplitude: None,
        noise_floors: None,
        gain: None,
        found: None,
        screened: None,
        tried: None,
    };
    match row.answer {
        Answer::Found {
            amplitude,
            gain,
            times,
            screened,
        } => Part {
            status: "found",
            amplitude: Some(amplitude),
            noise_floors: record.floors(amplitude),
            gain: Some(Value {
                name: &row.name,
                value: gain,
                unit: row.gain_unit.as_deref(),
            }),
            found: Some(times),
            screened: Some(screened),
            ..empty
        },
        Answer::NotFound { tried } => Part {
            status: "not-found",
            tried: Some(tried),
            ..empty
        },
        Answer::NotExcited => Part {
            status: "not-excited",
            ..empty
        },
        Answer::InModel => Part {
            status: "in-model",
            ..empty
        },
    }
}

/// The table as one line of JSON.
///
/// # Errors
/// If a number is not finite, which no row has.
pub fn power_json(power: &PowerFacts) -> Result<String, serde_json::Error> {
    let record = &power.record;
    serde_json::to_string(&Whole {
        schema: "bowden.power/1",
        path: &power.label,
        model: &power.model,
        simulated: SIMULATED,
        trials: power.trials,
        share: SHARE,
        named_without: power.named_without,
        unit: record.unit.as_deref(),
        noise_floor: record.noise_floor,
        effects: power.rows.iter().map(|row| part(record, row)).collect(),
    })
}

/// The table as text.
#[must_use]
pub fn power_text(power: &PowerFacts) -> String {
    let rms = format!("rms{}", in_brackets(power.record.unit.as_deref()));
    let header = [
        "family", "effect", &rms, "× floor", "gain", "found", "remark",
    ];
    let mut rows = table(&header, 2..4);
    for row in &power.rows {
        let part = part(&power.record, row);
        let short =
            |v: Option<f64>| v.map_or_else(|| "–".to_owned(), |v| number(v, Some(0.05 * v)));
        let gain = part.gain.as_ref().map_or_else(
            || "–".to_owned(),
            |g| {
                let unit = match g.unit {
                    Some("1") => "",
                    Some(unit) => unit,
                    None => "(no unit in the record)",
                };
                format!("{} {unit}", number(g.value, Some(0.05 * g.value)))
                    .trim_end()
                    .to_owned()
            },
        );
        let remark = match row.answer {
            Answer::Found { .. } => String::new(),
            Answer::NotFound { tried } => {
                format!("not found up to {}", number(tried, Some(0.05 * tried)))
            }
            Answer::NotExcited => "not excited by this motion".to_owned(),
            Answer::InModel => "in the model already".to_owned(),
        };
        rows.add_row([
            part.family.to_owned(),
            row.name.clone(),
            short(part.amplitude),
            short(part.noise_floors),
            gain,
            part.found
                .map_or_else(|| "–".to_owned(), |n| format!("{n} of {}", power.trials)),
            remark,
        ]);
    }
    let mut out = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(out, "bowden power  {}", power.label);
    let _ = writeln!(out, "model     {}", power.model.join(", "));
    let _ = writeln!(
        out,
        "planted   {SIMULATED}; {} trials of each amplitude",
        power.trials
    );
    let _ = writeln!(
        out,
        "\nThe smallest effect that is found in {:.0} % of the trials, by the rms of what it adds to the output:",
        100.0 * SHARE
    );
    let _ = writeln!(out, "{rows}\n");
    let _ = writeln!(
        out,
        "without   with nothing planted, {} of {} trials name an effect",
        power.named_without, power.trials
    );
    out
}
