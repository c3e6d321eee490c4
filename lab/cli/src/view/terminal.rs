//! The result of a run as text: the answer, the record, the errors, the model, its use.

use super::curve;
use super::hand_over;
use super::layout::{block, heading, prose, two_columns, Columns, Report, Width, LISTED};
use super::several;
use super::words::{estimate, in_brackets, table};
use anstyle::AnsiColor;
use bowden_lab::facts::{
    lacking, number, percent, Defect, DescribedBy, Facts, Grade, Lack, Parameter, Segments, Size,
    Verdict, BLOCKS, TIED,
};
use std::fmt::Write as _;

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
        "; excluded from the fit"
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

/// One more line of the text; writing to a `String` cannot fail.
macro_rules! line {
    ($out:ident) => {
        $out.push('\n');
    };
    ($out:ident, $($text:tt)+) => {
        let _ = writeln!($out, $($text)+);
    };
}

/// The whole report as text, with ANSI styles that the caller may strip.
#[must_use]
pub fn text(facts: &Facts, report: Report) -> String {
    let mut out = answer(facts, report.width);
    out += &record(facts, report);
    out += &errors(facts, report);
    out += &several::errors(facts);
    out += &several::alone(facts, report.width);
    if report.verbose {
        out += &tests(facts);
        out += &rejected(facts, report.width);
    }
    out += &experiments(facts, report);
    if let Some(section) = curve::text(facts, report) {
        line!(out, "{section}");
    }
    out += &model(facts, report);
    // The headline says not to use it.
    if facts.is_usable() {
        out += &hand_over::text(&facts.hand_over, report.width);
    }
    out += &next(facts, report);
    out
}

/// The headline, the coefficient of each added term, and the summary.
fn answer(facts: &Facts, width: Width) -> String {
    let mut out = String::new();
    let command = ("bowden identify", facts.label.as_str());
    let colour = colour(facts);
    heading(&mut out, width, command, (colour, &headline(facts)));
    let errors: Vec<&str> = facts.errors().map(|told| told.words.as_str()).collect();
    let errors = errors.join(" ");
    if !errors.is_empty() {
        prose(&mut out, width, &errors);
    }
    for lack in facts.lacks.iter().skip(1) {
        prose(
            &mut out,
            width,
            &format!("also missing: {}", share(facts, lack)),
        );
    }
    let exported = facts.constrained().is_some();
    for round in &facts.rounds {
        let mut words = round.title.clone();
        let size = coefficient(&round.size);
        if !size.is_empty() {
            let _ = write!(words, " {size}");
        }
        let _ = match (exported, &round.size, round.grade) {
            (true, Size::Gone, _) => write!(words, " is not in the exported model"),
            (true, ..) => write!(words, " in the exported model"),
            (false, _, Grade::High) => write!(words, " · high confidence"),
            (false, _, Grade::Low) => write!(words, " · candidate"),
        };
        prose(&mut out, width, &words);
    }
    for lack in facts
        .lacks
        .iter()
        .filter(|lack| !lack.described_by.is_empty())
    {
        let sets: Vec<String> = lack.described_by.iter().map(DescribedBy::words).collect();
        let words = format!("{}: also described by {}", lack.title, sets.join(" or "));
        prose(&mut out, width, &words);
    }
    let rest = unsaid(facts, &errors);
    if !rest.is_empty() {
        prose(&mut out, width, &rest);
    }
    line!(out);
    out
}

/// The summary without the errors, which come first, and without the mechanisms, which the headline
/// names unless there are errors.
fn unsaid(facts: &Facts, errors: &str) -> String {
    let rest = facts.sentence.replacen(errors, "", 1);
    let rest = rest.trim_start();
    let rest = match errors.is_empty() {
        true => rest.strip_prefix(&lacking(&facts.lacks)).unwrap_or(rest),
        false => rest,
    };
    rest.trim_start().to_owned()
}

