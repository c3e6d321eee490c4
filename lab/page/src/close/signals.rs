//! Signals over time and the hysteresis loop.

use crate::chart::scale::Scale;
use crate::chart::{Axis, Chart};
use crate::words::{in_brackets, quantity};
use bowden_lab::facts::{number, Column, Facts, Figures, File, Segment, Signals};
use maud::{html, Markup};
use std::ops::Range;

/// The stretches of one segment in a file, in seconds since its start.
fn stretches(signals: &Signals, file: &File) -> Vec<(Segment, [f64; 2])> {
    let rows = file.rows.clone().collect::<Vec<usize>>();
    let runs = rows.chunk_by(|a, b| signals.segments[*a] == signals.segments[*b]);
    let ends = |run: &[usize]| {
        let (first, last) = (run.first()?, run.last()?);
        Some((
            signals.segments[*first],
            [signals.time(*first), signals.time(*last) + signals.step],
        ))
    };
    runs.filter_map(ends).collect()
}

/// Marks the segments; stretches of one segment that a blind stretch parts are named once.
fn with_segments(mut chart: Chart, signals: &Signals, file: &File) -> Chart {
    let mut named = Vec::new();
    for (segment, span) in stretches(signals, file) {
        let (class, name) = match segment {
            Segment::Fit => ("fit", "fit"),
            Segment::Stop => ("stop", "selection"),
            Segment::HeldOut => ("held", "held out"),
            Segment::Checked => ("held", "checked"),
            Segment::Dropped => continue,
        };
        let label = if named.contains(&segment) { "" } else { name };
        named.push(segment);
        chart = chart.stretch(class, label, span);
    }
    chart
}

/// The points of a column over time.
fn over_time<'a>(
    signals: &'a Signals,
    file: &'a File,
    rows: Range<usize>,
    values: &'a [f64],
) -> impl Iterator<Item = [f64; 2]> + 'a {
    let start = file.rows.start;
    rows.map(move |row| [(row - start) as f64 * signals.step, values[row]])
}

/// The runs of samples that count.
fn counting(signals: &Signals, file: &File) -> Vec<Range<usize>> {
    let rows = file.rows.clone();
    let rows: Vec<usize> = rows
        .filter(|&r| signals.segments[r] != Segment::Dropped)
        .collect();
    let runs = rows.chunk_by(|a, b| a + 1 == *b);
    runs.filter_map(|run| Some(*run.first()?..*run.last()? + 1))
        .collect()
}

fn time_axis(signals: &Signals, file: &File, rows: &Range<usize>) -> Axis {
    let at = |row: usize| (row - file.rows.start) as f64 * signals.step;
    Axis {
        label: "time [s]".to_owned(),
        scale: Scale::exactly(at(rows.start), at(rows.end.saturating_sub(1))),
    }
}

fn lines(chart: Chart, signals: &Signals, file: &File, rows: &Range<usize>) -> Chart {
    let [first, last] = &signals.models;
    let of = |column: &'_ Column| {
        over_time(signals, file, rows.clone(), &column.values).collect::<Vec<_>>()
    };
    chart
        .line("measured", of(&signals.measured))
        .line("declared", of(first))
        .line("final", of(last))
        .key("measured", "measured")
        .key("declared", &first.name)
        .key("final", &last.name)
}

/// The output's axis over some samples.
fn output_axis(signals: &Signals, rows: &Range<usize>) -> Axis {
    let [first, last] = &signals.models;
    let columns = [&signals.measured, first, last];
    let own = columns.map(|c| c.values[rows.clone()].iter().copied());
    Axis {
        label: quantity(&signals.measured.name, signals.measured.unit.as_deref()),
        scale: Scale::linear(own.into_iter().flatten()),
    }
}

/// Measured output and both models over time.
pub(crate) fn trace(signals: &Signals, file: &File, id: &str) -> Chart {
    let [first, last] = &signals.models;
    let seconds = file.rows.len() as f64 * signals.step;
    let description = format!(
        "The measured {} over {seconds:.1} s, with the {} model and the {} model. The background marks the segments.",
        signals.measured.name, first.name, last.name
    );
    let chart = Chart::new(
        id,
        "Output over time",
        &description,
        time_axis(signals, file, &file.rows),
        output_axis(signals, &file.rows),
    );
    let chart = with_segments(chart, signals, file);
    lines(chart, signals, file, &file.rows)
}

