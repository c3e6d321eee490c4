//! What has no name, as it is printed.

use bowden_cli::view::{json, text, Report, Width};
use bowden_lab::facts::{close, Asked, Close, Detail, Facts};
use bowden_synth::{generate, Mode, Planted, Recipe};

/// A bump over the position, three times the noise: no effect of the catalogue.
fn bump() -> Facts {
    let made = generate(&Recipe {
        seed: 61_100,
        effects: vec![Planted {
            strength: 3.0,
            ..Planted::new("bump-position")
        }],
        ..Recipe::new(Mode::Displacement)
    });
    let asked = Asked::default();
    let csv = made.unwrap().to_csv();
    let record = asked.read_text(csv.as_bytes(), "made.csv").unwrap();
    let question = Close {
        detail: Detail::EachRound,
        ..Close::new(asked)
    };
    close(&[record], &question, &|_| ()).unwrap().facts
}

#[test]
fn the_report_of_something_unknown_says_so_in_both_forms_and_is_the_same_on_one_thread() {
    let facts = bump();
    let printed = json(&facts, None).unwrap();
    let report: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(report["verdict"], "unmodelled-dependence");
    let unknown = &report["unknown"];
    assert_eq!(unknown["variable"], "position");
    assert_eq!(unknown["channel"], "x");
    assert!(unknown["q"].as_f64().unwrap() < 1.0);
    assert!(unknown["p"].as_f64().unwrap() < 1e-3);
    assert!(unknown["curve"].as_array().unwrap().len() >= 10);
    let rmse = |when: &str| unknown[when]["held_out"].as_f64().unwrap();
    assert!(rmse("rmse_after") < 0.2 * rmse("rmse_before"));
    // With the table, and fitted once more: that moves the error by a little.
    let delivered = report["final"]["rmse"]["held_out"].as_f64().unwrap();
    let found = rmse("rmse_after");
    assert!((delivered / found - 1.0).abs() < 0.1, "{delivered} {found}");

    // The exported model contains it with fewer points: above the final error, far below that
    // of the named effects.
    let exported = &report["final"]["exported_model"];
    assert_eq!(
        exported["effects"],
        serde_json::json!(["bouc-wen", "curve over x"])
    );
    assert_eq!(exported["excluded_terms"], serde_json::json!([]));
    let deviation = report["output_std"]["held_out"].as_f64().unwrap();
    let error = exported["nrmse"]["held_out"].as_f64().unwrap() * deviation;
    assert!(error < 0.5 * rmse("rmse_before"), "{error}");

    let sentence = report["summary"].as_str().unwrap();
    assert!(sentence.contains("depends on x"), "{sentence}");
    let ledger = text(
        &facts,
        Report {
            width: Width::unlimited(),
            verbose: false,
            chosen_cutoff: false,
        },
    );
    assert!(ledger.contains("The residual depends on x. To first order, the best one"));

    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build()
        .unwrap();
    let again = pool.install(|| json(&bump(), None).unwrap());
    assert_eq!(printed, again);
}

/// A linear guide whose friction rises from 4 N in the middle to 12 N at both ends: even in the
/// position, which no effect of the catalogue is.
#[test]
fn friction_that_rises_towards_both_ends_is_a_missing_shape_of_the_hysteresis() {
    let uniform = |row: usize, factor: f64| (43_758.545 * (factor * row as f64).sin()).fract();
    let mut csv = String::from("t,x [mm],f [N]\n");
    let (mut eta, mut before) = (0.0, 0.0);
    for row in 0..2500 {
        let t = 0.02 * row as f64;
        let x = 30.0 * (1.3 * t).sin() + 12.0 * (2.9 * t + 1.0).sin() + 8.0 * (0.6 * t).sin();
        let moved = if row > 0 { x - before } else { 0.0 };
        before = x;
        // Bouc-Wen with rho 2, sigma 1, n 1.
        eta = moved.signum() + (eta - moved.signum()) * f64::exp(-2.0 * f64::abs(moved));
        let friction = 4.0 + 8.0 * (x / 50.0).powi(2);
        let (dx, df) = (0.005 * uniform(row, 12.9898), 0.05 * uniform(row, 78.233));
        csv += &format!(
            "{t:.2},{:.3},{:.3}\n",
            x + dx,
            0.5 * x + friction * eta + df
        );
    }
    let asked = Asked::default();
    let record = asked.read_text(csv.as_bytes(), "guide.csv").unwrap();
    let facts = close(&[record], &Close::new(asked), &|_| ()).unwrap().facts;
    let report: serde_json::Value = serde_json::from_str(&json(&facts, None).unwrap()).unwrap();
    let first = &report["lacks"][0];
    assert_eq!(
        first["mechanism"], "hysteresis-shape",
        "{}",
        report["summary"]
    );
    assert_eq!(first["confidence"], "high");
    // The residual without this column is 7 % of the output; the column explains nearly all of it.
    assert!(
        first["share"]["alone"]["value"].as_f64().unwrap() > 0.9,
        "{first}"
    );
}
