//! The unmodelled curve, as JSON and as text.

use super::layout::{block, Report};
use super::words::in_brackets;
use bowden_lab::facts::{number, with_interval, Facts, Knot, Segments, UnknownFacts};
use serde::Serialize;
use std::fmt::Write as _;

/// The part of the JSON.
#[derive(Serialize)]
pub(super) struct UnknownPart<'a> {
    variable: &'static str,
    channel: &'a str,
    share: f64,
    p: f64,
    q: f64,
    curve: &'a [Knot],
    rmse_before: Segments,
    rmse_after: Segments,
}

impl<'a> UnknownPart<'a> {
    pub(super) fn new(unknown: &'a UnknownFacts) -> Self {
        Self {
            variable: unknown.variable,
            channel: &unknown.channel,
            share: unknown.share,
            p: unknown.p,
            q: unknown.q,
            curve: &unknown.curve,
            rmse_before: unknown.before,
            rmse_after: unknown.after,
        }
    }
}

/// The section of the results table; empty if there is no such curve.
pub(super) fn text(facts: &Facts, report: Report) -> Option<String> {
    let unknown = facts.unknown.as_ref()?;
    let knots = &unknown.curve;
    // Twenty points at most.
    let every = knots.len().div_ceil(20).max(1);
    let largest = knots.iter().map(|k| k.value.abs()).fold(0.0, f64::max);
    let bar_width = 24;
    let mut out = String::new();
    block(
        &mut out,
        report.width,
        "Curve",
        [format!(
            "versus {}: removes {:.1} % of the squared error (p {:.1e}); {}",
            unknown.words,
            100.0 * unknown.share,
            unknown.p,
            unknown.kept
        )],
    );
    let _ = writeln!(
        out,
        "{:>12}  {:<24} at {}{}",
        "at",
        format!("adds (95 %){}", in_brackets(facts.record.unit.as_deref())),
        unknown.words,
        in_brackets(unknown.unit.as_deref()),
    );
    for knot in knots.iter().step_by(every) {
        let value = match knot.ci95 {
            Some(_) => with_interval(knot.value, knot.ci95),
            None => format!("{} (not identified)", number(knot.value, None)),
        };
        let length = (bar_width as f64 * knot.value.abs() / largest.max(1e-300)).round() as usize;
        let bar = "#".repeat(length);
        let (left, right) = if knot.value < 0.0 {
            (bar.as_str(), "")
        } else {
            ("", bar.as_str())
        };
        let _ = writeln!(
            out,
            "{:>12}  {value:<24} {left:>width$}|{right}",
            number(knot.at, Some(0.01 * knot.at.abs())),
            width = bar_width
        );
    }
    Some(out)
}
