//! The ledger for people: what was read, what was found, errors before and after.

use super::curve;
use super::hand_over;
use super::several;
use super::terms::LEGEND;
use super::words::{block_count, effects, estimate, number, table};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::intervals::{parameters, term_name, term_title, Parameter};
use crate::conclude::unneeded::unneeded;
use crate::conclude::verdict::{falls_up_to, percent, raises, sentence, verdict, Verdict};
use crate::export::hand_over::HandOver;
use crate::fit::Segments;
use crate::foresight::plan::separate;
use crate::ledger::{Grade, Ledger, Round};
use crate::problem::Prepared;
use crate::record::{Defect, Mode};
use crate::score::explains::{deviations, segments_differ};
use crate::score::scan::{Regime, BLOCKS};
use anstyle::{AnsiColor, Style};
use std::fmt::Write as _;

/// For what is read second.
const DIM: Style = Style::new().dimmed();

/// Stretches that are listed; the JSON has all.
const LISTED: usize = 3;

/// "tau_o stuck …: lines 120–480, …".
fn defect_line(defect: &Defect) -> String {
    let range = |[from, to]: &[usize; 2]| format!("{from}–{to}");
    let mut lines: Vec<String> = defect.ranges.iter().take(LISTED).map(range).collect();
    if defect.ranges.len() > LISTED {
        lines.push(format!("{} more", defect.ranges.len() - LISTED));
    }
    let out = if defect.left_out {
        "; left out of the fit"
    } else {
        ""
    };
    format!(
        "{}: {}{out} (lines {})",
        defect.channel,
        defect.message,
        lines.join(", ")
    )
}

/// An error and its multiple of the noise floor.
fn with_floor(data: &Prepared, rmse: f64) -> [String; 2] {
    let floor = match data.noise_floor > 0.0 {
        true => format!("{:.1}", rmse / data.noise_floor),
        false => "–".to_owned(),
    };
    [number(rmse, Some(0.05 * rmse)), floor]
}

/// The cells fit, × floor, stop, held out, × floor.
fn cells(data: &Prepared, rmse: &Segments) -> [String; 5] {
    let [fit, fit_floor] = with_floor(data, rmse.fit);
    let [held_out, held_out_floor] = with_floor(data, rmse.held_out);
    let stop = number(rmse.stop, Some(0.05 * rmse.stop));
    [fit, fit_floor, stop, held_out, held_out_floor]
}

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident, $($text:tt)+) => {
        let _ = writeln!($out, $($text)+);
    };
}

/// The whole ledger as text, with ANSI styles that whoever prints it may strip.
#[must_use]
pub fn text(
    path: &str,
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    hand: Result<&HandOver, &str>,
    chosen_cutoff: bool,
) -> String {
    let mut out = head(path, data, ledger, chosen_cutoff);
    out += &errors(data, ledger, done);
    out += &several::errors(data, ledger, done);
    out += &names(data, ledger, done);
    out += &legend();
    out += &experiments(data, ledger);
    if let Some(section) = curve::text(data, ledger, done) {
        line!(out, "{section}");
    }
    out += &model(done);
    out += &conclusion(data, ledger, done, hand);
    out
}

/// What was read, how it was filtered and split, what is wrong with it, what was declared.
fn head(path: &str, data: &Prepared, ledger: &Ledger, chosen_cutoff: bool) -> String {
    let mut out = String::new();
    let bold = Style::new().bold();
    let mode = match data.mode {
        Mode::Torque => "torque",
        Mode::Displacement => "displacement",
    };
    let channels: Vec<&str> = data.channels.iter().map(|c| c.name.as_str()).collect();
    let with = if channels.is_empty() {
        String::new()
    } else {
        format!(", with {}", channels.join(", "))
    };
    line!(out, "{bold}bowden close{bold:#}  {path}");
    line!(
        out,
        "read      {}; {mode} mode: {} → {}{with}",
        several::size(data),
        data.input.name,
        data.output_name
    );
    let whence = if chosen_cutoff {
        ""
    } else {
        " (8 × the input's highest tone)"
    };
    line!(
        out,
        "filtered  zero-phase at {} Hz{whence}; {}; {} blocks",
        data.cutoff,
        several::split(data),
        block_count(data, ledger)
    );
    for note in data.notes.iter().chain(unlike(data).as_ref()) {
        line!(out, "{DIM}note      {note}{DIM:#}");
    }
    for defect in &data.defects {
        line!(out, "defect    {}", defect_line(defect));
    }
    line!(
        out,
        "declared  {}\n",
        effects(data, &ledger.declared).join(", ")
    );
    out
}