/// "friction over the velocity of x (94 % of the missing output)". What the terms of a complete
/// model remove is in the table of errors.
fn share(facts: &Facts, lack: &Lack) -> String {
    match facts.complete.at_floor {
        true => lack.title.clone(),
        false => {
            let share = 100.0 * lack.share.most();
            format!("{} ({share:.0} % of the missing output)", lack.title)
        }
    }
}

/// Whether the largest share, as printed, is 0 %.
fn explains_little(facts: &Facts) -> bool {
    let largest = facts.lacks.first().map(|lack| 100.0 * lack.share.most());
    !facts.complete.at_floor && largest.is_some_and(|share| share.round() <= 0.0)
}

/// The answer in a few words.
fn headline(facts: &Facts) -> String {
    let main = facts.lacks.first();
    let main = main.map_or_else(String::new, |lack| share(facts, lack));
    if let Some(asked) = facts.errors().find_map(|told| told.finding.headline()) {
        return asked;
    }
    match (facts.verdict, facts.rounds.len()) {
        (Verdict::NoInputDependence, _) => {
            "DO NOT USE THIS MODEL: the output does not follow the input".to_owned()
        }
        (Verdict::NotTransferable, _) => {
            "DO NOT USE THIS MODEL: it fits only part of the record".to_owned()
        }
        (Verdict::DefectiveRecord, _) => "DEFECTIVE RECORD: repeat the measurement".to_owned(),
        (Verdict::UnderExcited, 0) => {
            "UNDER-EXCITED RECORD: too little motion to find a missing term".to_owned()
        }
        (Verdict::UnderExcited, _) => format!("UNDER-EXCITED RECORD: {main} may be missing"),
        (Verdict::UnmodelledDependence, _) if facts.lacks.is_empty() => {
            let words = facts
                .unknown
                .as_ref()
                .map_or("", |unknown| unknown.words.as_str());
            format!("UNMODELLED DEPENDENCE ON {words}")
        }
        (Verdict::Stopped, 0) => "SEARCH STOPPED: the residual exceeds the sensor noise".to_owned(),
        (Verdict::Explained, 0) if facts.constrained().is_some() => {
            "NO TERM IS MISSING: without --invertible the residual is sensor noise".to_owned()
        }
        (Verdict::Explained, 0) => "NO TERM IS MISSING: the residual is sensor noise".to_owned(),
        (_, 0) => "NO MISSING TERM FOUND: the residual exceeds the sensor noise".to_owned(),
        _ if explains_little(facts) => format!("LITTLE IS EXPLAINED: {main}"),
        _ => format!("MISSING: {main}"),
    }
}

/// The record, its filter and split, and its defects.
fn record(facts: &Facts, report: Report) -> String {
    let record = &facts.record;
    let mut data = vec![format!(
        "{} · {} mode, {} → {}",
        several::size(record),
        record.mode.name(),
        record.input,
        record.output
    )];
    let channels = match record.channels.is_empty() {
        true => String::new(),
        false => format!("channels {} · ", record.channels.join(", ")),
    };
    let origin = match report.chosen_cutoff {
        true => "",
        false => " (from the input)",
    };
    data.push(format!(
        "{channels}zero-phase low-pass {} Hz{origin}",
        record.cutoff
    ));
    data.push(format!(
        "split: {} · {} blocks",
        several::split(record),
        facts.blocks
    ));
    let mut out = String::new();
    block(&mut out, report.width, "Data", data);
    let seconds = facts.correlated_for.map(|seconds| format!("the residual is correlated over {seconds:.3} s, which is too long for sixteen independent blocks"));
    let redundant = facts.unneeded.iter().map(|part| {
        let (without, with) = (part.held_out_without, part.held_out_with);
        format!(
            "redundant: {}, held-out {} without it, {} with it{}",
            part.effect,
            number(without, Some(0.01 * without)),
            number(with, Some(0.01 * with)),
            if part.removed { "; removed" } else { "" }
        )
    });
    let notes = record
        .notes
        .iter()
        .cloned()
        .chain(unlike(facts))
        .chain(seconds)
        .chain(redundant);
    block(&mut out, report.width, "Note", notes);
    block(
        &mut out,
        report.width,
        "Defect",
        record.defects.iter().map(defect_line),
    );
    out.push('\n');
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
        "the output's standard deviation is {}{unit} on the fit segment and {}{unit} on the held-out segment, so the percentages of these segments are not comparable",
        shown(facts.deviation.fit),
        shown(facts.deviation.held_out)
    ))
}

