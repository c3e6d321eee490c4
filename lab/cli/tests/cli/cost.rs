//! What `bowden identify --json` says of its own cost.

use crate::shell::{bowden, Folder};
use serde_json::Value;
use std::time::Instant;

/// The part `cost`, and the wall time of the whole process \[s\].
fn cost(arguments: &[&str]) -> (Value, f64) {
    let begun = Instant::now();
    let output = bowden(&[arguments, &["--json"]].concat());
    let seconds = begun.elapsed().as_secs_f64();
    assert!(output.status.success(), "{output:?}");
    let mut report: Value = serde_json::from_slice(&output.stdout).unwrap();
    (report["cost"].take(), seconds)
}

fn count(cost: &Value, name: &str) -> u64 {
    cost[name].as_u64().unwrap()
}

fn seconds(cost: &Value, stage: &str) -> f64 {
    cost["seconds"][stage].as_f64().unwrap()
}

#[test]
fn the_stages_are_within_the_run_and_none_is_forgotten() {
    let (cost, whole) = cost(&["identify"]);
    let stages = cost["seconds"].as_object().unwrap();
    let sum: f64 = stages.values().map(|s| s.as_f64().unwrap()).sum();
    assert!(stages.values().all(|s| s.as_f64().unwrap() > 0.0), "{cost}");
    // The rest is the start of the process and what is printed: less than what is computed.
    assert!(sum <= whole && sum > 0.5 * whole, "{cost} of {whole} s");
}

#[test]
fn a_run_that_looks_for_nothing_spends_nothing_on_the_search() {
    let ((none, _), (all, _)) = (cost(&["identify", "--max-terms", "0"]), cost(&["identify"]));
    assert!(seconds(&none, "searching") == 0.0, "{none}");
    assert!(seconds(&none, "fitting_baseline") > 0.0, "{none}");
    for name in ["evaluations", "jacobians", "columns_filtered", "searches"] {
        assert!(0 < count(&none, name), "{name}: {none}");
        assert!(
            count(&none, name) < count(&all, name),
            "{name}: {none} {all}"
        );
    }
}

#[test]
fn the_counts_are_of_what_they_say() {
    let (cost, _) = cost(&["identify", "--max-terms", "0"]);
    let of = |name: &str| count(&cost, name);
    // Nine starts at least (eight, and those that are searched on), each evaluated once or
    // more; before each Jacobian comes an evaluation; an evaluation filters the hysteresis
    // anew, and a Jacobian of rho, sigma, n and eta(0) four columns.
    assert!(of("searches") >= 9, "{cost}");
    assert!(of("evaluations") >= of("searches"), "{cost}");
    assert!(of("jacobians") <= of("evaluations"), "{cost}");
    let least = of("evaluations") + 4 * of("jacobians");
    assert!(of("columns_filtered") >= least, "{cost}");
}

#[test]
fn the_counts_are_those_of_the_answer_whatever_is_drawn_of_it() {
    let folder = Folder::new();
    let name = |file: &str| folder.path(file);
    let (trace, page) = (name("trace.csv"), name("page.html"));
    let quick = ["identify", "--max-terms", "0"];
    let drawn = [&quick[..], &["--trace", &trace, "--report", &page]].concat();
    let ((alone, _), (drawn, _)) = (cost(&quick), cost(&drawn));
    for name in ["evaluations", "jacobians", "columns_filtered", "searches"] {
        assert_eq!(count(&alone, name), count(&drawn, name), "{name}");
    }
}
