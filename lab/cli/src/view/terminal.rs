//! The ledger for people: the record, the added effects, errors before and after.

use super::curve;
use super::hand_over;
use super::several;
use super::terms::LEGEND;
use super::words::{estimate, in_brackets, table};
use anstyle::{AnsiColor, Style};
use bowden_lab::facts::{
    number, percent, Defect, Facts, FinalFacts, Grade, Parameter, RecordFacts, Segments, Size,
    Verdict, BLOCKS, HALVES,
};
use std::fmt::Write as _;

/// Style of secondary text.
const DIM: Style = Style::new().dimmed();

/// Maximum number of listed stretches; the JSON has all.
const LISTED: usize = 3;

/// "tau_o stuck …: lines 120–480, …".
fn defect_line(defect: &Defect) -> String {
    let range = |[from, to]: &[usize; 2]| match from == to {
        true => from.to_string(),
        false => format!("{from}–{to}"),
    };
    let mut lines: Vec<String> = defect.ranges.iter().take(LISTED).map(range).collect();
    if defect.ranges.len() > LISTED {
        lines.push(format!("{} more", defect.ranges.len() - LISTED));
    }
    let out = if defect.left_out {
        "; left out of the fit"
    } else {
        ""
    };
    let noun = match defect.ranges.as_slice() {
        [[from, to]] if from == to => "line",
        _ => "lines",
    };
    format!(
        "{}: {}{out} ({noun} {})",
        defect.channel,
        defect.message,
        lines.join(", ")
    )
}

/// An error and its multiple of the noise floor.
fn with_floor(rmse: f64, floor: Option<f64>) -> [String; 2] {
    let floor = floor.map_or_else(|| "–".to_owned(), |times| format!("{times:.1}"));
    [number(rmse, Some(0.05 * rmse)), floor]
}

/// The cells fit, × floor, stop, held out, × floor.
fn cells(record: &RecordFacts, rmse: &Segments) -> [String; 5] {
    let [fit, fit_floor] = with_floor(rmse.fit, record.floors(rmse.fit));
    let times = record.held_out_floors(rmse.held_out);
    let [held_out, held_out_floor] = with_floor(rmse.held_out, times);
    let stop = number(rmse.stop, Some(0.05 * rmse.stop));
    [fit, fit_floor, stop, held_out, held_out_floor]
}

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident, $($text:tt)+) => {
        let _ = writeln!($out, $($text)+);
    };
}

/// The whole ledger as text, with ANSI styles that the caller may strip.
#[must_use]
pub fn text(facts: &Facts, chosen_cutoff: bool) -> String {
    let mut out = head(facts, chosen_cutoff);
    out += &errors(facts);
    out += &several::errors(facts);
    out += &names(facts);
    out += &legend();
    out += &experiments(facts);
    if let Some(section) = curve::text(facts) {
        line!(out, "{section}");
    }
    out += &model(&facts.last);
    out += &conclusion(facts);
    out
}

/// The record, its filter and split, its defects, and the declared model.
fn head(facts: &Facts, chosen_cutoff: bool) -> String {
    let mut out = String::new();
    let bold = Style::new().bold();
    let record = &facts.record;
    let with = if record.channels.is_empty() {
        String::new()
    } else {
        format!(", with {}", record.channels.join(", "))
    };
    line!(out, "{bold}bowden close{bold:#}  {}", facts.label);
    line!(
        out,
        "read      {}; {} mode: {} → {}{with}",
        several::size(record),
        record.mode.name(),
        record.input,
        record.output
    );
    let whence = if chosen_cutoff {
        ""
    } else {
        " (8 × the input's highest tone)"
    };
    line!(
        out,
        "filtered  zero-phase at {} Hz{whence}; {}; {} blocks",
        record.cutoff,
        several::split(record),
        facts.blocks
    );
    for note in record.notes.iter().chain(unlike(facts).as_ref()) {
        line!(out, "{DIM}note      {note}{DIM:#}");
    }
    for defect in &record.defects {
        line!(out, "defect    {}", defect_line(defect));
    }
    line!(out, "declared  {}\n", facts.declared.effects.join(", "));
    out
}

