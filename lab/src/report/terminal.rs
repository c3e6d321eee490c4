//! The ledger for people: what was read, what was found, errors before and after.

use super::curve;
use super::hand_over;
use super::json::{block_count, effects};
use super::several;
use crate::channels::Prepared;
use crate::closing::{Grade, Ledger};
use crate::final_fit::FinalFit;
use crate::fit::Segments;
use crate::hand_over::HandOver;
use crate::intervals::{parameters, term_name, Parameter};
use crate::plan::separate;
use crate::record::{Defect, Mode};
use crate::scan::{Regime, BLOCKS};
use crate::unneeded::unneeded;
use crate::verdict::{sentence, verdict, Verdict};
use anstyle::{AnsiColor, Style};
use comfy_table::{presets, CellAlignment, ContentArrangement, Table, TableComponent};
use std::fmt::Write as _;

/// A number with as many digits as its interval bears.
pub(super) fn number(value: f64, half_width: Option<f64>) -> String {
    let digits = match half_width {
        Some(w) if w > 0.0 && w.is_finite() => (1.0 - w.log10().floor()).clamp(0.0, 12.0) as usize,
        _ if value == 0.0 => 0,
        _ => (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize,
    };
    if value.abs() >= 1e7 || (value != 0.0 && value.abs() < 1e-5) {
        format!("{value:.3e}")
    } else {
        format!("{value:.digits$}")
    }
}

/// "12.34 ± 0.05 N·m", or what is to be said instead.
pub(super) fn estimate(parameter: &Parameter) -> String {
    let unit = match parameter.unit.as_deref() {
        Some("1") => String::new(),
        Some(unit) => format!(" {unit}"),
        None => " (no unit in the record)".to_owned(),
    };
    match parameter.ci95 {
        Some([low, high]) => {
            let half = 0.5 * (high - low);
            format!(
                "{} ± {}{unit}",
                number(parameter.value, Some(half)),
                number(half, Some(half))
            )
        }
        None => {
            let reason = parameter.refused.as_ref().map_or("", |r| r.reason.as_str());
            let stands = number(parameter.value, None);
            format!("not identified: {reason}; stands at {stands}")
        }
    }
}

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

fn cells(data: &Prepared, rmse: &Segments) -> [String; 4] {
    let floor = if data.noise_floor > 0.0 {
        format!("{:.1}", rmse.fit / data.noise_floor)
    } else {
        "–".to_owned()
    };
    let digits = |v: f64| number(v, Some(0.05 * v));
    [
        digits(rmse.fit),
        digits(rmse.stop),
        digits(rmse.held_out),
        floor,
    ]
}

pub(super) fn table(header: &[&str], right: std::ops::Range<usize>) -> Table {
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .remove_style(TableComponent::HorizontalLines)
        .remove_style(TableComponent::LeftBorderIntersections)
        .remove_style(TableComponent::MiddleIntersections)
        .remove_style(TableComponent::RightBorderIntersections)
        .set_content_arrangement(ContentArrangement::Dynamic);
    if table.width().is_none() {
        // Not a terminal: the same width on every machine.
        table.set_width(120);
    }
    table.set_header(header);
    for index in right {
        if let Some(column) = table.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table
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
    hand: Option<&HandOver>,
    chosen_cutoff: bool,
) -> String {
    let mut out = String::new();
    let bold = Style::new().bold();
    let dim = Style::new().dimmed();
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
    for note in &data.notes {
        line!(out, "{dim}note      {note}{dim:#}");
    }
    for defect in &data.defects {
        line!(out, "defect    {}", defect_line(defect));
    }
    line!(
        out,
        "declared  {}\n",
        effects(data, &ledger.declared).join(", ")
    );

    let unit = data
        .output_unit
        .as_deref()
        .map_or_else(String::new, |u| format!(" [{u}]"));
    line!(
        out,
        "RMSE{unit} of the filtered output, in multiples of the noise floor on the right:"
    );
    let mut rounds = table(
        &[
            "", "effect", "grade", "explains", "fit", "stop", "held out", "× floor",
        ],
        3..8,
    );
    let [a, b, c, d] = cells(data, &ledger.declared.rmse);
    rounds.add_row([
        String::new(),
        "as declared".into(),
        String::new(),
        String::new(),
        a,
        b,
        c,
        d,
    ]);
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
    for (index, round) in ledger.rounds.iter().enumerate() {
        let grade = match round.grade {
            Grade::Strong => "strong",
            Grade::Likely => "likely",
            Grade::Weak => "weak",
        };
        let name = term_name(data, &round.candidate.term);
        let [a, b, c, d] = cells(data, &round.after);
        rounds.add_row([
            format!("+{}", index + 1),
            name.clone(),
            grade.to_owned(),
            format!("{:.1} %", 100.0 * round.explained),
            a,
            b,
            c,
            d,
        ]);
        let term = round.solution.structure.terms.len() - 1;
        let own = parameters(data, &round.solution);
        let gain = own
            .iter()
            .find(|p| p.term == Some(term) && p.name == name)
            .map(estimate);
        // An input stage has no gain: its width says how large it is.
        let width = || {
            let own = own.iter().find(|p| p.name == format!("{name}.r"))?;
            Some(format!("r = {}", estimate(own)))
        };
        let coefficient = gain.or_else(width).unwrap_or_default();
        let rivals: Vec<String> = round
            .rivals
            .iter()
            .map(|r| term_name(data, &r.term))
            .collect();
        added.add_row([
            name,
            coefficient,
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
    if done.refitted {
        let [a, b, c, d] = cells(data, &done.rmse);
        rounds.add_row([
            String::new(),
            "refit on fit + stop".into(),
            String::new(),
            String::new(),
            a,
            b,
            c,
            d,
        ]);
    }
    line!(out, "{rounds}\n");
    if !ledger.rounds.is_empty() {
        line!(out, "{added}\n");
    }
    out.push_str(&several::errors(data, ledger, done));
    for experiment in ledger.rounds.iter().filter_map(|r| separate(data, r)) {
        line!(out, "to separate: {}", experiment.trajectory);
        for aim in &experiment.aims {
            line!(out, "  {}", aim.words());
        }
        line!(out, "");
    }

    if let Some(section) = curve::text(data, ledger, done) {
        line!(out, "{section}");
    }
    let last = &done.solution;
    let mut final_parameters = table(&["final model", "value (95 %)"], 0..0);
    let own_gains = match last.structure.own_gains {
        0 => 0,
        _ => last.structure.base(),
    };
    out.push_str(&several::gains(&done.data, last));
    let all = parameters(&done.data, last);
    for parameter in &all[own_gains..] {
        final_parameters.add_row([parameter.name.clone(), estimate(parameter)]);
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
            parameter.name,
            refusal.excitation
        );
    }
    if refused().next().is_some() {
        line!(
            out,
            "{dim}bowden plan writes a motion where it knows one{dim:#}\n"
        );
    }

    let (before, after) = (
        ledger.declared.rmse.normalised(data, &data.target),
        done.rmse.normalised(data, &data.target),
    );
    line!(
            out,
        "error     held out: {:.2} % → {:.2} % of the output's standard deviation (fit: {:.2} % → {:.2} %)",
        100.0 * before.held_out, 100.0 * after.held_out, 100.0 * before.fit, 100.0 * after.fit
    );
    out.push_str(&hand.map_or_else(String::new, hand_over::text));
    if !ledger.rejected.is_empty() {
        let list: Vec<String> = ledger
            .rejected
            .iter()
            .map(|r| {
                format!(
                    "{} ({})",
                    term_name(data, &r.candidate.term),
                    r.gate.words()
                )
            })
            .collect();
        line!(out, "{dim}rejected  {}{dim:#}", list.join(", "));
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
            "{dim}note      what is left stays correlated for {:.3} s: too long for sixteen independent blocks{dim:#}",
            ledger.correlation_time
        );
    }
    let found = verdict(data, ledger);
    let colour = match found {
        Verdict::Explained | Verdict::ExplainedColoured => AnsiColor::Green,
        Verdict::Unknown | Verdict::Confounded | Verdict::UnderExcited => AnsiColor::Yellow,
        Verdict::DataDefect => AnsiColor::Red,
    };
    let style = Style::new().bold().fg_color(Some(colour.into()));
    line!(
        out,
        "verdict   {style}{}{style:#}. {}",
        found.name(),
        sentence(data, ledger)
    );
    out
}
