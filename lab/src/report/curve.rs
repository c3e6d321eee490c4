//! What has no name: its curve, for programs and for people.

use super::words::number;
use crate::conclude::curve::{curve, Knot};
use crate::conclude::final_fit::FinalFit;
use crate::conclude::verdict::unknown_words;
use crate::fit::Segments;
use crate::ledger::Ledger;
use crate::ledger::Unknown;
use crate::problem::Prepared;
use serde::Serialize;
use std::fmt::Write as _;

/// At most this many points are printed.
const LINES: usize = 20;
/// Length of the longest bar.
const BAR: f64 = 24.0;

/// The part of the JSON.
#[derive(Debug, Clone, Serialize)]
pub(super) struct UnknownPart {
    variable: &'static str,
    channel: String,
    share: f64,
    p: f64,
    q: f64,
    curve: Vec<Knot>,
    rmse_before: Segments,
    rmse_after: Segments,
}

impl UnknownPart {
    pub(super) fn new(data: &Prepared, unknown: &Unknown, done: &FinalFit) -> Self {
        let channel = data.channel(unknown.variable.source());
        Self {
            variable: unknown.variable.name(data),
            channel: channel.map_or_else(String::new, |c| c.name.clone()),
            share: unknown.share,
            p: unknown.p,
            q: unknown.q,
            curve: curve(&done.data, &done.solution),
            rmse_before: unknown.before,
            rmse_after: unknown.after,
        }
    }
}

/// The section of the ledger; nothing where there is no such curve.
pub(super) fn text(data: &Prepared, ledger: &Ledger, done: &FinalFit) -> Option<String> {
    let unknown = ledger.unknown.as_ref()?;
    let knots = curve(&done.data, &done.solution);
    let every = knots.len().div_ceil(LINES).max(1);
    let largest = knots.iter().map(|k| k.value.abs()).fold(0.0, f64::max);
    let unit = |unit: Option<String>| unit.map_or_else(String::new, |u| format!(" [{u}]"));
    let mut out = String::new();
    let _ = writeln!(
        out,
        "unknown: {} A free curve of it takes {:.1} % of the squared error (p {:.1e}); it stays in the final model as a table.",
        unknown_words(data, ledger).unwrap_or_default(),
        100.0 * unknown.share,
        unknown.p
    );
    let _ = writeln!(
        out,
        "{:>12}  {:<24} at {}{}",
        "at",
        format!("adds (95 %){}", unit(data.output_unit.clone())),
        unknown.variable.words(data),
        unit(unknown.variable.unit(data)),
    );
    for knot in knots.iter().step_by(every) {
        let half = knot.ci95.map(|[low, high]| 0.5 * (high - low));
        let value = match half {
            Some(half) => format!(
                "{} ± {}",
                number(knot.value, Some(half)),
                number(half, Some(half))
            ),
            None => format!("{} (not identified)", number(knot.value, None)),
        };
        let length = (BAR * knot.value.abs() / largest.max(1e-300)).round() as usize;
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
            width = BAR as usize
        );
    }
    Some(out)
}
