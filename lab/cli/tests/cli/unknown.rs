//! What has no name, as it is printed.

use crate::sentences::files::Rows;
use crate::shell::{bowden_on, has, json, said, without_seconds, Folder};
use bowden_synth::{Mode, Planted, Recipe};
use serde_json::{json, Value};

/// A bump over the position, three times the noise: no effect of the catalogue.
#[test]
fn the_report_of_something_unknown_says_so_in_both_forms_and_is_the_same_on_one_thread() {
    let recipe = Recipe {
        seed: 61_100,
        effects: vec![Planted::new("bump-position")],
        ..Recipe::new(Mode::Displacement)
    };
    let folder = Folder::new();
    let asked = format!("identify {}", folder.planted("made.csv", &recipe));
    let on = |threads| without_seconds(&bowden_on(threads, &format!("{asked} --json")).stdout);
    assert_eq!(on("3"), on("1"));
    let report = json(&format!("{asked} --json"));
    assert_eq!(report["verdict"], "unmodelled-dependence");
    let unknown = &report["unknown"];
    assert_eq!(unknown["variable"], "position");
    assert_eq!(unknown["channel"], "x");
    assert!(unknown["q"].as_f64().unwrap() < 1.0);
    assert!(unknown["p"].as_f64().unwrap() < 1e-3);
    assert!(unknown["curve"].as_array().unwrap().len() >= 10);
    let number = |place: &str| report.pointer(place).unwrap().as_f64().unwrap();
    let [before, after] =
        ["before", "after"].map(|when| number(&format!("/unknown/rmse_{when}/held_out")));
    assert!(after < 0.2 * before);
    // With the table, and fitted once more: that moves the error by a little.
    let delivered = number("/final/rmse/held_out");
    assert!((delivered / after - 1.0).abs() < 0.1, "{delivered} {after}");

    // The exported model contains it with fewer points: above the final error, far below that
    // of the named effects.
    let exported = &report["final"]["exported_model"];
    assert_eq!(exported["effects"], json!(["bouc-wen", "curve over x"]));
    assert_eq!(exported["excluded_terms"], json!([]));
    let share = number("/final/exported_model/nrmse/held_out");
    let error = share * number("/output_std/held_out");
    assert!(error < 0.5 * before, "{error}");
    has(report["summary"].as_str().unwrap(), &["depends on x"]);
    let ledger = said(&asked);
    has(
        &ledger,
        &["The residual depends on x. To first order, the best one"],
    );
}

/// A linear guide whose friction rises from 4 N in the middle to 12 N at both ends: even in the
/// position, which no effect of the catalogue is.
#[test]
fn friction_that_rises_towards_both_ends_is_a_missing_shape_of_the_hysteresis() {
    let uniform = |row: usize, factor: f64| (43_758.545 * (factor * row as f64).sin()).fract();
    let (mut eta, mut before) = (0.0, None);
    let row = |row: usize| {
        let t = 0.02 * row as f64;
        let x = 30.0 * (1.3 * t).sin() + 12.0 * (2.9 * t + 1.0).sin() + 8.0 * (0.6 * t).sin();
        let moved = x - before.replace(x).unwrap_or(x);
        // Bouc-Wen with rho 2, sigma 1, n 1.
        eta = moved.signum() + (eta - moved.signum()) * f64::exp(-2.0 * f64::abs(moved));
        let friction = 4.0 + 8.0 * (x / 50.0).powi(2);
        let (dx, df) = (0.005 * uniform(row, 12.9898), 0.05 * uniform(row, 78.233));
        vec![t, x + dx, 0.5 * x + friction * eta + df]
    };
    let closed = Rows::new("t,x [mm],f [N]", (0..2500).map(row)).close("");
    let first: &Value = &closed.json["lacks"][0];
    assert_eq!(first["mechanism"], "hysteresis-shape");
    assert_eq!(first["confidence"], "high");
    // The residual without this column is 7 % of the output; the column explains nearly all of it.
    let share = closed.number("/lacks/0/share/alone/value");
    assert!(share > 0.9, "{first}");
}
