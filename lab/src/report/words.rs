//! Numbers, names and tables, as all reports write them.

use crate::conclude::intervals::{term_name, Parameter};
use crate::fit::Solution;
use crate::ledger::Ledger;
use crate::problem::Prepared;
use crate::score::scan::{Regime, BLOCKS};
use comfy_table::{presets, CellAlignment, ContentArrangement, Table, TableComponent};

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

/// Names of all parts of a model.
pub(super) fn effects(data: &Prepared, solution: &Solution) -> Vec<String> {
    let hysteresis = solution.structure.hysteresis.then(|| "bouc-wen".to_owned());
    hysteresis
        .into_iter()
        .chain(solution.structure.terms.iter().map(|t| term_name(data, t)))
        .collect()
}

/// Independent stretches of the fit segment, at most sixteen.
pub(super) fn block_count(data: &Prepared, ledger: &Ledger) -> usize {
    if ledger.regime == Regime::Blocks {
        return BLOCKS;
    }
    let seconds = data.split.fit.len() as f64 * data.dt * data.stride as f64;
    ((seconds / (3.0 * ledger.correlation_time)) as usize).min(BLOCKS - 1)
}