/// A warning that percentages of the two segments are not comparable.
fn unlike(facts: &Facts) -> Option<String> {
    if !facts.segments_differ {
        return None;
    }
    let unit = facts.record.unit.as_deref();
    let unit = unit.map_or_else(String::new, |u| format!(" {u}"));
    let shown = |v: f64| number(v, Some(0.05 * v));
    Some(format!(
        "the output's standard deviation is {}{unit} on the fit segment and {}{unit} held out: percentages of the one say little of the other",
        shown(facts.deviation.fit),
        shown(facts.deviation.held_out)
    ))
}

/// The errors of each round.
fn errors(facts: &Facts) -> String {
    let mut out = String::new();
    line!(
        out,
        "RMSE{} of the filtered output, beside it in multiples of the noise floor:",
        in_brackets(facts.record.unit.as_deref())
    );
    let mut rounds = table(
        &[
            "", "effect", "grade", "explains", "fit", "× floor", "stop", "held out", "× floor",
        ],
        3..9,
    );
    let mut row = |first: [String; 4], rmse: &Segments, mark: &str| {
        let mut errors = cells(&facts.record, rmse);
        errors[3] += mark;
        rounds.add_row(first.into_iter().chain(errors));
    };
    let label = |text: &str| [String::new(), text.to_owned(), String::new(), String::new()];
    row(label("as declared"), &facts.declared.rmse, "");
    let found = facts.rounds.iter().chain(&facts.beyond).enumerate();
    for (index, round) in found {
        let is_delivered = index < facts.rounds.len();
        let first = [
            match is_delivered {
                true => format!("+{}", index + 1),
                false => format!("({})", index + 1),
            },
            round.title.clone(),
            grade(round.grade).to_owned(),
            format!("{:.1} %", 100.0 * round.explained),
        ];
        let mark = if round.raises_held_out { " ↑" } else { "" };
        row(first, &round.after, mark);
    }
    if facts.last.refitted {
        row(label("refit on fit + stop"), &facts.last.rmse, "");
    }
    line!(out, "{rounds}");
    if !facts.beyond.is_empty() {
        line!(
            out,
            "(n) found, and not delivered: on half-records that it was not fitted to, the model does as well without it"
        );
    }
    let fell = facts.falls_up_to;
    if fell < facts.rounds.len() {
        line!(
            out,
            "↑ this round raises the held-out error, which decides nothing; {}",
            match fell {
                0 => "the first round raises it already".to_owned(),
                n => format!("it fell up to round {n}"),
            }
        );
    }
    out.push('\n');
    out
}

fn grade(grade: Grade) -> &'static str {
    match grade {
        Grade::Firm => "firm",
        Grade::Weak => "weak",
    }
}

/// The size of each added effect in the final model, and its tests.
fn names(facts: &Facts) -> String {
    if facts.rounds.is_empty() {
        return String::new();
    }
    let mut added = table(
        &[
            "",
            "coefficient (95 %)",
            "p",
            "recurs",
            "blocks better",
            "confounded with",
        ],
        0..0,
    );
    for round in &facts.rounds {
        let rivals: Vec<&str> = round.rivals.iter().map(|r| r.title.as_str()).collect();
        added.add_row([
            round.title.clone(),
            coefficient(&round.size),
            round
                .p
                .map_or_else(|| "–".to_owned(), |p| format!("{p:.1e}")),
            format!("{} of {HALVES}", round.recurs),
            format!("{} of {BLOCKS}", round.blocks_better),
            if rivals.is_empty() {
                "–".to_owned()
            } else {
                rivals.join(", ")
            },
        ]);
    }
    format!("{added}\n\n")
}

/// The one number that is reported of an effect.
fn coefficient(size: &Size) -> String {
    match size {
        Size::Gain(gain) if holds_zero(gain) => SIZE_UNKNOWN.to_owned(),
        Size::Gain(gain) => estimate(gain),
        Size::Width(width) => format!("r = {}", estimate(width)),
        Size::Gone => String::new(),
    }
}

/// Maximum number of listed rejections.
const REJECTED: usize = 6;

/// The remark on a coefficient whose interval contains zero.
const SIZE_UNKNOWN: &str = "acts, size unknown";

fn holds_zero(parameter: &Parameter) -> bool {
    parameter
        .ci95
        .is_some_and(|[low, high]| low <= 0.0 && high >= 0.0)
}