/// That percentages of the two segments are of different things.
fn unlike(data: &Prepared) -> Option<String> {
    if !segments_differ(data) {
        return None;
    }
    let (fit, held_out) = deviations(data);
    let unit = data
        .output_unit
        .as_deref()
        .map_or_else(String::new, |u| format!(" {u}"));
    let shown = |v: f64| number(v, Some(0.05 * v));
    Some(format!(
        "the output's standard deviation is {}{unit} on the fit segment and {}{unit} held out: percentages of the one say little of the other",
        shown(fit),
        shown(held_out)
    ))
}

/// The errors of each round.
fn errors(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    let mut out = String::new();
    let unit = data
        .output_unit
        .as_deref()
        .map_or_else(String::new, |u| format!(" [{u}]"));
    line!(
        out,
        "RMSE{unit} of the filtered output, beside it in multiples of the noise floor:"
    );
    let mut rounds = table(
        &[
            "", "effect", "grade", "explains", "fit", "× floor", "stop", "held out", "× floor",
        ],
        3..9,
    );
    let mut row = |first: [String; 4], rmse: &Segments, mark: &str| {
        let mut errors = cells(data, rmse);
        errors[3] += mark;
        rounds.add_row(first.into_iter().chain(errors));
    };
    let label = |text: &str| [String::new(), text.to_owned(), String::new(), String::new()];
    row(label("as declared"), &ledger.declared.rmse, "");
    for (index, round) in ledger.rounds.iter().enumerate() {
        let first = [
            format!("+{}", index + 1),
            done.title_of(round),
            grade(round.grade).to_owned(),
            format!("{:.1} %", 100.0 * round.explained),
        ];
        row(first, &round.after, if raises(round) { " ↑" } else { "" });
    }
    if done.refitted {
        row(label("refit on fit + stop"), &done.rmse, "");
    }
    line!(out, "{rounds}");
    let fell = falls_up_to(ledger);
    if fell < ledger.rounds.len() {
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
        Grade::Strong => "strong",
        Grade::Likely => "likely",
        Grade::Weak => "weak",
    }
}