/// Both residuals over time.
pub(crate) fn residual_over_time(signals: &Signals, file: &File, id: &str) -> Chart {
    let [first, last] = &signals.models;
    let unit = signals.measured.unit.as_deref();
    let seen = counting(signals, file).into_iter().flatten();
    let seen = seen.flat_map(|row| [signals.residuals[0][row], signals.residuals[1][row]]);
    let y = Axis {
        label: quantity("residual", unit),
        scale: Scale::linear(seen),
    };
    let largest = |of: usize| {
        let rows = counting(signals, file).into_iter().flatten();
        rows.fold(0.0_f64, |most, row| {
            most.max(signals.residuals[of][row].abs())
        })
    };
    let description = format!(
        "Residuals of the {} model and the {} model over time. The largest values are {} and {}{}.",
        first.name,
        last.name,
        number(largest(0), None),
        number(largest(1), None),
        unit.map_or_else(String::new, |u| format!(" {u}"))
    );
    let chart = Chart::new(
        id,
        "Residual over time",
        &description,
        time_axis(signals, file, &file.rows),
        y,
    );
    let points = |of: usize| {
        let runs = counting(signals, file).into_iter();
        let run = |rows| over_time(signals, file, rows, &signals.residuals[of]).collect();
        runs.map(run).collect::<Vec<Vec<[f64; 2]>>>()
    };
    let mut chart = with_segments(chart, signals, file)
        .level("zero", 0.0)
        .lines("before", &points(0))
        .lines("final", &points(1))
        .key("before", &first.name)
        .key("final", &last.name);
    if let Some(worst) = &file.worst {
        chart = chart.moment("spot", signals.time(worst.row));
    }
    chart
}

fn zoom(signals: &Signals, file: &File, id: &str) -> Option<Chart> {
    let worst = file.worst.as_ref()?;
    let unit = signals.measured.unit.as_deref();
    let at = number(signals.time(worst.row), Some(0.1));
    let [before, after] = worst
        .errors
        .map(|e| number(e, Some(0.05 * e.abs())).replace('-', "−"));
    let segment = match signals.segments[worst.row] {
        Segment::HeldOut => "held-out data",
        _ => "the record",
    };
    let title = "Where the error is largest";
    let [first, last] = &signals.models;
    let description = format!(
        "The largest error on {segment} is at {at} s: {before} for the {} model and {after}{} for the {} model.",
        first.name,
        unit.map_or_else(String::new, |u| format!(" {u}")),
        last.name
    );
    let chart = Chart::new(
        id,
        title,
        &description,
        time_axis(signals, file, &worst.around),
        output_axis(signals, &worst.around),
    );
    let chart = lines(chart, signals, file, &worst.around);
    Some(
        chart
            .moment("spot", signals.time(worst.row))
            .caption(&description),
    )
}

/// Output versus input: measured, and what both models make of it.
pub(crate) fn hysteresis_loop(signals: &Signals, file: &File, id: &str) -> Chart {
    let rows = || {
        let own = file.rows.clone();
        own.filter(|&row| signals.segments[row] != Segment::Dropped)
    };
    let [first, last] = &signals.models;
    let columns = [&signals.measured, first, last];
    let x = Axis {
        label: quantity(&signals.input.name, signals.input.unit.as_deref()),
        scale: Scale::linear(rows().map(|row| signals.input.values[row])),
    };
    let y = Axis {
        label: quantity(&signals.measured.name, signals.measured.unit.as_deref()),
        scale: Scale::linear(rows().flat_map(|row| columns.map(|c| c.values[row]))),
    };
    let description = format!(
        "The output {} versus the input {}: the measured loop, and the loops of the {} model and the {} model.",
        signals.measured.name, signals.input.name, first.name, last.name
    );
    let of = |column: &Column| {
        let points = rows().map(|row| [signals.input.values[row], column.values[row]]);
        points.collect::<Vec<_>>()
    };
    Chart::new(id, "Output versus input", &description, x, y)
        .curve("measured", of(&signals.measured))
        .curve("declared", of(first))
        .curve("final", of(last))
        .key("measured", "measured")
        .key("declared", &first.name)
        .key("final", &last.name)
}

/// Both residuals over the input.
fn residual_loop(signals: &Signals, file: &File, id: &str) -> Chart {
    let rows = || {
        let own = file.rows.clone();
        own.filter(|&row| signals.segments[row] != Segment::Dropped)
    };
    let [first, last] = &signals.models;
    let x = Axis {
        label: quantity(&signals.input.name, signals.input.unit.as_deref()),
        scale: Scale::linear(rows().map(|row| signals.input.values[row])),
    };
    let y = Axis {
        label: quantity("residual", signals.measured.unit.as_deref()),
        scale: Scale::linear(rows().flat_map(|row| signals.residuals.each_ref().map(|r| r[row]))),
    };
    let of = |values: &[f64]| {
        let points = rows().map(|row| [signals.input.values[row], values[row]]);
        points.collect::<Vec<_>>()
    };
    let description = format!(
        "The residuals of the {} model and the {} model versus the input {}. A loop shows hysteresis or delay that the model lacks.",
        first.name, last.name, signals.input.name
    );
    Chart::new(id, "Residual versus input", &description, x, y)
        .level("zero", 0.0)
        .curve("before", of(&signals.residuals[0]))
        .curve("final", of(&signals.residuals[1]))
        .key("before", &first.name)
        .key("final", &last.name)
}

