//! The table of `bowden power`, as text and as JSON, schema `bowden.power/1`.

use super::layout::{block, heading, prose, Columns, Width, NONE};
use super::words::in_brackets;
use anstyle::AnsiColor;
use bowden_lab::facts::{number, Answer, PowerFacts, PowerRow, RecordFacts, SHARE};
use serde::Serialize;
use std::cmp::Ordering;

/// The method, in one sentence.
const SIMULATED: &str = "Each trial record is the sum of the identified model's prediction, its residual (shifted circularly, and negated in every other trial) and one effect with its middle trial shape. Each trial is a complete identification with search, refits and tests. An effect counts as found if a term or an alternative belongs to its family.";

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
/// If a number is not finite, which does not occur in a row.
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

/// Maximum number of rows without `--verbose`.
const LISTED: usize = 10;

/// Whether an amplitude was tried.
fn amplitude(row: &PowerRow) -> Option<f64> {
    match row.answer {
        Answer::Found { amplitude, .. } => Some(amplitude),
        Answer::NotFound { tried } => Some(tried),
        Answer::NotExcited | Answer::InModel => None,
    }
}

/// The text: the effects that the search finds, and the smallest amplitude of each.
#[must_use]
pub fn power_text(power: &PowerFacts, width: Width, verbose: bool) -> String {
    let mut out = String::new();
    answer(&mut out, power, width);
    let mut rows: Vec<&PowerRow> = power.rows.iter().collect();
    rows.retain(|row| amplitude(row).is_some());
    let mut more = 0;
    if !verbose {
        // The effects that are hardest to find.
        rows.sort_by(|a, b| {
            amplitude(b)
                .partial_cmp(&amplitude(a))
                .unwrap_or(Ordering::Equal)
        });
        more = rows.len().saturating_sub(LISTED);
        rows.truncate(LISTED);
    }
    if !rows.is_empty() {
        out += &table(power, &rows).text(width);
        if more > 0 {
            prose(
                &mut out,
                width,
                &format!("-v lists {more} more effects with smaller amplitudes"),
            );
        }
        out.push('\n');
    }
    block(&mut out, width, "Model", [power.model.join(", ")]);
    let (named, trials) = (power.named_without, power.trials);
    let mut notes = vec![format!(
        "without an added effect, the search finds one in {named} of {trials} trials"
    )];
    if verbose {
        notes.push(format!("Simulation: {SIMULATED}"));
    }
    block(&mut out, width, "Note", notes);
    let next = "--effects NAME,… · --trials K · bowden plan RECORD";
    let next = match verbose {
        true => next.to_owned(),
        false => format!("-v · {next}"),
    };
    block(&mut out, width, "Next", [next]);
    out
}

/// How many effects are found, and which are not.
fn answer(out: &mut String, power: &PowerFacts, width: Width) {
    let names = |is: fn(&Answer) -> bool| {
        let rows = power.rows.iter().filter(|row| is(&row.answer));
        rows.map(|row| row.name.as_str()).collect::<Vec<&str>>()
    };
    let found = names(|answer| matches!(answer, Answer::Found { .. })).len();
    let in_model = names(|answer| matches!(answer, Answer::InModel));
    let tested = power.rows.len() - in_model.len();
    let colour = if found == tested {
        AnsiColor::Green
    } else {
        AnsiColor::Yellow
    };
    let headline = format!("{found} OF {tested} EFFECTS WOULD BE FOUND");
    heading(
        out,
        width,
        ("bowden power", &power.label),
        (colour, &headline),
    );
    let words = format!(
        "For each effect, the table lists the smallest amplitude at which the search found the effect in at least {:.0} % of {} trials.",
        100.0 * SHARE,
        power.trials
    );
    prose(out, width, &words);
    for (what, names) in [
        (
            "Not excited by this motion",
            names(|answer| matches!(answer, Answer::NotExcited)),
        ),
        (
            "Not found",
            names(|answer| matches!(answer, Answer::NotFound { .. })),
        ),
        ("Already in the model", in_model),
    ] {
        if !names.is_empty() {
            prose(out, width, &format!("{what}: {}.", names.join(", ")));
        }
    }
    out.push('\n');
}

fn table(power: &PowerFacts, rows: &[&PowerRow]) -> Columns {
    let rms = format!("rms{}", in_brackets(power.record.unit.as_deref()));
    let header = ["Effect", "family", &rms, "vs noise", "gain", "found"];
    let mut out = Columns::new(&header, &[1, 5, 3, 4]);
    for row in rows {
        let part = part(&power.record, row);
        let digits = |value: f64| number(value, Some(0.05 * value));
        let or_none = |cell: Option<String>| cell.unwrap_or_else(|| NONE.to_owned());
        let gain = part.gain.as_ref().map(|gain| {
            let unit = match gain.unit {
                Some("1") => "",
                Some(unit) => unit,
                None => "(no unit in the record)",
            };
            format!("{} {unit}", digits(gain.value))
                .trim_end()
                .to_owned()
        });
        let tried = part.tried.map(|tried| format!("> {}", digits(tried)));
        let found = part.found;
        out.add([
            format!("  {}", row.name),
            part.family.to_owned(),
            or_none(part.amplitude.map(digits).or(tried)),
            or_none(part.noise_floors.map(|times| format!("{times:.1} ×"))),
            or_none(gain),
            or_none(found.map(|found| format!("{found} of {}", power.trials))),
        ]);
    }
    out
}
