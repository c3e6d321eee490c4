//! `bowden check` for programs, schema `bowden.check/1`, and for people.

use super::several::size;
use super::words::{number, table};
use crate::check::{Check, Errors, Fitted, Line, Outside, Verdict};
use crate::record::{Defect, Mode};
use anstyle::{AnsiColor, Style};
use serde::Serialize;
use std::fmt::Write as _;

/// Gain and offset are mentioned beside a model that holds where they leave less than this
/// share of its error.
const BETTER: f64 = 0.8;

#[derive(Serialize)]
struct Report<'a> {
    schema: &'static str,
    model: &'a str,
    record: RecordPart<'a>,
    rmse: f64,
    nrmse: f64,
    rmse_gain_offset: f64,
    nrmse_gain_offset: f64,
    gain: Fitted,
    offset: Fitted,
    from: From,
    allowed: Option<f64>,
    noise_floor: f64,
    outside: &'a [Outside],
    depends_on: Vec<DependsOn>,
    defects: &'a [Defect],
    notes: &'a [String],
    verdict: &'static str,
    sentence: String,
}

#[derive(Serialize)]
struct RecordPart<'a> {
    path: &'a str,
    samples: usize,
    rate_hz: f64,
    mode: &'static str,
    cutoff_hz: f64,
    /// Seconds at the start that do not count.
    left_out_s: f64,
    unit: Option<&'a str>,
    /// Standard deviation of the filtered output on what counts.
    deviation: f64,
}

/// What the model's file says of the record that it came from.
#[derive(Serialize)]
struct From {
    nrmse: Option<Errors>,
    cutoff_hz: Option<f64>,
    rate_hz: Option<f64>,
}

#[derive(Serialize)]
struct DependsOn {
    variable: &'static str,
    channel: String,
    share: f64,
    p: Option<f64>,
}

fn mode(check: &Check) -> &'static str {
    match check.data.mode {
        Mode::Torque => "torque",
        Mode::Displacement => "displacement",
    }
}

/// The check as one line of JSON.
///
/// # Errors
/// Where a number cannot be written, which no check has.
pub fn check_json(model: &str, path: &str, check: &Check) -> Result<String, serde_json::Error> {
    let data = &check.data;
    let share = |rmse: f64| rmse / check.deviation;
    let depends_on = check.depends_on.iter().map(|one| DependsOn {
        variable: one.variable.name(data),
        channel: data
            .channel(one.variable.source())
            .map_or_else(String::new, |c| c.name.clone()),
        share: one.share,
        p: one.p,
    });
    serde_json::to_string(&Report {
        schema: "bowden.check/1",
        model,
        record: RecordPart {
            path,
            samples: data.samples,
            rate_hz: data.rate,
            mode: mode(check),
            cutoff_hz: data.cutoff,
            left_out_s: check.left_out,
            unit: data.output_unit.as_deref(),
            deviation: check.deviation,
        },
        rmse: check.rmse,
        nrmse: share(check.rmse),
        rmse_gain_offset: check.rmse_gain_offset,
        nrmse_gain_offset: share(check.rmse_gain_offset),
        gain: check.line.gain,
        offset: check.line.offset,
        from: From {
            nrmse: check.about.nrmse,
            cutoff_hz: check.about.cutoff_hz,
            rate_hz: check.about.rate_hz,
        },
        allowed: check.allowed.map(share),
        noise_floor: data.noise_floor,
        outside: &check.outside,
        depends_on: depends_on.collect(),
        defects: &data.defects,
        notes: &data.notes,
        verdict: check.verdict.name(),
        sentence: sentence(check),
    })
}

/// "1.10 ± 0.01".
fn fitted(one: &Fitted) -> String {
    match one.ci95 {
        Some([low, high]) => {
            let half = 0.5 * (high - low);
            format!(
                "{} ± {}",
                number(one.value, Some(half)),
                number(half, Some(half))
            )
        }
        None => number(one.value, None),
    }
}

/// "1.32 %" of the output's standard deviation.
fn percent(share: f64) -> String {
    format!("{} %", number(100.0 * share, Some(5.0 * share)))
}