/// How large each added effect is in the final model, and how it stood its tests.
fn names(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> String {
    if ledger.rounds.is_empty() {
        return String::new();
    }
    let mut added = table(
        &[
            "",
            "coefficient (95 %)",
            "p",
            "blocks better",
            "confounded with",
        ],
        0..0,
    );
    let all = parameters(&done.data, &done.solution);
    for round in &ledger.rounds {
        let rivals: Vec<String> = round
            .rivals
            .iter()
            .map(|r| term_title(data, &r.term))
            .collect();
        added.add_row([
            done.title_of(round),
            coefficient(data, done, &all, round),
            round
                .p
                .map_or_else(|| "–".to_owned(), |p| format!("{p:.1e}")),
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

/// The size of a round's effect in the final model, the one number that is reported of it.
fn coefficient(data: &Prepared, done: &FinalFit, all: &[Parameter], round: &Round) -> String {
    let name = term_name(data, round.term());
    let term = done.term_of(round);
    let own = |wanted: &str| {
        let mut own = all.iter().filter(|p| p.term.is_some() && p.term == term);
        own.find(|p| p.name == wanted)
    };
    // An input stage has no gain: its width says how large it is.
    match (own(&name), own(&format!("{name}.r"))) {
        (Some(gain), _) if holds_zero(gain) => SIZE_UNKNOWN.to_owned(),
        (Some(gain), _) => estimate(gain),
        (None, Some(width)) => format!("r = {}", estimate(width)),
        (None, None) => String::new(),
    }
}

/// What is said of a coefficient whose interval holds zero.
const SIZE_UNKNOWN: &str = "acts, size unknown";

fn holds_zero(parameter: &Parameter) -> bool {
    parameter
        .ci95
        .is_some_and(|[low, high]| low <= 0.0 && high >= 0.0)
}

/// The words of the tables, a line each.
fn legend() -> String {
    let mut out = String::new();
    for line in LEGEND {
        line!(out, "{DIM}{line}{DIM:#}");
    }
    line!(out, "{DIM}more: bowden help terms{DIM:#}\n");
    out
}

/// The experiments that would separate what is confounded.
fn experiments(data: &Prepared, ledger: &Ledger) -> String {
    let mut out = String::new();
    for experiment in ledger.rounds.iter().filter_map(|r| separate(data, r)) {
        line!(out, "to separate: {}", experiment.trajectory);
        for aim in &experiment.aims {
            line!(out, "  {}", aim.words());
        }
        line!(out, "");
    }
    out
}

/// The name of a parameter, with what tells two effects of one name apart.
fn title(done: &FinalFit, parameter: &Parameter) -> String {
    let term = parameter
        .term
        .and_then(|index| done.solution.structure.terms.get(index));
    let Some(term) = term else {
        return parameter.name.clone();
    };
    match parameter.name.strip_prefix(&term_name(&done.data, term)) {
        Some(rest) => term_title(&done.data, term) + rest,
        None => parameter.name.clone(),
    }
}

/// The final model, and what would identify the parameters that are not.
fn model(done: &FinalFit) -> String {
    let mut out = String::new();
    let last = &done.solution;
    let mut final_parameters = table(&["final model", "value (95 %)"], 0..0);
    let own_gains = match last.structure.own_gains {
        0 => 0,
        _ => last.structure.base(),
    };
    out.push_str(&several::gains(&done.data, last));
    let all = parameters(&done.data, last);
    for parameter in &all[own_gains..] {
        let is_gain = parameter.term.is_some() && !parameter.name.contains('.');
        let value = match is_gain && holds_zero(parameter) {
            true => format!("{SIZE_UNKNOWN}: {}", estimate(parameter)),
            false => estimate(parameter),
        };
        final_parameters.add_row([title(done, parameter), value]);
    }
    line!(out, "{final_parameters}\n");
    // What the states were before the record is no part of the model.
    let of_the_model = |p: &&Parameter| !p.name.starts_with("eta0") && !p.name.contains(".start");
    let refused = || {
        let own = all.iter().filter(of_the_model);
        own.filter_map(|p| Some((p, p.refused.as_ref()?)))
    };
    for (parameter, refusal) in refused() {
        line!(
            out,
            "to identify {}: {}",
            title(done, parameter),
            refusal.excitation
        );
    }
    if refused().next().is_some() {
        line!(
            out,
            "{DIM}bowden plan writes a motion where it knows one{DIM:#}\n"
        );
    }
    out
}

/// The error before and after, what was turned down or is not needed, and the verdict.
fn conclusion(
    data: &Prepared,
    ledger: &Ledger,
    done: &FinalFit,
    hand: Result<&HandOver, &str>,
) -> String {
    let mut out = String::new();
    let (before, after) = (
        ledger.declared.rmse.normalised(data, &data.target),
        done.rmse.normalised(data, &data.target),
    );
    line!(
        out,
        "error     held out: {} → {} of the output's standard deviation (fit: {} → {})",
        percent(before.held_out),
        percent(after.held_out),
        percent(before.fit),
        percent(after.fit)
    );
    out.push_str(&hand_over::text(hand));
    if !ledger.rejected.is_empty() {
        let list: Vec<String> = ledger
            .rejected
            .iter()
            .map(|r| {
                let name = term_title(data, &r.candidate.term);
                format!("{name}: {}", r.gate.words())
            })
            .collect();
        line!(out, "{DIM}rejected  {}{DIM:#}", list.join("; "));
    }
    for part in unneeded(ledger, done) {
        let (without, with) = (part.held_out_without, done.rmse.held_out);
        line!(
            out,
            "unneeded  {}: held out {} without it, {} with it",
            part.effect,
            number(without, Some(0.01 * without)),
            number(with, Some(0.01 * with))
        );
    }
    if ledger.regime == Regime::Effect {
        line!(
            out,
            "{DIM}note      the residual stays correlated for {:.3} s: too long for sixteen independent blocks{DIM:#}",
            ledger.correlation_time
        );
    }
    let found = verdict(data, ledger, done);
    let colour = match found {
        Verdict::Explained => AnsiColor::Green,
        Verdict::ExplainedColoured
        | Verdict::Unknown
        | Verdict::Confounded
        | Verdict::Stopped
        | Verdict::UnderExcited => AnsiColor::Yellow,
        Verdict::NoModel | Verdict::DoesNotCarryOver | Verdict::DataDefect => AnsiColor::Red,
    };
    let style = Style::new().bold().fg_color(Some(colour.into()));
    line!(
        out,
        "verdict   {style}{}{style:#}. {}",
        found.name(),
        sentence(data, ledger, done)
    );
    out
}