/// The error after each term.
fn errors(facts: &Facts, report: Report) -> String {
    let width = report.width;
    let record = &facts.record;
    let name = format!("RMSE{}", in_brackets(record.unit.as_deref()));
    let header = [&name, "fit", "selection", "held-out", "vs noise"];
    let mut rows = Columns::new(&header, &[2, 1, 4]);
    let mut row = |name: String, rmse: &Segments, mark: &str| {
        let digits = |rmse: f64| number(rmse, Some(0.05 * rmse));
        let times = record.held_out_floors(rmse.held_out);
        rows.add([
            format!("  {name}"),
            digits(rmse.fit),
            digits(rmse.selection),
            format!("{}{mark}", digits(rmse.held_out)),
            times.map_or_else(|| "–".to_owned(), |times| format!("{times:.1} ×")),
        ]);
    };
    let baseline = format!("{} (baseline)", facts.declared.effects.join(", "));
    row(baseline, &facts.declared.rmse, "");
    let found = facts.rounds.iter().chain(&facts.beyond).enumerate();
    for (index, round) in found {
        let name = match index < facts.rounds.len() {
            true => format!("+ {}", round.title),
            false => format!("({})", round.title),
        };
        let mark = if round.raises_held_out { " ↑" } else { "" };
        row(name, &round.after, mark);
    }
    // The headline quotes this row, if its percentage is another one.
    let quoted = |rmse: &Segments| percent(rmse.held_out / facts.deviation.held_out);
    let last = facts.rounds.last().map(|round| quoted(&round.after));
    let is_other = last.is_some_and(|last| last != quoted(&facts.last.rmse));
    if facts.last.refitted && (report.verbose || is_other) {
        row("final (refitted)".to_owned(), &facts.last.rmse, "");
    }
    if let Some(exported) = facts.constrained() {
        row("exported (--invertible)".to_owned(), &exported.rmse, "");
    }
    let mut out = rows.text(width);
    if !facts.beyond.is_empty() {
        block(&mut out, width, "Note", ["in brackets: not in the final model, because the model is as good without the term on blocks left out of the fit"]);
    }
    let fell = facts.falls_up_to;
    if fell < facts.rounds.len() {
        let until = match fell {
            0 => "The first term already raises this error".to_owned(),
            n => format!("This error falls up to and including term {n}"),
        };
        block(
            &mut out,
            width,
            "Note",
            [format!(
                "↑: the term raises the held-out error, which the search does not use. {until}"
            )],
        );
    }
    out.push('\n');
    out
}

