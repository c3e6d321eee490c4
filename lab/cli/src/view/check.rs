//! `bowden check` for programs, schema `bowden.check/1`, and for people.

use super::several::size;
use super::words::table;
use anstyle::{AnsiColor, Style};
use bowden_lab::facts::{
    number, share as percent, with_interval, CheckFacts, CheckVerdict as Verdict, Defect, Errors,
    Fitted, Line, Otherwise, Outside,
};
use serde::Serialize;
use std::fmt::Write as _;

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
    depends_on: Vec<DependsOn<'a>>,
    otherwise: Option<&'a Otherwise>,
    defects: &'a [Defect],
    notes: &'a [String],
    verdict: &'static str,
    sentence: &'a str,
}

#[derive(Serialize)]
struct RecordPart<'a> {
    path: &'a str,
    samples: usize,
    rate_hz: f64,
    mode: &'static str,
    cutoff_hz: f64,
    /// Seconds at the start that are excluded.
    left_out_s: f64,
    unit: Option<&'a str>,
    /// Standard deviation of the filtered output on the rest.
    deviation: f64,
}

/// What the model file states about its own record.
#[derive(Serialize)]
struct From {
    nrmse: Option<Errors>,
    held_out_rmse: Option<f64>,
    cutoff_hz: Option<f64>,
    rate_hz: Option<f64>,
}

#[derive(Serialize)]
struct DependsOn<'a> {
    variable: &'static str,
    channel: &'a str,
    share: f64,
    p: Option<f64>,
}

/// The check as one line of JSON.
///
/// # Errors
/// If a number cannot be written, which no check has.
pub fn check_json(
    model: &str,
    path: &str,
    check: &CheckFacts,
) -> Result<String, serde_json::Error> {
    let record = &check.record;
    let share = |rmse: f64| rmse / check.deviation;
    let depends_on = check.depends_on.iter().map(|one| DependsOn {
        variable: one.variable,
        channel: &one.channel,
        share: one.share,
        p: one.p,
    });
    serde_json::to_string(&Report {
        schema: "bowden.check/1",
        model,
        record: RecordPart {
            path,
            samples: record.samples,
            rate_hz: record.rate,
            mode: record.mode.name(),
            cutoff_hz: record.cutoff,
            left_out_s: check.left_out,
            unit: record.unit.as_deref(),
            deviation: check.deviation,
        },
        rmse: check.rmse,
        nrmse: share(check.rmse),
        rmse_gain_offset: check.rmse_gain_offset,
        nrmse_gain_offset: share(check.rmse_gain_offset),
        gain: check.line.gain,
        offset: check.line.offset,
        from: From {
            nrmse: check.came_with,
            held_out_rmse: check.reference_rmse,
            cutoff_hz: check.own_cutoff,
            rate_hz: check.own_rate,
        },
        allowed: check.allowed.map(share),
        noise_floor: record.noise_floor,
        outside: &check.outside,
        depends_on: depends_on.collect(),
        otherwise: check.otherwise.as_ref(),
        defects: &record.defects,
        notes: &record.notes,
        verdict: check.verdict.name(),
        sentence: &check.sentence,
    })
}

fn fitted(one: &Fitted) -> String {
    with_interval(one.value, one.ci95)
}

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident, $($text:tt)+) => {
        let _ = writeln!($out, $($text)+);
    };
}

/// The check for people, with ANSI styles that the caller may strip. Its last line can be quoted
/// alone.
#[must_use]
pub fn check_text(model: &str, path: &str, check: &CheckFacts) -> String {
    let (bold, dim) = (Style::new().bold(), Style::new().dimmed());
    let record = &check.record;
    let mut out = String::new();
    line!(out, "{bold}bowden check{bold:#}  {model} on {path}");
    line!(
        out,
        "read      {}; {} mode: {} → {}",
        size(record),
        record.mode.name(),
        record.input,
        record.output
    );
    let start = match check.left_out > 0.0 {
        true => format!(
            "; the first {:.1} s do not count: what came before them is unknown",
            check.left_out
        ),
        false => String::new(),
    };
    line!(out, "filtered  zero-phase at {} Hz{start}", record.cutoff);
    for note in &record.notes {
        line!(out, "{dim}note      {note}{dim:#}");
    }
    for defect in &record.defects {
        line!(out, "defect    {}: {}", defect.channel, defect.message);
    }
    line!(out, "\n{}\n", errors(check));
    if let Some(allowed) = check.allowed {
        line!(
            out,
            "{dim}holds up to {}: {}{dim:#}",
            percent(allowed / check.deviation),
            check.rule()
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
            one.words,
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
        check.sentence
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

fn errors(check: &CheckFacts) -> comfy_table::Table {
    let record = &check.record;
    let unit = record.unit.as_deref().unwrap_or_default();
    let heading = match unit {
        "" => "RMSE".to_owned(),
        unit => format!("RMSE [{unit}]"),
    };
    let mut rows = table(
        &["", &heading, "of the output's deviation", "× floor"],
        1..4,
    );
    let open = || "–".to_owned();
    let mut add = |name: String, rmse: f64| {
        let times = record.floors(rmse);
        let times = times.map_or_else(open, |times| format!("{times:.1}"));
        let digits = number(rmse, Some(0.05 * rmse));
        rows.add_row([name, digits, percent(rmse / check.deviation), times]);
    };
    add("as it is".to_owned(), check.rmse);
    let Line { gain, offset } = &check.line;
    let fit = format!("gain {}, offset {} {unit}", fitted(gain), fitted(offset));
    add(format!("with {}", fit.trim_end()), check.rmse_gain_offset);
    let own = check
        .reference
        .map_or_else(|| "unknown".to_owned(), percent);
    let rmse = check
        .reference_rmse
        .map_or_else(open, |rmse| number(rmse, Some(0.05 * rmse)));
    rows.add_row(["held out of its own record".to_owned(), rmse, own, open()]);
    rows
}
