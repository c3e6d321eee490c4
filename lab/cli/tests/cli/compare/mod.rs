//! `bowden compare` and `bowden certify`: the figures and the forms.

mod certificates;
mod figures;
mod forms;

use crate::shell::bowden;
use serde_json::Value;

fn json(arguments: &[&str]) -> Value {
    let output = bowden(arguments);
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The row of one controller.
fn row<'a>(report: &'a Value, controller: &str) -> &'a Value {
    let rows = report["rows"].as_array().unwrap();
    rows.iter()
        .find(|row| row["controller"] == controller)
        .unwrap_or_else(|| panic!("no {controller}"))
}
