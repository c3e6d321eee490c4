//! What `bowden identify --json` says of its own cost.

use crate::shell::{builtin, json, Folder};
use serde_json::Value;
use std::time::Instant;

const COUNTS: [&str; 4] = ["evaluations", "jacobians", "columns_filtered", "searches"];

fn counts(report: &Value) -> [u64; 4] {
    COUNTS.map(|name| report["cost"][name].as_u64().unwrap())
}

#[test]
fn the_stages_are_within_the_run_and_none_is_forgotten() {
    let begun = Instant::now();
    let report = json("identify --json");
    let whole = begun.elapsed().as_secs_f64();
    let stages = report["cost"]["seconds"].as_object().unwrap().values();
    let stages: Vec<f64> = stages.map(|s| s.as_f64().unwrap()).collect();
    assert!(stages.iter().all(|s| *s > 0.0), "{stages:?}");
    // The rest is the start of the process and what is printed: less than what is computed.
    let sum: f64 = stages.iter().sum();
    assert!(sum <= whole && sum > 0.5 * whole, "{stages:?} of {whole} s");
}

#[test]
fn the_counts_are_of_what_they_say_whatever_is_drawn_of_it() {
    let none = json("identify --max-terms 0 --json");
    let seconds = |stage: &str| none["cost"]["seconds"][stage].as_f64().unwrap();
    assert!(seconds("searching") == 0.0 && seconds("fitting_baseline") > 0.0);
    let own = counts(&none);
    for ((own, all), name) in own.into_iter().zip(counts(builtin())).zip(COUNTS) {
        assert!(0 < own && own < all, "{name}: {own} {all}");
    }
    // Nine starts at least (eight, and those that are searched on), each evaluated once or
    // more; before each Jacobian comes an evaluation; an evaluation filters the hysteresis
    // anew, and a Jacobian of rho, sigma, n and eta(0) four columns.
    let [evaluations, jacobians, columns_filtered, searches] = own;
    assert!(searches >= 9 && evaluations >= searches, "{own:?}");
    assert!(jacobians <= evaluations, "{own:?}");
    assert!(columns_filtered >= evaluations + 4 * jacobians, "{own:?}");
    let folder = Folder::new();
    let (trace, page) = (folder.path("trace.csv"), folder.path("page.html"));
    let files = format!("--trace {trace} --report {page}");
    let drawn = json(&format!("identify --max-terms 0 --json {files}"));
    assert_eq!(counts(&drawn), own);
}
