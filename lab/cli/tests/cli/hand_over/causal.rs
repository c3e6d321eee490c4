//! The error with the rates of firmware.

use crate::hand_over::{demo, recipe, Told};
use crate::shell::has;
use bowden_cli::view::{json, text, Report, Width};
use bowden_lab::export::hand_over::HandOver;
use bowden_lab::facts::{Detail, Facts};
use bowden_synth::Mode;
use std::f64::consts::TAU;

/// f = c·v of a pure tone: what a first-order lag of the velocity leaves is known.
#[test]
fn the_error_of_a_dashpot_with_causal_rates_is_that_of_the_lag_of_the_velocity() {
    // 0.624 s are dropped at both ends: 40 whole periods are held out.
    let (tone, cutoff, rows) = (1.0, 5.0, 161_248);
    let row = |k: i32| {
        let t = f64::from(k) / 1000.0;
        let (sin, cos) = (TAU * tone * t).sin_cos();
        let force = 0.5 * 10.0 * TAU * tone * cos;
        format!("{t:.6},{:.12},{force:.12}\n", 10.0 * sin)
    };
    let csv = format!(
        "t [s],x [mm],f [N]\n{}",
        (0..rows).map(row).collect::<String>()
    );
    let hand = Told::of(&csv, &["viscous"], Some(cutoff)).hand_over(false);
    // The smoother of the fit takes 1e-11 of the tone, the derivative 1e-9.
    assert!(hand.nrmse.held_out < 1e-6, "{:?}", hand.nrmse);
    // |1 − 1/(1 + j·w)|, w the tone over the corner of the rates at 2.5 times the cut-off.
    let w = tone / (2.5 * cutoff);
    let expected = w / (1.0 + w * w).sqrt();
    let found = hand.causal.held_out;
    // Half a row of 48 ms too many or too few in 40 s: 6e-4. The discrete lag differs by
    // (dt/tau)²/12, 5e-4; f32 by less.
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
    let time_constant = 1.0 / (TAU * 2.5 * cutoff);
    assert!((hand.time_constant / time_constant - 1.0).abs() < 1e-12);
}

#[test]
fn without_rates_the_causal_error_of_a_hysteresis_is_that_of_the_fit() {
    let told = Told::new(&recipe(Mode::Torque, 21, &[]), &["bouc-wen"]);
    let hand = told.hand_over(false);
    let (fit, causal) = (hand.nrmse.held_out, hand.causal.held_out);
    // The model reads the raw input at 1 kHz, not the smoothed one at 182 Hz.
    assert!(causal < 1.5 * fit, "{causal} {fit}");
    assert!(causal != fit);
}

#[test]
fn the_error_on_a_controller_is_printed_and_in_the_json() {
    let last = &demo(false).json["final"];
    let [causal, zero_phase] = [&last["causal_nrmse"], &last["exported_model"]["nrmse"]]
        .map(|of| format!("{:.2} %", 100.0 * of["held_out"].as_f64().unwrap()));
    let mut lines = demo(false).ledger.lines();
    let line = lines.find(|l| l.contains("causal derivatives")).unwrap();
    has(line, &[&causal]);
    assert_ne!(causal, zero_phase);
}

#[test]
fn what_was_found_is_told_although_nothing_can_be_handed_over() {
    let told = Told::new(&recipe(Mode::Torque, 1, &[]), &["bouc-wen"]);
    let (data, ledger, done) = (&told.data, &told.ledger, &told.done);
    // Without the records as they came nothing can be run sample by sample.
    let because = HandOver::new(&[], data, ledger, done, false, |_| ()).unwrap_err();
    let hand = Err(because.as_str());
    let facts = Facts::new("made.csv", data, ledger, done, hand, Detail::EachRound);
    let report = json(&facts, None).unwrap();
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let part = &report["final"];
    assert!(part["causal_nrmse"].is_null() && part["exported_model"].is_null());
    assert_eq!(part["feed_forward"]["reason"], because);
    assert!(part["nrmse"]["held_out"].is_f64());
    let report = Report {
        width: Width::unlimited(),
        verbose: false,
        chosen_cutoff: false,
    };
    let printed = text(&facts, report);
    has(
        &printed,
        &[&format!("Use it  no model can be exported: {because}\n")],
    );
    let nothing = ["NO MISSING TERM FOUND", "NO TERM IS MISSING"];
    assert!(
        nothing.iter().any(|words| printed.contains(words)),
        "{printed}"
    );
}