/// The words of the tables, one line each.
fn legend() -> String {
    let mut out = String::new();
    for line in LEGEND {
        line!(out, "{DIM}{line}{DIM:#}");
    }
    line!(out, "{DIM}more: bowden help terms{DIM:#}\n");
    out
}

/// The experiments that would separate what is confounded.
fn experiments(facts: &Facts) -> String {
    let mut out = String::new();
    for experiment in facts.rounds.iter().filter_map(|r| r.experiment.as_ref()) {
        line!(out, "to separate: {}", experiment.trajectory);
        for aim in &experiment.aims {
            line!(out, "  {}", aim.words());
        }
        line!(out, "");
    }
    out
}

/// The final model, and the experiments that would identify its unidentified parameters.
fn model(last: &FinalFacts) -> String {
    let mut out = String::new();
    let mut final_parameters = table(&["final model", "value (95 %)"], 0..0);
    out.push_str(&several::gains(last));
    let all = || last.parameters.iter().zip(&last.titles);
    for (parameter, title) in all().skip(last.own_gains) {
        let is_gain = parameter.term.is_some() && !parameter.name.contains('.');
        let value = match is_gain && holds_zero(parameter) {
            true => format!("{SIZE_UNKNOWN}: {}", estimate(parameter)),
            false => estimate(parameter),
        };
        final_parameters.add_row([title.clone(), value]);
    }
    line!(out, "{final_parameters}\n");
    // Initial states belong to the record, not to the model.
    let of_the_model = |p: &Parameter| !p.name.starts_with("eta0") && !p.name.contains(".start");
    let refused = || {
        let own = all().filter(|(p, _)| of_the_model(p));
        own.filter_map(|(p, title)| Some((title, p.refused.as_ref()?)))
    };
    for (title, refusal) in refused() {
        line!(out, "to identify {title}: {}", refusal.excitation);
    }
    if refused().next().is_some() {
        line!(
            out,
            "{DIM}bowden plan writes a motion where it knows one{DIM:#}\n"
        );
    }
    out
}

/// The error before and after, rejected and unneeded effects, and the verdict.
fn conclusion(facts: &Facts) -> String {
    let mut out = String::new();
    let (before, after) = (&facts.declared.nrmse, &facts.last.nrmse);
    line!(
        out,
        "error     held out: {} → {} of the output's standard deviation (fit: {} → {})",
        percent(before.held_out),
        percent(after.held_out),
        percent(before.fit),
        percent(after.fit)
    );
    out.push_str(&hand_over::text(&facts.hand_over));
    if !facts.rejected.is_empty() {
        let rejected = facts.rejected.iter();
        let mut list: Vec<String> = rejected
            .map(|r| format!("{}: {}", r.title, r.gate.words()))
            .collect();
        let more = list.len().saturating_sub(REJECTED);
        list.truncate(REJECTED);
        if more > 0 {
            list.push(format!("and {more} more, in --json"));
        }
        line!(out, "{DIM}rejected  {}{DIM:#}", list.join("; "));
    }
    for part in &facts.unneeded {
        let (without, with) = (part.held_out_without, part.held_out_with);
        let left_out = if part.left_out { "; left out" } else { "" };
        line!(
            out,
            "unneeded  {}: held out {} without it, {} with it{left_out}",
            part.effect,
            number(without, Some(0.01 * without)),
            number(with, Some(0.01 * with))
        );
    }
    if let Some(seconds) = facts.correlated_for {
        line!(
            out,
            "{DIM}note      the residual stays correlated for {seconds:.3} s: too long for sixteen independent blocks{DIM:#}"
        );
    }
    let style = Style::new()
        .bold()
        .fg_color(Some(colour(facts.verdict).into()));
    line!(
        out,
        "verdict   {style}{}{style:#}. {}",
        facts.verdict.name(),
        facts.sentence
    );
    out
}

fn colour(verdict: Verdict) -> AnsiColor {
    match verdict {
        Verdict::Explained => AnsiColor::Green,
        Verdict::ExplainedColoured
        | Verdict::Unknown
        | Verdict::Confounded
        | Verdict::Stopped
        | Verdict::UnderExcited => AnsiColor::Yellow,
        Verdict::NoModel | Verdict::DoesNotCarryOver | Verdict::DataDefect => AnsiColor::Red,
    }
}