/// The tests of each added term.
fn tests(facts: &Facts) -> String {
    if facts.rounds.is_empty() {
        return String::new();
    }
    let mut added = table(&["Tests", "p", "blocks improved", "alternatives"], 0..0);
    for round in &facts.rounds {
        let alternatives: Vec<&str> = round.rivals.iter().map(|r| r.title.as_str()).collect();
        added.add_row([
            round.title.clone(),
            round
                .p
                .map_or_else(|| "–".to_owned(), |p| format!("{p:.1e}")),
            format!("{} of {BLOCKS}", round.blocks_better),
            match alternatives.is_empty() {
                true => "–".to_owned(),
                false => alternatives.join(", "),
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

/// The remark on a coefficient whose interval contains zero.
const SIZE_UNKNOWN: &str = "present, size unknown";

fn holds_zero(parameter: &Parameter) -> bool {
    parameter
        .ci95
        .is_some_and(|[low, high]| low <= 0.0 && high >= 0.0)
}

/// The rejected terms.
fn rejected(facts: &Facts, width: Width) -> String {
    let mut out = String::new();
    let all = facts.rejected.iter();
    let all = all.map(|r| format!("rejected: {}, {}", r.title, r.gate.words()));
    block(&mut out, width, "", all);
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

/// The experiments that would separate the alternatives.
fn experiments(facts: &Facts, report: Report) -> String {
    let mut out = String::new();
    for experiment in facts.rounds.iter().filter_map(|r| r.experiment.as_ref()) {
        let aims = experiment
            .aims
            .iter()
            .map(|aim| format!("  {}", aim.words()));
        let aims = aims.filter(|_| report.verbose);
        let motion = format!("to separate: {}", experiment.trajectory);
        block(
            &mut out,
            report.width,
            "Plan",
            std::iter::once(motion).chain(aims),
        );
    }
    if !out.is_empty() {
        out.push('\n');
    }
    out
}

/// The model's equation, its parameters, and what would identify those that are not identified.
fn model(facts: &Facts, report: Report) -> String {
    let last = facts.shown();
    let mut out = several::gains(last);
    let all = || last.parameters.iter().zip(&last.titles);
    let (mut short, mut long) = (Vec::new(), Vec::new());
    for (parameter, title) in all().skip(last.own_gains) {
        let is_gain = parameter.term.is_some() && !parameter.name.contains('.');
        let value = match is_gain && holds_zero(parameter) {
            true => format!("{SIZE_UNKNOWN}: {}", estimate(parameter)),
            false => estimate(parameter),
        };
        let item = format!("{title} {value}");
        if parameter.not_identified.is_some() {
            &mut long
        } else {
            &mut short
        }
        .push(item);
    }
    // Initial states belong to the record, not to the model.
    let of_the_model = |p: &Parameter| !p.name.starts_with("eta0") && !p.name.contains(".start");
    let own = all().filter(|(p, _)| of_the_model(p));
    let missing = own.filter_map(|(p, title)| Some((title, p.not_identified.as_ref()?)));
    let excitations =
        missing.map(|(title, why)| format!("to identify {title}: {}", why.excitation));
    let exported = facts.constrained();
    let exported = exported.map(|_| "model exported with --invertible, as in the file:".to_owned());
    let on_bound = matches!(&facts.hand_over, Ok(hand) if hand.on_inverse_bound);
    let tied = on_bound.then(|| format!("{} is {TIED}", last.gain_names[0]));
    let lines = exported
        .into_iter()
        .chain(std::iter::once(facts.equation()))
        .chain(tied)
        .chain(two_columns(&short, report.width))
        .chain(long)
        .chain(excitations.filter(|_| report.verbose));
    block(&mut out, report.width, "Model", lines);
    out.push('\n');
    out
}

/// What to type next.
fn next(facts: &Facts, report: Report) -> String {
    let unidentified = facts
        .shown()
        .parameters
        .iter()
        .any(|p| p.not_identified.is_some());
    let ambiguous = facts.rounds.iter().any(|r| r.experiment.is_some());
    let plan = if unidentified || ambiguous {
        " · bowden plan"
    } else {
        ""
    };
    let verbose = if report.verbose { "" } else { "-v · " };
    let mut out = String::new();
    let model = match facts.is_usable() {
        true => "--model-out model.toml · ",
        false => "",
    };
    let words = format!("{verbose}{model}--report page.html{plan} · bowden help terms");
    block(&mut out, report.width, "Next", [words]);
    out
}

fn colour(facts: &Facts) -> AnsiColor {
    match facts.verdict {
        // What explains the record is not what is exported.
        Verdict::Explained if facts.constrained().is_none() && facts.is_usable() => {
            AnsiColor::Green
        }
        _ if facts.is_usable() => AnsiColor::Yellow,
        _ => AnsiColor::Red,
    }
}