fn unit(check: &Check) -> String {
    let unit = check.data.output_unit.as_deref();
    unit.map_or_else(String::new, |unit| format!(" {unit}"))
}

/// The check in one or two sentences.
#[must_use]
pub fn sentence(check: &Check) -> String {
    let share = |rmse: f64| percent(rmse / check.deviation);
    let as_it_is = share(check.rmse);
    let came = check.reference().map_or_else(
        || "its file does not say how much it missed where it came from".to_owned(),
        |own| format!("{} on what was held out of its own record", percent(own)),
    );
    let mut text = match check.verdict {
        Verdict::Holds if check.reference().is_some() => format!(
            "The model holds: it misses {as_it_is} of this record's output, as against {came}; nothing was refitted."
        ),
        Verdict::Holds => format!(
            "The model holds: the {as_it_is} of this record's output that it misses are the sensor's noise; nothing was refitted."
        ),
        Verdict::GainOrOffsetMoved => format!(
            "{}: the model as it is misses {as_it_is} of this record's output, with that corrected {}, as against {came}.",
            moved(check),
            share(corrected(check))
        ),
        Verdict::DoesNotHold => format!(
            "The model does not hold: it misses {as_it_is} of this record's output, as against {came}, and another gain and offset leave {}.",
            share(check.rmse_gain_offset)
        ),
        Verdict::CannotTell if check.is_quiet() => {
            "This record cannot tell: its output moves by little more than the noise.".to_owned()
        }
        Verdict::CannotTell => format!(
            "Whether the model holds cannot be told: it misses {as_it_is} of this record's output, which is more than noise, and {came}."
        ),
        Verdict::DataDefect => format!(
            "The measurement itself is spoilt, so nothing can be said of the model: it misses {as_it_is} of what was recorded."
        ),
    };
    if check.verdict == Verdict::DoesNotHold {
        text.push_str(&reasons(check));
    }
    if check.verdict == Verdict::Holds && check.rmse_gain_offset < BETTER * check.rmse {
        let _ = write!(
            text,
            " A gain of {} and an offset of {}{} would leave {}.",
            fitted(&check.line.gain),
            fitted(&check.line.offset),
            unit(check),
            share(check.rmse_gain_offset)
        );
    }
    text
}

/// Rms error with the offset alone corrected, where that is what has moved.
fn corrected(check: &Check) -> f64 {
    match check.offset_alone() {
        true => (check.rmse.powi(2) - check.mean.powi(2)).max(0.0).sqrt(),
        false => check.rmse_gain_offset,
    }
}

fn moved(check: &Check) -> String {
    let Line { gain, offset } = &check.line;
    let amount = |value: f64| number(value, Some(0.05 * value.abs()));
    match check.offset_alone() {
        true => format!(
            "The offset has moved by {}{}, and no more than that shows",
            amount(check.mean),
            unit(check)
        ),
        false => format!(
            "The gain has moved to {} times what it was (and the offset by {}{}), and no more than that shows",
            fitted(gain),
            amount(offset.value),
            unit(check)
        ),
    }
}

/// What the residual depends on, and where the record goes beyond what the model has seen.
fn reasons(check: &Check) -> String {
    let data = &check.data;
    let mut text = match check.depends_on.first() {
        Some(first) => {
            let proposal = if first.p.is_none() {
                " (a proposal: too few independent stretches for a test)"
            } else {
                ""
            };
            format!(
                " What it misses depends on {}{proposal}.",
                first.variable.words(data)
            )
        }
        None => {
            " What it misses depends on nothing that was measured, as far as this record shows."
                .to_owned()
        }
    };
    let mut beyond: Vec<String> = Vec::new();
    for one in &check.outside {
        let name = format!("the {} of {}", one.quantity, one.channel);
        beyond.push(name);
    }
    if !beyond.is_empty() {
        let _ = write!(
            text,
            " The record goes beyond what the model has seen in {}: there the model is a guess.",
            beyond.join(", ")
        );
    }
    text
}

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident, $($text:tt)+) => {
        let _ = writeln!($out, $($text)+);
    };
}

