//! The format of estimates and tables in all reports.

use bowden_lab::facts::{number, with_interval, Parameter};
use comfy_table::{presets, CellAlignment, ContentArrangement, Table, TableComponent};

/// "12.34 ± 0.05 N·m", or the remark in its place.
pub(super) fn estimate(parameter: &Parameter) -> String {
    let unit = match parameter.unit.as_deref() {
        Some("1") => String::new(),
        Some(unit) => format!(" {unit}"),
        None => " (no unit in the record)".to_owned(),
    };
    match parameter.ci95 {
        Some(_) => format!("{}{unit}", with_interval(parameter.value, parameter.ci95)),
        None => {
            let reason = parameter
                .not_identified
                .as_ref()
                .map_or("", |r| r.reason.as_str());
            let value = number(parameter.value, None);
            format!("{value}{unit}, not identified: {reason}")
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

/// Width of the terminal on stdout; `None` if it is none.
#[must_use]
pub fn terminal_width() -> Option<u16> {
    Table::new().width()
}

/// " [N·m]"; empty if the record states no unit.
pub(super) fn in_brackets(unit: Option<&str>) -> String {
    unit.map_or_else(String::new, |unit| format!(" [{unit}]"))
}
