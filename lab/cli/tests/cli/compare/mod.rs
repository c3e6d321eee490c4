//! `bowden compare` and `bowden certify`: the figures and the forms.

mod certificates;
mod figures;
mod forms;

use serde_json::Value;

/// The row of one controller.
pub fn row<'a>(report: &'a Value, controller: &str) -> &'a Value {
    let mut rows = report["rows"].as_array().unwrap().iter();
    let row = rows.find(|row| row["controller"] == controller);
    row.unwrap_or_else(|| panic!("no {controller} in {report}"))
}