/// The size of each part of the last model.
pub(crate) fn shares(signals: &Signals, id: &str) -> Chart {
    let points: Vec<[f64; 2]> = signals
        .parts
        .iter()
        .enumerate()
        .map(|(k, part)| [(k + 1) as f64, 100.0 * part.share])
        .collect();
    let names = signals.parts.iter().enumerate();
    let names: Vec<String> = names
        .map(|(k, part)| format!("{} {}", k + 1, part.signal.name))
        .collect();
    let top = points.iter().map(|p| p[1]).chain([0.0, 1.0]);
    let x = Axis {
        label: "part".to_owned(),
        scale: Scale::counting(points.len()),
    };
    let y = Axis {
        label: "share of the output's standard deviation [%]".to_owned(),
        scale: Scale::linear(top),
    };
    let description = format!(
        "The standard deviation of each part of the {} model: {}.",
        signals.models[1].name,
        names.join(", ")
    );
    let chart = Chart::new(id, "What each part adds", &description, x, y)
        .bars("bar", 0.6, &points)
        .level("zero", 0.0);
    names
        .iter()
        .fold(chart, |chart, name| chart.key("bar", name))
}

fn file_head(signals: &Signals, file: &File) -> Markup {
    html! { @if signals.files.len() > 1 { h3 { (file.path) } } }
}

/// The section on signals over time.
pub(super) fn section(facts: &Facts, figures: &Figures) -> Markup {
    let signals = &figures.signals;
    let record = &facts.record;
    html! {
        p {
            (record.samples) " samples at " (number(record.rate, Some(1e-3 * record.rate))) " Hz, "
            (format!("{:.1}", record.seconds)) " s; " (record.mode.name()) " mode: "
            (record.input) " → " (record.output)
            @if !record.channels.is_empty() { ", with " (record.channels.join(", ")) }
            ". The same zero-phase filter is applied to all signals; its cut-off frequency is " (record.cutoff) " Hz. The parameters are fitted on "
            i { "fit" } ", " i { "selection" } " is used to reject terms that raise the error, and nothing is fitted on " i { "held-out" } "."
        }
        @for note in &record.notes { p class="note" { (note) } }
        @for defect in &record.defects { p { b { "Defect. " } (defect.channel) ": " (defect.message) } }
        (of_files(signals))
        details {
            summary { "Input and channels" }
            @for (k, file) in signals.files.iter().enumerate() {
                (file_head(signals, file))
                div class="grid-of" {
                    @for (c, column) in std::iter::once(&signals.input).chain(&signals.channels).enumerate() {
                        (read(signals, file, column, &format!("read-{k}-{c}")).figure())
                    }
                }
            }
        }
    }
}

/// What the model reads, over time.
fn read(signals: &Signals, file: &File, column: &Column, id: &str) -> Chart {
    let values = &column.values[file.rows.clone()];
    let y = Axis {
        label: quantity(&column.name, column.unit.as_deref()),
        scale: Scale::linear(values.iter().copied()),
    };
    let description = format!("`{}` over time, after the filter.", column.name);
    let x = time_axis(signals, file, &file.rows);
    let points = over_time(signals, file, file.rows.clone(), &column.values);
    Chart::new(id, &column.name, &description, x, y)
        .low()
        .line("measured", points.collect::<Vec<_>>())
}

/// Output, worst spot and residual over time of each file.
pub(crate) fn of_files(signals: &Signals) -> Markup {
    html! {
        @for (k, file) in signals.files.iter().enumerate() {
            (file_head(signals, file))
            (trace(signals, file, &format!("trace-{k}")).figure())
            div class="pair" {
                @if let Some(zoom) = zoom(signals, file, &format!("zoom-{k}")) { (zoom.figure()) }
                (residual_over_time(signals, file, &format!("over-time-{k}"))
                    .caption("The dashed line marks the largest error.").figure())
            }
        }
    }
}

/// The section on the loop.
pub(super) fn loops(facts: &Facts, figures: &Figures) -> Markup {
    html! {
        p {
            "Without hysteresis, the output would be a function of the input, and the loop would be a single curve. The height of the loop at a given input is the difference between the forward stroke and the backward stroke"
            (in_brackets(facts.record.unit.as_deref())) ". The figure on the right shows the residuals over the same input."
        }
        (loops_of_files(&figures.signals))
    }
}

/// The loops of each file.
pub(crate) fn loops_of_files(signals: &Signals) -> Markup {
    html! {
        @for (k, file) in signals.files.iter().enumerate() {
            (file_head(signals, file))
            div class="pair" {
                (hysteresis_loop(signals, file, &format!("loop-{k}")).figure())
                (residual_loop(signals, file, &format!("residual-loop-{k}")).figure())
            }
        }
    }
}