/// The check for people, with ANSI styles that whoever prints it may strip. Its last line
/// stands for itself.
#[must_use]
pub fn check_text(model: &str, path: &str, check: &Check) -> String {
    let (bold, dim) = (Style::new().bold(), Style::new().dimmed());
    let data = &check.data;
    let mut out = String::new();
    line!(out, "{bold}bowden check{bold:#}  {model} on {path}");
    line!(
        out,
        "read      {}; {} mode: {} → {}",
        size(data),
        mode(check),
        data.input.name,
        data.output_name
    );
    let start = match check.left_out > 0.0 {
        true => format!(
            "; the first {:.1} s do not count: what came before them is unknown",
            check.left_out
        ),
        false => String::new(),
    };
    line!(out, "filtered  zero-phase at {} Hz{start}", data.cutoff);
    for note in &data.notes {
        line!(out, "{dim}note      {note}{dim:#}");
    }
    for defect in &data.defects {
        line!(out, "defect    {}: {}", defect.channel, defect.message);
    }
    line!(out, "\n{}\n", errors(check));
    if let Some(allowed) = check.allowed {
        line!(
            out,
            "{dim}holds up to {}: {} times the held-out error that the model came with, or {} times the noise floor{dim:#}",
            percent(allowed / check.deviation),
            crate::check::HOLDS,
            crate::check::NOISE
        );
    }
    for one in &check.outside {
        line!(out, "outside   {}", beyond(one));
    }
    for one in &check.depends_on {
        let tested = one.p.map_or_else(
            || "not tested: correlated for too long".to_owned(),
            |p| format!("p {p:.1e}"),
        );
        line!(
            out,
            "depends   on {}: a curve of it takes {:.0} % of the squared error ({tested})",
            one.variable.words(data),
            100.0 * one.share
        );
    }
    let colour = match check.verdict {
        Verdict::Holds => AnsiColor::Green,
        Verdict::GainOrOffsetMoved | Verdict::CannotTell => AnsiColor::Yellow,
        Verdict::DoesNotHold | Verdict::DataDefect => AnsiColor::Red,
    };
    let style = Style::new().bold().fg_color(Some(colour.into()));
    line!(
        out,
        "verdict   {style}{}{style:#}. {}",
        check.verdict.name(),
        sentence(check)
    );
    out
}

/// "x: velocity −30 to 30 mm/s, the model has seen −10 to 10 (12 % of the samples lie outside)".
fn beyond(one: &Outside) -> String {
    let pair = |[low, high]: [f64; 2]| {
        let digits = Some(0.01 * (high - low).abs());
        format!("{} to {}", number(low, digits), number(high, digits))
    };
    let unit = one.unit.as_deref();
    format!(
        "{}: {} {}{}, the model has seen {} ({:.0} % of the samples lie outside)",
        one.channel,
        one.quantity,
        pair(one.here),
        unit.map_or_else(String::new, |u| format!(" {u}")),
        pair(one.seen),
        100.0 * one.share
    )
}

fn errors(check: &Check) -> comfy_table::Table {
    let floor = check.data.noise_floor;
    let unit = unit(check);
    let unit = unit.trim();
    let heading = match unit {
        "" => "RMSE".to_owned(),
        unit => format!("RMSE [{unit}]"),
    };
    let mut rows = table(
        &["", &heading, "of the output's deviation", "× floor"],
        1..4,
    );
    let mut add = |name: String, rmse: f64| {
        let times = match floor > 0.0 {
            true => format!("{:.1}", rmse / floor),
            false => "–".to_owned(),
        };
        let digits = number(rmse, Some(0.05 * rmse));
        rows.add_row([name, digits, percent(rmse / check.deviation), times]);
    };
    add("as it is".to_owned(), check.rmse);
    let Line { gain, offset } = &check.line;
    let fit = format!("gain {}, offset {} {unit}", fitted(gain), fitted(offset));
    add(format!("with {}", fit.trim_end()), check.rmse_gain_offset);
    let own = check
        .reference()
        .map_or_else(|| "unknown".to_owned(), percent);
    let open = || "–".to_owned();
    rows.add_row(["held out of its own record".to_owned(), open(), own, open()]);
    rows
}
