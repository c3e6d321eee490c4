//! `bowden compare` and `bowden certify`: the figures and the forms.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod certificates;
mod figures;
mod forms;
#[allow(dead_code)]
#[path = "../shell/mod.rs"]
mod shell;

use serde_json::Value;
use shell::bowden;

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
