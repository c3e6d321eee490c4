//! `bowden validate` as JSON, schema `bowden.validate/1`, and as text.

use super::layout::{block, heading, prose, Columns, Width};
use super::several::size;
use super::words::in_brackets;
use anstyle::AnsiColor;
use bowden_lab::facts::{
    number, share as percent, with_interval, CheckFacts, CheckVerdict as Verdict, Defect, Errors,
    Fitted, Line, Outside, Told,
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
    trained_on: TrainedOn,
    threshold_nrmse: Option<f64>,
    noise_floor: f64,
    outside: &'a [Outside],
    depends_on: Vec<DependsOn<'a>>,
    defects: &'a [Defect],
    notes: &'a [String],
    verdict: &'static str,
    findings: &'a [Told],
    summary: &'a str,
}

#[derive(Serialize)]
struct RecordPart<'a> {
    path: &'a str,
    samples: usize,
    rate_hz: f64,
    mode: &'static str,
    cutoff_hz: f64,
    /// Seconds at the start that are excluded.
    excluded_s: f64,
    unit: Option<&'a str>,
    /// Standard deviation of the filtered output on the rest.
    output_std: f64,
}

/// What the model file states about its own record.
#[derive(Serialize)]
struct TrainedOn {
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

/// The validation as one line of JSON.
///
/// # Errors
/// If a number is not finite, which does not occur in a validation.
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
        schema: "bowden.validate/1",
        model,
        record: RecordPart {
            path,
            samples: record.samples,
            rate_hz: record.rate,
            mode: record.mode.name(),
            cutoff_hz: record.cutoff,
            excluded_s: check.left_out,
            unit: record.unit.as_deref(),
            output_std: check.deviation,
        },
        rmse: check.rmse,
        nrmse: share(check.rmse),
        rmse_gain_offset: check.rmse_gain_offset,
        nrmse_gain_offset: share(check.rmse_gain_offset),
        gain: check.line.gain,
        offset: check.line.offset,
        trained_on: TrainedOn {
            nrmse: check.came_with,
            held_out_rmse: check.reference_rmse,
            cutoff_hz: check.own_cutoff,
            rate_hz: check.own_rate,
        },
        threshold_nrmse: check.allowed.map(share),
        noise_floor: record.noise_floor,
        outside: &check.outside,
        depends_on: depends_on.collect(),
        defects: &record.defects,
        notes: &record.notes,
        verdict: check.verdict.name(),
        findings: &check.findings,
        summary: &check.sentence,
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

/// The validation as text, with ANSI styles that the caller may strip: the answer first.
#[must_use]
pub fn check_text(model: &str, path: &str, check: &CheckFacts, width: Width) -> String {
    let record = &check.record;
    let mut out = String::new();
    let (colour, headline) = match check.verdict {
        Verdict::Holds => (AnsiColor::Green, "THE MODEL HOLDS"),
        Verdict::GainOrOffsetMoved => (AnsiColor::Yellow, "GAIN OR OFFSET HAS CHANGED"),
        Verdict::CannotTell => (AnsiColor::Yellow, "INCONCLUSIVE RECORD"),
        Verdict::DoesNotHold => (AnsiColor::Red, "THE MODEL DOES NOT HOLD"),
        Verdict::DefectiveRecord => (AnsiColor::Red, "DEFECTIVE RECORD: repeat the measurement"),
    };
    let subject = format!("{model} on {path}");
    let command = ("bowden validate", subject.as_str());
    let mut asked = check
        .findings
        .iter()
        .filter_map(|told| told.finding.headline());
    let headline = asked.next().unwrap_or_else(|| headline.to_owned());
    heading(&mut out, width, command, (colour, &headline));
    prose(&mut out, width, &check.sentence);
    out.push('\n');
    let start = match check.left_out > 0.0 {
        true => format!(
            " · excludes the first {:.1} s, because the earlier input is unknown",
            check.left_out
        ),
        false => String::new(),
    };
    let data = [
        format!(
            "{} · {} mode, {} → {}",
            size(record),
            record.mode.name(),
            record.input,
            record.output
        ),
        format!("zero-phase low-pass {} Hz{start}", record.cutoff),
    ];
    block(&mut out, width, "Data", data);
    block(&mut out, width, "Note", &record.notes);
    let defects = record.defects.iter();
    let defects = defects.map(|defect| format!("{}: {}", defect.channel, defect.message));
    block(&mut out, width, "Defect", defects);
    line!(out, "\n{}", errors(check).text(width));
    let bound = check.allowed.map(|allowed| {
        format!(
            "the model holds up to an error of {}: {}",
            percent(allowed / check.deviation),
            check.rule
        )
    });
    block(&mut out, width, "Bound", bound);
    block(&mut out, width, "Outside", check.outside.iter().map(beyond));
    let depends = check.depends_on.iter().map(|one| {
        let tested = one.p.map_or_else(
            || "not tested: the correlation time of the residual is too long".to_owned(),
            |p| format!("p {p:.1e}"),
        );
        format!(
            "the residual depends on {}: a free-form curve removes {:.0} % of the squared error ({tested})",
            one.words,
            100.0 * one.share
        )
    });
    block(&mut out, width, "Depends", depends);
    block(
        &mut out,
        width,
        "Next",
        ["--json · --report page.html · bowden identify (fits a new model to this record)"],
    );
    out
}

/// "x: velocity −30 to 30 mm/s, the fit covered −10 to 10 (12 % of the samples are outside)".
fn beyond(one: &Outside) -> String {
    let pair = |[low, high]: [f64; 2]| {
        let digits = Some(0.01 * (high - low).abs());
        format!("{} to {}", number(low, digits), number(high, digits))
    };
    let unit = one.unit.as_deref();
    format!(
        "{}: {} {}{}, but the fit covered {} ({:.0} % of the samples are outside)",
        one.channel,
        one.quantity,
        pair(one.here),
        unit.map_or_else(String::new, |u| format!(" {u}")),
        pair(one.seen),
        100.0 * one.share
    )
}

fn errors(check: &CheckFacts) -> Columns {
    let record = &check.record;
    let unit = record.unit.as_deref().unwrap_or_default();
    let name = format!("Error{}", in_brackets(record.unit.as_deref()));
    let header = [&name, "RMSE", "of the output's std", "vs noise"];
    let mut rows = Columns::new(&header, &[3, 2]);
    let open = || "–".to_owned();
    let mut add = |name: &str, rmse: f64| {
        let times = record.floors(rmse);
        rows.add([
            format!("  {name}"),
            number(rmse, Some(0.05 * rmse)),
            percent(rmse / check.deviation),
            times.map_or_else(open, |times| format!("{times:.1} ×")),
        ]);
    };
    add("unchanged", check.rmse);
    let Line { gain, offset } = &check.line;
    let fit = format!(
        "with gain {}, offset {} {unit}",
        fitted(gain),
        fitted(offset)
    );
    add(fit.trim_end(), check.rmse_gain_offset);
    let own = check.reference.map_or_else(open, percent);
    let rmse = check.reference_rmse;
    let rmse = rmse.map_or_else(open, |rmse| number(rmse, Some(0.05 * rmse)));
    rows.add([
        "  held-out, on its own record".to_owned(),
        rmse,
        own,
        open(),
    ]);
    rows
}
